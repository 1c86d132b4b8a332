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
#include "sms/pair.hpp"

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

// A^T B where that is symmetric: six products instead of nine.
template <typename S>
inline Mat3<S> symmetric_product(const Mat3<S>& a, const Mat3<S>& b) {
  const auto of = [&a, &b](int row, int column) -> S { return a.col(row).dot(b.col(column)); };
  return symmetric<S>(of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2));
}

template <typename S>
inline Mat3<S> sum_of_symmetric_product(const Mat3<Pair<S>>& a, const Mat3<Pair<S>>& b) {
  const auto of = [&a, &b](int row, int column) -> S { return Pair<S>(a.col(row).dot(b.col(column))).sum(); };
  return symmetric<S>(of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2));
}

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
  t.mass_matrix += body.mass * symmetric_product(velocity, velocity) + symmetric_product(turning, momentum);

  const Vec3<S> omega = rotation.transpose() * m.angular_velocity;
  const Vec3<S> alpha = rotation.transpose() * m.angular_bias;
  const Vec3<S> spinning = body.inertia * omega, speeding = body.inertia * alpha;
  const Vec3<S> acceleration = m.linear_bias + m.arm_bias * arm;
  t.inertial +=
      body.mass * (velocity.transpose() * acceleration) + turning.transpose() * (speeding + cross(omega, spinning));
  t.weight -= (body.mass * gravity) * velocity.row(2).transpose();
  t.potential_energy -= body.mass * gravity * (arm(2) - t.pose.height);
}

// Actuator i and Panhard rod i side by side, as link_dynamics.hpp sees them. A rod is a link that nothing slides in.
template <typename S>
struct LinkView {
  Mat3<S> axes;  // columns in world axes
  LinkState<S> state;
  BaseLoad<S> base;
  S potential_energy;  // J, zero at ground
};

template <typename S>
inline Body<Pair<S>> pair_of(const Body<S>& a, const Body<S>& b) {
  return {Pair<S>(a.mass, b.mass), pair_of(a.cog, b.cog), pair_of(a.inertia, b.inertia)};
}

template <typename S>
inline LinkView<Pair<S>> link_view(const Mechanism<S>& mechanism, int i, const Motion<S>& m) {
  using Two = Pair<S>;
  const int rod = i + 3;
  const Bodies<S>& bodies = mechanism.bodies;
  const Body<S> none = {S(0), Vec3<S>::Zero(), Mat3<S>::Zero()};
  const LinkAxes<Two> frame = link_axes(pair_of(m.direction[i], m.direction[rod]),
                                        pair_of(mechanism.geometry.joint_axis[i], mechanism.geometry.joint_axis[rod]));
  const Eigen::Matrix<Two, 2, 3> across = frame.axes.template leftCols<2>().transpose();
  LinkView<Two> view;
  view.axes = frame.axes;
  view.state.reciprocal_length = Two(m.reciprocal_length[i], m.reciprocal_length[rod]);
  view.state.axis_slope = frame.axis_slope;
  view.state.velocity = across * pair_of(m.joint_velocity[i], m.joint_velocity[rod]);
  view.state.acceleration = across * pair_of(m.joint_bias[i], m.joint_bias[rod]);
  view.state.slide_rate = Two(m.extension_rate(i), S(0));
  view.state.slide_acceleration = Two(m.extension_bias(i), S(0));
  view.state.gravity = Two(mechanism.gravity) * frame.axes.row(2).transpose();
  view.base = base_load(pair_of(bodies.hung[i], bodies.hung[rod]), pair_of(bodies.sliding[i], none),
                        Two(m.length[i], m.length[rod]));
  const Two base_height(-mechanism.geometry.base[i](2), -mechanism.geometry.base[rod](2));
  view.potential_energy =
      Two(mechanism.gravity) * view.base.mass * base_height - view.state.gravity.dot(view.base.first_moment);
  return view;
}

// Link by link, in its axes: what it brings to P, seen through the velocity of P per q'.
template <typename S>
void add_links(const Mechanism<S>& mechanism, DynamicsTerms<S>& t) {
  using Two = Pair<S>;
  const Motion<S>& m = t.motion;
  const Attitude<Two> attitude = {pair_of(m.attitude.rotation), pair_of(m.attitude.roll_axis),
                                  pair_of(m.attitude.pitch_axis)};
  const Mat3<Two> parasitic = pair_of(m.eliminated.parasitic);
  for (int i = 0; i < 3; ++i) {
    const LinkView<Two> link = link_view(mechanism, i, m);
    const LinkLoad<Two> load = link_load(link.base, link.state, link_motion(link.state));
    const Vec3<Two> arm = pair_of(m.links.arm[i], m.links.arm[i + 3]);
    Mat3<Two> velocity;
    velocity.row(0) = constrained(point_slope(attitude, arm, Vec3<Two>(link.axes.col(0))), parasitic);
    velocity.row(1) = constrained(point_slope(attitude, arm, Vec3<Two>(link.axes.col(1))), parasitic);
    velocity.row(2) = pair_of(Vec3<S>(m.extension_slope.row(i)), Vec3<S>(Vec3<S>::Zero()));
    const Mat3<Two> momentum = load.apparent_mass * velocity;
    t.mass_matrix += sum_of_symmetric_product(velocity, momentum);
    t.inertial += sum(Vec3<Two>(velocity.transpose() * load.inertial));
    t.weight += sum(Vec3<Two>(velocity.transpose() * load.weight));
    t.potential_energy += link.potential_energy.sum();
  }
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
  if (mechanism.bodies.moving == MovingBodies::all) {
    add_links(mechanism, t);
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
  return solution<S>(t.mass_matrix, load - t.inertial - t.weight);
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
  const sms_status status = complete_pose(mechanism.geometry, q, tilt_of(q), start, pose);
  if (status == SMS_OK) {
    evaluate_dynamics(mechanism, pose, rate, terms);
  }
  return status;
}

}  // namespace sms
