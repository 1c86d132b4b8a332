// Rigid-body dynamics of the whole mechanism in q = (roll, pitch, height).
//
//   M(q) q'' + h(q, q') + g(q) = J(q)^T F + Q
//
// M the mass matrix, h the forces of Coriolis and centrifugal kind, g the weights' (gradient of the potential energy),
// F the actuators' forces (N, positive pushing out), Q what else acts on the platform. The rods' constraint is
// eliminated exactly by the maps of motion.hpp, so there is nothing to drift: three equations for three freedoms, by
// the principle of virtual power (Kane). Each body contributes what it would have as a free one, seen through the
// velocity of q: the platform through W and V, a link through the velocity of its platform joint (link_dynamics.hpp).
#pragma once

#include "sms/inverse_kinematics.hpp"
#include "sms/link_dynamics.hpp"
#include "sms/motion.hpp"

namespace sms {

template <typename S>
struct Mechanism {
  Geometry<S> geometry;
  Bodies<S> bodies;
  S gravity;  // m/s^2, along z
};

template <typename S>
Mechanism<S> make_mechanism(const Params<S>& p, MassModel model) {
  const Geometry<S> geometry = make_geometry(p);
  return {geometry, make_bodies(p, geometry, model), p.gravity};
}

// All that the equation of motion is made of, at one pose and velocity.
template <typename S>
struct DynamicsTerms {
  Pose<S> pose;      // evaluate_dynamics()
  Motion<S> motion;  // place() and move(), called by evaluate_dynamics()
  // add_platform() and add_link(), called by evaluate_dynamics():
  Mat3<S> mass_matrix;  // M; kg m^2, kg m, kg
  Vec3<S> inertial;     // h; N m, N m, N
  Vec3<S> weight;       // g; N m, N m, N
  S potential_energy;   // J, zero at ground
};

template <typename S>
void add_platform(const Body<S>& body, const S& gravity, DynamicsTerms<S>& t) {
  const Motion<S>& m = t.motion;
  const Mat3<S>& rotation = m.attitude.rotation;
  const Vec3<S> arm = rotation * body.cog;
  Mat3<S> velocity;  // of the centre of gravity, per q'
  for (int k = 0; k < 3; ++k) {
    velocity.col(k) = m.linear.col(k) + cross(Vec3<S>(m.angular.col(k)), arm);
  }
  const Mat3<S> turning = rotation.transpose() * m.angular;  // angular velocity per q', platform axes
  const Mat3<S> momentum = body.inertia * turning;
  t.mass_matrix += body.mass * (velocity.transpose() * velocity) + turning.transpose() * momentum;

  const Vec3<S> omega = rotation.transpose() * m.angular_velocity;
  const Vec3<S> alpha = rotation.transpose() * m.angular_bias;
  const Vec3<S> spinning = body.inertia * omega, speeding = body.inertia * alpha;
  const Vec3<S> circling = cross(m.angular_velocity, arm);
  const Vec3<S> acceleration = m.linear_bias + cross(m.angular_bias, arm) + cross(m.angular_velocity, circling);
  t.inertial +=
      body.mass * (velocity.transpose() * acceleration) + turning.transpose() * (speeding + cross(omega, spinning));
  t.weight -= (body.mass * gravity) * velocity.row(2).transpose();
  t.potential_energy -= body.mass * gravity * (arm(2) - t.pose.height);
}

// Link i as link_dynamics.hpp sees it.
template <typename S>
struct LinkView {
  Mat3<S> to_link;  // world axes to link axes
  LinkState<S> state;
  BaseLoad<S> base;
};

template <typename S>
LinkView<S> link_view(const Mechanism<S>& mechanism, int i, const Motion<S>& m) {
  const LinkAxes<S> frame = link_axes(m.direction[i], mechanism.geometry.joint_axis[i]);
  const Mat3<S> to_link = frame.axes.transpose();
  const LinkState<S> state = {m.reciprocal_length[i], frame.axis_slope, to_link * m.joint_velocity[i],
                              to_link * m.joint_bias[i], mechanism.gravity * to_link.col(2)};
  const Bodies<S>& bodies = mechanism.bodies;
  return {to_link, state,
          i < 3 ? base_load(bodies.hung[i], bodies.sliding[i], m.length[i]) : base_load(bodies.hung[i])};
}

template <typename S>
void add_link(const Mechanism<S>& mechanism, int i, DynamicsTerms<S>& t) {
  const LinkView<S> link = link_view(mechanism, i, t.motion);
  const LinkLoad<S> load = link_load(link.base, link.state);
  const Mat3<S> joint = link.to_link * t.motion.joint[i];  // velocity of P per q', link axes
  t.mass_matrix += joint.transpose() * (load.apparent_mass * joint);
  t.inertial += joint.transpose() * load.inertial;
  t.weight += joint.transpose() * load.weight;
  const S mass = mechanism.bodies.hung[i].mass + link.base.sliding_mass;
  t.potential_energy -=
      mass * mechanism.gravity * mechanism.geometry.base[i](2) + link.state.gravity.dot(link.base.first_moment);
}

// M, h, g and U in a pose that fits the rods, at the rate q'.
template <typename S>
void evaluate_dynamics(const Mechanism<S>& mechanism, const Pose<S>& pose, const Vec3<S>& rate, DynamicsTerms<S>& t) {
  t.pose = pose;
  place(mechanism.geometry, pose, t.motion);
  move(rate, t.motion);
  t.mass_matrix.setZero();
  t.inertial.setZero();
  t.weight.setZero();
  t.potential_energy = S(0);
  add_platform(mechanism.bodies.platform, mechanism.gravity, t);
  for (int i = 0; mechanism.bodies.links_move && i < 6; ++i) {
    add_link(mechanism, i, t);
  }
}

// Force and moment on the platform, world axes, the moment about the reference point.
template <typename S>
struct Wrench {
  Vec3<S> force;   // N
  Vec3<S> moment;  // N m
};

// The wrench of a force on a point of the platform, given in platform axes from the reference point.
template <typename S>
Wrench<S> force_at(const DynamicsTerms<S>& t, const Vec3<S>& point, const Vec3<S>& force) {
  return {force, cross(Vec3<S>(t.motion.attitude.rotation * point), force)};
}

// Generalised forces: of the actuators, and of a wrench on the platform.
template <typename S>
Vec3<S> actuator_load(const DynamicsTerms<S>& t, const Vec3<S>& force) {
  return t.motion.extension_slope.transpose() * force;
}

template <typename S>
Vec3<S> platform_load(const DynamicsTerms<S>& t, const Wrench<S>& wrench) {
  return t.motion.linear.transpose() * wrench.force + t.motion.angular.transpose() * wrench.moment;
}

// q'' under a generalised force.
template <typename S>
Vec3<S> acceleration(const DynamicsTerms<S>& t, const Vec3<S>& load) {
  return inverse(t.mass_matrix) * (load - t.inertial - t.weight);
}

// Actuator forces that give q'' under a generalised force from elsewhere.
template <typename S>
Vec3<S> actuator_force(const DynamicsTerms<S>& t, const Vec3<S>& acceleration, const Vec3<S>& load) {
  const Vec3<S> needed = t.mass_matrix * acceleration + t.inertial + t.weight - load;
  return inverse(Mat3<S>(t.motion.extension_slope.transpose())) * needed;
}

// Actuator forces that hold the pose at rest, for terms evaluated at q' = 0.
template <typename S>
Vec3<S> holding_force(const DynamicsTerms<S>& t, const Vec3<S>& load) {
  return actuator_force(t, Vec3<S>(Vec3<S>::Zero()), load);
}

template <typename S>
S kinetic_energy(const DynamicsTerms<S>& t, const Vec3<S>& rate) {
  const Vec3<S> momentum = t.mass_matrix * rate;
  return S(0.5) * rate.dot(momentum);
}

// The terms at q and q', from inverse kinematics that starts at `start`; untouched on any status but SMS_OK.
template <typename S>
sms_status dynamics_at(const Mechanism<S>& mechanism, const Vec3<S>& q, const Vec3<S>& rate,
                       const Pose<ValueOf<S>>& start, DynamicsTerms<S>& terms) {
  if (!is_finite(rate)) {
    return SMS_NOT_A_NUMBER;
  }
  Pose<S> pose;
  Vec3<S> extension;
  Convergence<ValueOf<S>> convergence;
  const sms_status status = inverse_kinematics(mechanism.geometry, q, start, pose, extension, convergence);
  if (status == SMS_OK) {
    evaluate_dynamics(mechanism, pose, rate, terms);
  }
  return status;
}

}  // namespace sms
