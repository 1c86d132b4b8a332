// Inverse and forward kinematics of a mechanism given by data (parallel_mechanism.hpp).
//
// Inverse: with six actuated legs every pose is possible and the lengths are distances between known points. With
// fewer, as many of the pose's coordinates as there are actuated legs are chosen (`driven`), and Newton's method finds
// the others from the equations of rods and planes.
//
// Forward: Newton's method on all six equations,
//
//   (|l_i|^2 - L_i^2) / 2 = 0,   n_i . l_i = 0
//
// with their exact Jacobian in the twist (v, omega). A step turns the platform by Cayley's formula: a rational
// function, exactly a rotation, no angles and so no gimbal lock on the way. The equations have up to 40 real solutions
// (P. Dietmaier, 1998): the search starts at a pose of the wanted assembly mode and its steps are bounded. A solution
// at which the Jacobian's determinant has another sign than at the start cannot be reached without passing a
// singularity, and is refused.
#pragma once

#include "sms/newton.hpp"
#include "sms/parallel_mechanism.hpp"

namespace sms {

// How a search ended; written whatever the status.
template <typename V>
struct Search {
  int iterations;  // Newton steps taken
  V residual;      // m, largest error of a length or distance from a plane; NaN when no pose was tried
  bool singular;   // it met a pose whose Jacobian has no inverse
};

// (I - A)^-1 (I + A) R with A the cross product matrix of half the turn: R turned by about that vector.
template <typename S>
Mat3<S> turned_by(const Vec3<S>& turn, const Mat3<S>& rotation) {
  const Vec3<S> c = S(0.5) * turn;
  const S scale = S(2) / (S(1) + c.squaredNorm());
  Mat3<S> result;
  for (int k = 0; k < 3; ++k) {
    const Vec3<S> column = rotation.col(k), once = cross(c, column);
    result.col(k) = column + scale * (once + cross(c, once));
  }
  return result;
}

// The six equations' errors, m^2 for a length and m for a plane; `length` of the actuated legs in the order of the
// legs.
template <typename S>
Vec6<S> equation_errors(const ParallelMechanism<S>& m, const LegEquation equation[6], const S* length,
                        const LegVectors<S>& v) {
  Vec6<S> error;
  for (int k = 0; k < 6; ++k) {
    const int i = equation[k].leg;
    if (equation[k].is_plane) {
      error(k) = m.leg[i].normal.dot(v.link[i]);
    } else {
      const S wanted = m.leg[i].length_is == LegLength::actuated ? length[k] : m.leg[i].fixed_length;
      error(k) = S(0.5) * (v.link[i].squaredNorm() - wanted * wanted);
    }
  }
  return error;
}

// Their derivatives by the twist.
template <typename V>
Mat6<V> equation_slopes(const ParallelMechanism<V>& m, const LegEquation equation[6], const LegVectors<V>& v) {
  Mat6<V> slope;
  for (int k = 0; k < 6; ++k) {
    const int i = equation[k].leg;
    slope.row(k) = twist_row(v.arm[i], equation[k].is_plane ? m.leg[i].normal : v.link[i]);
  }
  return slope;
}

template <typename V>
V largest_error(const LegEquation equation[6], const LegVectors<V>& v, const Vec6<V>& error, int first) {
  using std::abs;
  using std::sqrt;
  V largest = V(0);
  for (int k = first; k < 6; ++k) {
    const V size = abs(error(k)) / (equation[k].is_plane ? V(1) : V(sqrt(v.link[equation[k].leg].squaredNorm())));
    largest = size > largest ? size : largest;
  }
  return largest;
}

template <typename S>
void move_by(const Vec6<S>& twist, PlatformPose<S>& pose) {
  pose.position += twist.template head<3>();
  pose.rotation = turned_by(Vec3<S>(twist.template tail<3>()), pose.rotation);
}

// Largest component of a step, lengths in characteristic lengths.
template <typename V>
V step_size(const Vec6<V>& step, const V& characteristic_length) {
  const V moved = step.template head<3>().cwiseAbs().maxCoeff() / characteristic_length;
  const V turned = step.template tail<3>().cwiseAbs().maxCoeff();
  return moved > turned ? moved : turned;
}

constexpr int most_steps_of_search() { return 50; }

// One step of a search, and the determinant it began with, whose sign it has to keep.
template <typename V>
struct NewtonStep {
  Factors<V> factors;
  V first_determinant;
  Vec6<V> step;
  V size;

