// Forward kinematics: three extensions to the whole pose.
//
// Six distances determine six coordinates: Newton's method on |l_i|^2 = L_i^2 with its exact Jacobian. Lengths do not
// care about axes; in axes that yaw with the platform the arms are Ry Rx p_i, the links
//
//   l_i = Ry Rx p_i + Rz(-yaw) ((x, y, -height) - b_i)
//
// and roll, pitch, height, yaw and the moves along these axes change |l_i|^2 / 2 by, with m_i = r_i x l_i,
//
//   m_x cos(pitch) - m_z sin(pitch),  m_y,  -l_z;   m_z,  l_x,  l_y
//
// The 6x6 system falls apart in two of 3x3: the Panhard rods give the parasitic coordinates (yaw, x, y) for any step of
// the driven ones, the actuators give that step. Both matrices are well conditioned all over the stroke, so that
// neither needs a pivot.
//
// There are eight more solutions at tilts above 40 deg: other machines. A pose beyond largest_angle() is refused.
#pragma once

#include "sms/links.hpp"
#include "sms/newton.hpp"
#include "sms/pair.hpp"
#include "sms/sms.h"

namespace sms {

// Sines and cosines of a pose's angles.
template <typename S>
struct PoseAngles {
  SineCosine<S> roll;
  SineCosine<S> pitch;
  SineCosine<S> yaw;
};

template <typename S>
inline SineCosine<Pair<S>> pair_of(const SineCosine<S>& both) {
  return {Pair<S>(both.sine), Pair<S>(both.cosine)};
}

template <typename S>
inline PoseAngles<S> angles_of(const Pose<S>& pose) {
  return {sine_cosine(pose.roll), sine_cosine(pose.pitch), sine_cosine(pose.yaw)};
}

// r_i and l_i in the yawed axes.
template <typename S>
struct YawedLink {
  Vec3<S> arm;
  Vec3<S> link;
};

// Actuator i and rod i.
template <typename S>
inline YawedLink<Pair<S>> yawed_links(const Geometry<S>& g, int i, const Pose<S>& pose, const PoseAngles<S>& angles) {
  using Two = Pair<S>;
  const Vec3<Two> base = pair_of(g.base[i], g.base[i + 3]);
  const Two x = Two(pose.x) - base(0), y = Two(pose.y) - base(1), cosine(angles.yaw.cosine), sine(angles.yaw.sine);
  YawedLink<Two> l;
  l.arm = tilted(pair_of(angles.roll), pair_of(angles.pitch), pair_of(g.platform[i], g.platform[i + 3]));
  l.link << l.arm(0) + cosine * x + sine * y, l.arm(1) + cosine * y - sine * x, l.arm(2) - Two(pose.height) - base(2);
  return l;
}

// Half the excess of each link's squared length, m^2.
template <typename S>
struct LinkExcess {
  Vec3<S> actuator;
  Vec3<S> panhard;
};

template <typename S>
inline void set_excess(LinkExcess<S>& excess, int i, const Vec3<Pair<S>>& link, const Pair<S>& length) {
  const Pair<S> half = Pair<S>(S(0.5)) * (dot(link, link) - length * length);
  excess.actuator(i) = half.actuator();
  excess.panhard(i) = half.rod();
}

template <typename S>
LinkExcess<S> link_excess(const Geometry<S>& g, const Vec3<S>& actuator_length, const Pose<S>& pose) {
  const PoseAngles<S> angles = angles_of(pose);
  LinkExcess<S> excess;
  for (int i = 0; i < 3; ++i) {
    set_excess(excess, i, yawed_links(g, i, pose, angles).link, Pair<S>(actuator_length(i), g.panhard_length(i)));
  }
  return excess;
}

template <typename V>
V length_error(const LinkExcess<V>& excess, const Vec3<V>& actuator_length, const Vec3<V>& panhard_length) {
  return larger(largest_magnitude(Vec3<V>(excess.actuator.cwiseQuotient(actuator_length))),
                largest_magnitude(Vec3<V>(excess.panhard.cwiseQuotient(panhard_length))));
}

// The linearised problem, ready to be solved for any excess.
template <typename V>
struct PoseSolver {
  Mat3<V> panhard_inverse;     // of the rods' slopes by the parasitic coordinates
  Mat3<V> parasitic;           // d(yaw, x, y) / d(roll, pitch, height), in the yawed axes
  Mat3<V> actuator_parasitic;  // the actuators' slopes by the parasitic coordinates
  Mat3<V> actuator_inverse;    // of their slopes by the driven ones, when the parasitic ones follow
  SineCosine<V> yaw;           // turns a move in the yawed axes into one of x and y
};

template <typename S>
struct PoseStep {
  Vec3<S> driven;     // roll, pitch, height
  Vec3<S> parasitic;  // yaw, x, y
};

template <typename S, typename V>
PoseStep<S> newton_step(const PoseSolver<V>& solver, const LinkExcess<S>& excess) {
  const auto times = [](const Mat3<V>& m, const Vec3<S>& v) { return product(Mat3<S>(m.template cast<S>()), v); };
  const Vec3<S> held = times(solver.panhard_inverse, excess.panhard);
  const Vec3<S> left = times(solver.actuator_parasitic, held) - excess.actuator;
  PoseStep<S> step;
  step.driven = times(solver.actuator_inverse, left);
  const Vec3<S> yawed = times(solver.parasitic, step.driven) - held;
  const S cosine = S(solver.yaw.cosine), sine = S(solver.yaw.sine);
  step.parasitic << yawed(0), cosine * yawed(1) - sine * yawed(2), sine * yawed(1) + cosine * yawed(2);
  return step;
}

template <typename S>
inline void advance(Pose<S>& pose, const PoseStep<S>& step, const S& factor) {
  pose.roll += factor * step.driven(0);
  pose.pitch += factor * step.driven(1);
  pose.height += factor * step.driven(2);
  pose.yaw += factor * step.parasitic(0);
  pose.x += factor * step.parasitic(1);
  pose.y += factor * step.parasitic(2);
}

template <typename V>
bool within_largest_angle(const Pose<V>& pose) {
  using std::abs;
  return all(abs(pose.roll) <= largest_angle<V>() && abs(pose.pitch) <= largest_angle<V>() &&
             abs(pose.yaw) <= largest_angle<V>());
}

// Newton's method up to the last step. The solver is that of the last step taken.
template <typename V>
struct PoseSolution {
  Pose<V> pose;
  PoseSolver<V> solver;
};

template <typename V>
inline void set_slopes(LinkSlopes<V>& slopes, int i, const YawedLink<Pair<V>>& l, const SineCosine<V>& pitch) {
  const Vec3<Pair<V>> moment = cross(l.arm, l.link);
  const Pair<V> pitch_cosine(pitch.cosine), pitch_sine(pitch.sine);
  const Vec3<Pair<V>> driven(moment(0) * pitch_cosine - moment(2) * pitch_sine, moment(1), -l.link(2));
  const Vec3<Pair<V>> parasitic(moment(2), l.link(0), l.link(1));
  for (int k = 0; k < 3; ++k) {
    slopes.actuator_driven(i, k) = driven(k).actuator();
    slopes.actuator_parasitic(i, k) = parasitic(k).actuator();
    slopes.panhard_driven(i, k) = driven(k).rod();
    slopes.panhard_parasitic(i, k) = parasitic(k).rod();
  }
}

// Excess and slopes in one go.
template <typename V>
LinkExcess<V> evaluate_pose(const Geometry<V>& g, const Vec3<V>& length, const Pose<V>& pose, PoseSolver<V>& solver) {
  const PoseAngles<V> angles = angles_of(pose);
  LinkExcess<V> excess;
  LinkSlopes<V> slopes;
  for (int i = 0; i < 3; ++i) {
    const YawedLink<Pair<V>> links = yawed_links(g, i, pose, angles);
    set_slopes(slopes, i, links, angles.pitch);
    set_excess(excess, i, links.link, Pair<V>(length(i), g.panhard_length(i)));
  }
  Elimination<V> eliminated;
  eliminate_parasitic(slopes, eliminated);
  solver.panhard_inverse = eliminated.panhard_inverse;
  solver.parasitic = eliminated.parasitic;
  solver.actuator_parasitic = slopes.actuator_parasitic;
  solver.actuator_inverse = inverse(eliminated.actuator);
  solver.yaw = angles.yaw;
  return excess;
}

// Where the solver of a step is worked out: in place of the last one; beside it where some of several poses side by side
// keep theirs (lanes.hpp).
template <typename V>
struct NextSolver {
  PoseSolver<V>& solver;
  explicit NextSolver(PoseSolver<V>& last) : solver(last) {}
  void renew_where(bool /*moving*/, PoseSolver<V>& /*last*/) const {}
};

// Of poses side by side those that have arrived stand still until all have, so that none depends on its neighbours.
template <typename V>
sms_status solve_pose(const Geometry<V>& g, const Vec3<V>& length, PoseSolution<V>& solution, Count<V>& iterations) {
  auto moving = V(0) < V(1);
  iterations = Count<V>(0);
  for (int n = 0; n < largest_iteration_count(); ++n) {
    NextSolver<V> next(solution.solver);
    const LinkExcess<V> excess = evaluate_pose(g, length, solution.pose, next.solver);
    const PoseStep<V> step = newton_step(next.solver, excess);
    const V largest = larger(largest_magnitude(step.driven), largest_magnitude(step.parasitic));
    Pose<V> stepped = solution.pose;
    advance(stepped, step, damping(largest));
    renew(moving, solution.pose, stepped);
    next.renew_where(moving, solution.solver);
    iterations += select(moving, Count<V>(1), Count<V>(0));
    if (!within_largest_angle(solution.pose)) {
      return SMS_OUT_OF_WORKSPACE;
    }
    moving = moving && !(largest < close_step<V>());
    if (!any(moving)) {
      return SMS_OK;
    }
  }
  return SMS_NOT_CONVERGED;
}

template <typename S, typename V>
Pose<S> stepped(const Geometry<S>& g, const Vec3<S>& length, Pose<S> pose, const PoseSolver<V>& solver) {
  advance(pose, newton_step(solver, link_excess(g, length, pose)), S(1));
  return pose;
}

template <typename V>
Pose<V> last_step_of_pose(const Geometry<V>& g, const Geometry<V>& /*the same*/, const Vec3<V>& length,
                          const PoseSolution<V>& solution) {
  return stepped(g, length, solution.pose, solution.solver);
}

// With derivatives: first in their values, then once more with the slope of the solution itself.
template <typename S, typename V>
Pose<S> last_step_of_pose(const Geometry<S>& g, const Geometry<V>& geometry, const Vec3<S>& length,
                          const PoseSolution<V>& solution) {
  const Pose<V> found = stepped(geometry, value_of(length), solution.pose, solution.solver);
  PoseSolver<V> solver;
  evaluate_pose(geometry, value_of(length), found, solver);
  return stepped(g, length, cast<S>(found), solver);
}

// The search starts at `start`, which may be any pose of the built machine. On any status but SMS_OK the pose is as it
// was.
template <typename S>
sms_status forward_kinematics(const Geometry<S>& g, const Vec3<S>& extension, const Pose<ValueOf<S>>& start,
                              Pose<S>& pose, Convergence<ValueOf<S>>* convergence = nullptr) {
  using V = ValueOf<S>;
  if (convergence != nullptr) {
    *convergence = not_begun<V>();
  }
  if (!is_finite(extension) || !is_finite(start)) {
    return SMS_NOT_A_NUMBER;
  }
  const Vec3<S> length = g.actuator_length + extension;
  for (int i = 0; i < 3; ++i) {
    if (!all(value_of(length(i)) > V(0))) {
      return SMS_OUT_OF_WORKSPACE;
    }
  }
  const Geometry<V>& geometry = value_of(g);
  const Mat3<V> none = Mat3<V>::Zero();
  PoseSolution<V> solution = {start, {none, none, none, none, {V(0), V(1)}}};
  Count<V> iterations(0);
  const sms_status status = solve_pose(geometry, value_of(length), solution, iterations);
  const Pose<S> found = last_step_of_pose(g, geometry, length, solution);
  if (convergence != nullptr) {
    const Pose<V> last = status == SMS_OK ? value_of(found) : solution.pose;
    const LinkExcess<V> left = link_excess(geometry, value_of(length), last);
    *convergence = {iterations, length_error(left, value_of(length), geometry.panhard_length)};
  }
  if (status != SMS_OK) {
    return status;
  }
  pose = found;
  return SMS_OK;
}

}  // namespace sms
