// The platform on its three actuators (dissertation, sections 3.4 and 7.3): the mechanism's equations of motion with the
// air of three cylinders behind their forces.
//
//   M(q) q'' + h(q, q') + g(q) = J(q)^T (F - F_f) + Q                                        dynamics.hpp
//
// F is gas and ends of the stroke, F_f the friction of the pistons, Q what else acts on the platform: a wrench from
// outside and the friction of the Panhard rods' joints. The friction of a piston depends on its own acceleration
// e'' = J q'' + J' q', so the three are solved together in the coordinates of the pistons,
//
//   (J^-T M J^-1) e'' + F_f(e', e'') = F + J^-T (Q - h - g) + (J^-T M J^-1) J' q'            coupled_balance.hpp
//
// Each actuator has parameters of its own; the mechanism was made from those of the first.
//
// What the mechanism brings of this depends on pose and rate alone, and hardly changes in a millisecond. It stands apart,
// for an integrator that evaluates it once a step (slow_terms.hpp).
#pragma once

#include "sms/actuator.hpp"
#include "sms/coupled_balance.hpp"
#include "sms/dynamics.hpp"

namespace sms {

template <typename S>
struct PlatformState {
  using Scalar = S;
  Vec3<S> q;     // roll, pitch, rad; height, m
  Vec3<S> rate;  // q', rad/s, m/s
  ActuatorState<S> actuator[3];
};

template <typename S>
struct PlatformInput {
  Vec3<S> command;  // V
  Wrench<S> wrench;
};

// The mechanism as its pistons have it, near a pose and a rate.
template <typename S>
struct MechanismAtPistons {
  using Scalar = S;
  Vec3<S> q;          // the pose
  Vec3<S> extension;  // there, m
  Mat3<S> slope;      // J
  Mat3<S> to_q;       // J^-1
  Mat3<S> mass;       // J^-T M J^-1, kg
  Vec3<S> bias;       // J' q', m/s^2
  Vec3<S> load;       // J^-T (Q - h - g) + J^-T M J^-1 J' q', N
};

// The workspace of derivative(): it also remembers the last pose and the last accelerations, where the next searches
// begin.
template <typename S>
struct PlatformTerms {
  DynamicsTerms<S> dynamics;
  MechanismAtPistons<S> at_pistons;
  ActuatorTerms<S> actuator[3];
  Vec3<S> extension;
  Vec3<S> velocity;      // e'
  Vec3<S> friction;      // F_f, N
  Vec3<S> acceleration;  // q''
  Vec3<S> along;         // e'' of the pistons by the law of their friction; the next balance begins there
};

template <typename S>
struct Platform {
  using Scalar = S;
  using State = PlatformState<S>;
  using Input = PlatformInput<S>;
  using Terms = PlatformTerms<S>;
  static constexpr int legs = 3;
  Mechanism<S> mechanism;
  Params<S> params[3];  // of each actuator
  ActuatorLaws laws;
};

template <typename S>
Platform<S> make_platform(const Params<S>& p, const ActuatorLaws& laws, MassModel masses) {
  Platform<S> platform;
  platform.mechanism = make_mechanism(p, masses);
  platform.params[0] = platform.params[1] = platform.params[2] = p;
  platform.laws = laws;
  return platform;
}

template <typename S>
void prepare(const Platform<S>& platform, PlatformTerms<S>& t) {
  t.dynamics.pose = rest_pose(platform.mechanism.geometry);
  t.dynamics.motion.eliminated.parasitic.setZero();
  t.along.setZero();
}

// Where the search for the pose of q begins: yaw, x and y of the last pose, carried along as far as q has moved.
template <typename S, typename V>
Pose<V> pose_ahead(const PlatformTerms<S>& t, const Vec3<V>& q) {
  Pose<V> pose = value_of(t.dynamics.pose);
  const Vec3<V> moved(q(0) - pose.roll, q(1) - pose.pitch, q(2) - pose.height);
  const Vec3<V> carried = value_of(t.dynamics.motion.eliminated.parasitic) * moved;
  pose.yaw += carried(0);
  pose.x += carried(1);
  pose.y += carried(2);
  return pose;
}

// Moments of the Panhard rods' joints, viscous: they take c |omega_rod|^2.
template <typename S>
Vec3<S> panhard_load(const Params<S>& p, const Motion<S>& m) {
  Vec3<S> load = Vec3<S>::Zero();
  if (is_absent(p.panhard_friction)) {
    return load;
  }
  for (int i = 3; i < 6; ++i) {
    const S per_speed = p.panhard_friction * m.reciprocal_length[i] * m.reciprocal_length[i];
    load -= per_speed * joint_load(m, i, m.joint_velocity[i]);
  }
  return load;
}

template <typename S>
MechanismAtPistons<S> mechanism_at_pistons(const Platform<S>& platform, const Wrench<S>& wrench,
                                           const DynamicsTerms<S>& d) {
  const Motion<S>& motion = d.motion;
  MechanismAtPistons<S> m;
  m.q << d.pose.roll, d.pose.pitch, d.pose.height;
  for (int i = 0; i < 3; ++i) {
    m.extension(i) = motion.length[i] - platform.mechanism.geometry.actuator_length(i);
  }
  m.slope = motion.extension_slope;
  m.to_q = inverse(m.slope);
  m.mass = symmetric_product<S>(m.to_q, d.mass_matrix * m.to_q);
  m.bias = motion.extension_bias;
  const Vec3<S> other = platform_load(d, wrench) + panhard_load(platform.params[0], motion) - d.inertial - d.weight;
  m.load = m.to_q.transpose() * other + m.mass * m.bias;
  return m;
}

// q'' and the pistons' friction, in the coordinates of the pistons.
template <typename S>
sms_status balance_platform(const Platform<S>& platform, const PlatformState<S>& state,
                            const MechanismAtPistons<S>& mechanism, PlatformTerms<S>& t, PlatformState<S>& rate) {
  const Vec3<S> force(t.actuator[0].force, t.actuator[1].force, t.actuator[2].force);
  const Piston<S> piston[3] = {t.actuator[0].piston, t.actuator[1].piston, t.actuator[2].piston};
  const SealState<S> seals[3] = {seals_of(state.actuator[0]), seals_of(state.actuator[1]), seals_of(state.actuator[2])};
  ForceBalance<S> balance[3];
  const sms_status status = balance_pistons(platform.params, platform.laws.friction, piston, seals, mechanism.mass,
                                            Vec3<S>(force + mechanism.load), t.along, balance);
  if (status == SMS_OK) {
    Vec3<S> along;
    for (int i = 0; i < 3; ++i) {
      along(i) = balance[i].acceleration;
      t.friction(i) = balance[i].friction;
      seal_rates(balance[i], rate.actuator[i]);
    }
    t.acceleration = mechanism.to_q * (along - mechanism.bias);
  }
  return status;
}

// The derivative with the mechanism as it is near by.
template <typename S>
sms_status derivative_near(const Platform<S>& platform, const PlatformState<S>& state, const PlatformInput<S>& input,
                           const MechanismAtPistons<S>& mechanism, PlatformTerms<S>& t, PlatformState<S>& rate) {
  t.extension = mechanism.extension + mechanism.slope * (state.q - mechanism.q);
  t.velocity = mechanism.slope * state.rate;
  for (int i = 0; i < 3; ++i) {
    fill_chambers<S>(platform.params[i], platform.laws, state.actuator[i], t.extension(i), t.velocity(i),
                     t.actuator[i]);
    if (!has_room(t.actuator[i])) {
      return SMS_OUT_OF_RANGE;
    }
    actuator_rates<S>(platform.params[i], platform.laws, state.actuator[i], input.command(i), t.actuator[i],
                      rate.actuator[i]);
  }
  const sms_status status = balance_platform(platform, state, mechanism, t, rate);
  rate.q = state.rate;
  rate.rate = t.acceleration;
  return status == SMS_OK && !is_finite(rate.rate) ? SMS_NOT_A_NUMBER : status;
}

template <typename S>
sms_status derivative(const Platform<S>& platform, const PlatformState<S>& state, const PlatformInput<S>& input,
                      PlatformTerms<S>& t, PlatformState<S>& rate) {
  Pose<S> pose;
  const sms_status status =
      complete_pose(platform.mechanism.geometry, state.q, tilt_of(state.q), pose_ahead(t, value_of(state.q)), pose);
  if (status != SMS_OK) {
    return status;
  }
  evaluate_dynamics(platform.mechanism, pose, state.rate, t.dynamics);
  t.at_pistons = mechanism_at_pistons(platform, input.wrench, t.dynamics);
  return derivative_near(platform, state, input, t.at_pistons, t, rate);
}

template <typename S>
void renew_command(const Platform<S>& platform, const PlatformState<S>& state, const PlatformInput<S>& input,
                   PlatformState<S>& rate) {
  for (int i = 0; i < 3; ++i) {
    drive_rates<S>(platform.params[i], platform.laws, state.actuator[i], input.command(i), rate.actuator[i]);
  }
}

// At rest in a pose, valves closed: the actuators carry the weight, and the mean of the two pressures of each is as
// given, Pa.
template <typename S>
sms_status platform_at_rest(const Platform<S>& platform, const Vec3<S>& q, const S& mean_pressure,
                            PlatformState<S>& state) {
  PlatformTerms<S> t;
  prepare(platform, t);
  const sms_status status =
      dynamics_at(platform.mechanism, q, Vec3<S>(Vec3<S>::Zero()), value_of(t.dynamics.pose), t.dynamics);
  if (status != SMS_OK) {
    return status;
  }
  const Vec3<S> holding = holding_force(t.dynamics, Vec3<S>(Vec3<S>::Zero()));
  state.q = q;
  state.rate.setZero();
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = platform.params[i];
    const PistonAreas<S> area = piston_areas(p);
    const S force = holding(i) + p.ambient_pressure * area.rod;
    const S lower = (force + S(2) * mean_pressure * area.upper) / (area.lower + area.upper);
    state.actuator[i] = actuator_at_rest<S>(p, lower, S(2) * mean_pressure - lower);
  }
  return SMS_OK;
}

template <typename S>
PlatformState<S> state_scale(const Platform<S>&) {
  const ActuatorState<S> actuator = actuator_scale<S>();
  return {Vec3<S>(S(0.2), S(0.2), S(0.4)), Vec3<S>(S(0.5), S(0.5), S(0.5)), {actuator, actuator, actuator}};
}

// After derivative() at this state: what the pistons do is in its terms.
template <typename S>
void switches(const Platform<S>& platform, const PlatformState<S>& state, const PlatformTerms<S>& t,
              S (&value)[3 * actuator_switch_count()]) {
  for (int i = 0; i < 3; ++i) {
    actuator_switches<S>(platform.params[i], platform.laws, state.actuator[i], t.actuator[i].piston, t.along(i),
                         t.friction(i), value + i * actuator_switch_count());
  }
}

// What a plant is asked by whoever closes a loop around it.
template <typename S>
const S& extension_of(const PlatformState<S>&, const PlatformTerms<S>& t, int leg) {
  return t.extension(leg);
}

template <typename S>
void set_command(PlatformInput<S>& input, int leg, const S& command) {
  input.command(leg) = command;
}

}  // namespace sms