  bool same_sign() const { return (factors.determinant > V(0)) == (first_determinant > V(0)); }
};

// The step that solves slope step = error. False where there is none.
template <typename V>
bool find_step(const Mat6<V>& slope, const Vec6<V>& error, const V& characteristic_length, NewtonStep<V>& newton,
               Search<V>& search) {
  factorize(slope, newton.factors);
  search.singular = is_singular(newton.factors);
  if (search.singular) {
    return false;
  }
  newton.first_determinant = search.iterations == 0 ? newton.factors.determinant : newton.first_determinant;
  newton.step = solution(newton.factors, error);
  newton.size = step_size(newton.step, characteristic_length);
  return newton.size < std::numeric_limits<V>::max();
}

template <typename V>
sms_status solve_forward(const ParallelMechanism<V>& m, const LegEquation equation[6], const V* length,
                         PlatformPose<V>& pose, NewtonStep<V>& newton, Search<V>& search) {
  LegVectors<V> v;
  for (search.iterations = 0; search.iterations < most_steps_of_search();) {
    locate_legs(m, pose, v);
    const Vec6<V> error = equation_errors(m, equation, length, v);
    search.residual = largest_error(equation, v, error, 0);
    if (!find_step(equation_slopes(m, equation, v), error, m.characteristic_length, newton, search)) {
      return SMS_NOT_CONVERGED;
    }
    move_by(Vec6<V>(-damping(newton.size) * newton.step), pose);
    ++search.iterations;
    if (newton.size < close_step<V>()) {
      return newton.same_sign() ? SMS_OK : SMS_OUT_OF_WORKSPACE;
    }
  }
  return SMS_NOT_CONVERGED;
}

template <typename S>
PlatformPose<ValueOf<S>> value_of(const PlatformPose<S>& pose) {
  return {value_of(pose.position), value_of(pose.rotation)};
}

template <typename V>
void carry_derivatives(const ParallelMechanism<V>& /*m*/, const LegEquation* /*equation*/, const V* /*length*/,
                       const PlatformPose<V>& found, PlatformPose<V>& pose) {
  pose = found;
}

// One more Newton step in S, with the slope of the solution itself.
template <typename S, typename V>
void carry_derivatives(const ParallelMechanism<V>& m, const LegEquation* equation, const S* length,
                       const PlatformPose<V>& found, PlatformPose<S>& pose) {
  LegVectors<V> v;
  locate_legs(m, found, v);
  Factors<V> factors;
  factorize(equation_slopes(m, equation, v), factors);
  const ParallelMechanism<S> mechanism = cast<S>(m);
  LegVectors<S> in_s;
  pose = {found.position.template cast<S>(), found.rotation.template cast<S>()};
  locate_legs(mechanism, pose, in_s);
  move_by(Vec6<S>(-solution(factors, equation_errors(mechanism, equation, length, in_s))), pose);
}

// The pose of the actuated legs' lengths (m, in the order of the legs), from a start in the wanted assembly mode. On
// any status but SMS_OK the pose is as it was. Legs are data: plain numbers; lengths may carry derivatives.
template <typename S>
sms_status parallel_forward(const ParallelMechanism<ValueOf<S>>& m, const S* length,
                            const PlatformPose<ValueOf<S>>& start, PlatformPose<S>& pose, Search<ValueOf<S>>& search) {
  using V = ValueOf<S>;
  search = {0, std::numeric_limits<V>::quiet_NaN(), false};
  LegEquation equation[6];
  if (equations_of(m, equation) != 6) {
    return SMS_OUT_OF_RANGE;
  }
  const int freedoms = actuated_count(m);
  V value[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};
  bool positive = true;
  for (int i = 0; i < freedoms; ++i) {
    value[i] = value_of(length[i]);
    if (!is_finite(value[i])) {
      return SMS_NOT_A_NUMBER;
    }
    positive = positive && value[i] > V(0);
  }
  for (int i = 0; i < 9; ++i) {
    if (!is_finite(start.rotation(i % 3, i / 3)) || !is_finite(start.position(i % 3))) {
      return SMS_NOT_A_NUMBER;
    }
  }
  if (!positive) {
    return SMS_OUT_OF_WORKSPACE;
  }
  PlatformPose<V> found = start;
  NewtonStep<V> newton;
  const sms_status status = solve_forward(m, equation, value, found, newton, search);
  if (status != SMS_OK) {
    return status;
  }
  // The last step, with the slope of the one before; its errors are of the found pose.
  LegVectors<V> v;
  locate_legs(m, found, v);
  move_by(Vec6<V>(-solution(newton.factors, equation_errors(m, equation, value, v))), found);
  locate_legs(m, found, v);
  search.residual = largest_error(equation, v, equation_errors(m, equation, value, v), 0);
  carry_derivatives(m, equation, length, found, pose);
  return SMS_OK;
}

// Lengths of all legs in a pose, m: closed form.
template <typename S>
void leg_lengths(const ParallelMechanism<S>& m, const PlatformPose<S>& pose, S* length) {
  using std::sqrt;
  LegVectors<S> v;
  locate_legs(m, pose, v);
  for (int i = 0; i < m.legs; ++i) {
    length[i] = sqrt(v.link[i].squaredNorm());
  }
}

// The pose whose driven coordinates are those of `coordinates`, the others found from its own by Newton's method: rods
// keep their lengths and legs their planes. With six freedoms nothing is left to find. On any status but SMS_OK the
// coordinates are as they were.
template <typename V>
sms_status complete_coordinates(const ParallelMechanism<V>& m, Vec6<V>& coordinates, Search<V>& search) {
  search = {0, std::numeric_limits<V>::quiet_NaN(), false};
  LegEquation equation[6];
  if (equations_of(m, equation) != 6) {
    return SMS_OUT_OF_RANGE;
  }
  for (int k = 0; k < 6; ++k) {
    if (!is_finite(coordinates(k))) {
      return SMS_NOT_A_NUMBER;
    }
  }
  const int freedoms = actuated_count(m);
  const V no_length[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};
  search.residual = V(0);
  if (freedoms == 6) {
    return SMS_OK;
  }
  Vec6<V> c = coordinates;
  LegVectors<V> v;
  NewtonStep<V> newton;
  bool close = false;
  while (true) {
    locate_legs(m, pose_of(c), v);
    Vec6<V> error = equation_errors(m, equation, no_length, v);
    search.residual = largest_error(equation, v, error, freedoms);
    if (close) {
      if (!newton.same_sign()) {
        return SMS_OUT_OF_WORKSPACE;
      }
      coordinates = c;
      return SMS_OK;
    }
    if (search.iterations == most_steps_of_search()) {
      return SMS_NOT_CONVERGED;
    }
    Mat6<V> slope = equation_slopes(m, equation, v);
    slope.template rightCols<3>() =
        (slope.template rightCols<3>() * angle_rates_to_angular_velocity(c(4), c(5))).eval();
    for (int k = 0; k < freedoms; ++k) {  // a driven coordinate stays
      slope.row(k).setZero();
      slope(k, m.driven[k]) = V(1);
      error(k) = V(0);
    }
    if (!find_step(slope, error, m.characteristic_length, newton, search)) {
      return SMS_NOT_CONVERGED;
    }
    c -= damping(newton.size) * newton.step;
    ++search.iterations;
    close = newton.size < negligible_step<V>();
  }
}

}  // namespace sms
