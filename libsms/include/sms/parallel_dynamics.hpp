// Dynamics of the platform of a mechanism given by data; its legs have no mass.
//
// Newton and Euler about the platform's origin, in base axes, with a = (v', omega') and c the centre of gravity from
// there:
//
//   m (v' + omega' x c + omega x (omega x c)) = m g + force
//   I omega' + omega x I omega + c x m (v' + ...) = c x m g + moment
//
// or M a + h = J^T f + w. The rows of J are those of parallel_jacobian: f holds the actuated legs' forces (positive
// pushes), the rods' and, across their planes, the legs' lateral forces, all of them without friction. Forces of a
// motion are one linear system. Accelerations of given actuator forces: with the six equations' own accelerations s = J
// a + b (those of rods and planes are 0),
//
//   (J^-T M J^-1) (s - b) = f + J^-T (w - h)
//
// whose rows of the actuated legs have only their s unknown: rods and planes drop out.
#pragma once

#include "sms/parallel_kinematics.hpp"

namespace sms {

template <typename S>
struct PlatformBody {
  S mass;           // kg
  Vec3<S> cog;      // m, platform axes, from the platform's origin
  Mat3<S> inertia;  // kg m^2, platform axes, about the centre of gravity
  Vec3<S> gravity;  // m/s^2, base axes
};

template <typename S>
struct ParallelTerms {
  Mat6<S> jacobian;     // J
  Vec6<S> bias;         // b: s of a motion without acceleration, m/s^2
  Mat6<S> mass_matrix;  // M; kg, kg m, kg m^2
  Vec6<S> passive;      // w - h: weight, centrifugal and gyroscopic terms; N, N m
};

template <typename S>
Mat3<S> cross_matrix(const Vec3<S>& a) {
  Mat3<S> m;
  m << S(0), -a(2), a(1), a(2), S(0), -a(0), -a(1), a(0), S(0);
  return m;
}

// `wrench`: what else acts on the platform, force and moment about its origin, base axes; N, N m.
template <typename S>
void evaluate_parallel(const ParallelMechanism<S>& m, const LegEquation equation[6], const PlatformBody<S>& body,
                       const PlatformPose<S>& pose, const Vec6<S>& twist, const Vec6<S>& wrench, ParallelTerms<S>& t) {
  using std::sqrt;
  const Vec3<S> velocity = twist.template head<3>(), omega = twist.template tail<3>();
  LegVectors<S> v;
  locate_legs(m, pose, v);
  t.jacobian = parallel_jacobian(m, equation, v);
  for (int k = 0; k < 6; ++k) {
    const int i = equation[k].leg;
    const Vec3<S> joint_velocity = velocity + cross(omega, v.arm[i]);
    const Vec3<S> along = t.jacobian.row(k).template head<3>();
    t.bias(k) = along.dot(cross(omega, cross(omega, v.arm[i])));
    if (!equation[k].is_plane) {
      const S rate = along.dot(joint_velocity);
      t.bias(k) += (joint_velocity.squaredNorm() - rate * rate) / sqrt(v.link[i].squaredNorm());
    }
  }
  const Vec3<S> c = pose.rotation * body.cog;
  const Mat3<S> inertia = pose.rotation * body.inertia * pose.rotation.transpose(), lever = cross_matrix(c);
  t.mass_matrix.template topLeftCorner<3, 3>() = body.mass * Mat3<S>::Identity();
  t.mass_matrix.template topRightCorner<3, 3>() = -body.mass * lever;
  t.mass_matrix.template bottomLeftCorner<3, 3>() = body.mass * lever;
  t.mass_matrix.template bottomRightCorner<3, 3>() = inertia - body.mass * lever * lever;
  const Vec3<S> pull = body.mass * (body.gravity - cross(omega, cross(omega, c)));
  const Vec3<S> spin = inertia * omega;
  t.passive.template head<3>() = pull;
  t.passive.template tail<3>() = cross(c, pull) - cross(omega, spin);
  t.passive += wrench;
}

// Forces f of the six equations for an acceleration, N. SMS_NOT_CONVERGED at a singular pose, where none are enough.
template <typename S>
sms_status leg_forces(const ParallelTerms<S>& t, const Vec6<S>& acceleration, Vec6<S>& force) {
  Factors<S> factors;
  factorize(Mat6<S>(t.jacobian.transpose()), factors);
  if (is_singular(factors)) {
    return SMS_NOT_CONVERGED;
  }
  force = solution(factors, Vec6<S>(t.mass_matrix * acceleration - t.passive));
  return SMS_OK;
}

// Acceleration a of the platform for the first `freedoms` of f, N: the actuated legs' forces.
template <typename S>
sms_status platform_acceleration(const ParallelTerms<S>& t, int freedoms, const S* force, Vec6<S>& acceleration) {
  Factors<S> across, along;
  factorize(t.jacobian, along);
  factorize(Mat6<S>(t.jacobian.transpose()), across);
  if (is_singular(along)) {
    return SMS_NOT_CONVERGED;
  }
  Mat6<S> inverse, mass;
  for (int k = 0; k < 6; ++k) {
    inverse.col(k) = solution(along, Vec6<S>(Vec6<S>::Unit(k)));
  }
  mass = inverse.transpose() * t.mass_matrix * inverse;
  Vec6<S> right = solution(across, t.passive) + mass * t.bias;
  for (int k = 0; k < 6; ++k) {
    if (k < freedoms) {
      right(k) += force[k];
    } else {
      mass.row(k) = Vec6<S>::Unit(k).transpose();
      right(k) = S(0);
    }
  }
  Factors<S> in_leg_space;
  factorize(mass, in_leg_space);
  const Vec6<S> s = solution(in_leg_space, right);
  acceleration = solution(along, Vec6<S>(s - t.bias));
  return SMS_OK;
}

}  // namespace sms
