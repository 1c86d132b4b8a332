// A plant through time where it is stiff, in steps of a fixed size.
//
// Friction inside its ramp is stiff (38 N over 5 mm/s on 3.6 kg: 0.3 ms), and so are a chamber that is nearly closed, a
// reservoir behind a short line, a spool of some 100 Hz and the contact at an end. A Rosenbrock method of second order
// with an approximate Jacobian A (ROS2; Verwer, Spee, Blom and Hundsdorfer 1999) stays stable there and keeps its order
// whatever A is:
//
//   (I - gamma h A) k1 = f(t, y)
//   (I - gamma h A) k2 = f(t + h, y + h k1) - 2 k1,      y + h (3 k1 + k2) / 2,      gamma = 1 - 1/sqrt(2)
//
// A has the slope of friction and contact for (x, v), that of the film for its own speed and the piston's, a chamber's flow
// over its pressure difference for each pressure, the spool and the filter in front of it each as it is, and in a tank the
// exchange of its air for the temperature.
//
// Two evaluations a step, and in Jets the exact derivatives of the discrete solution: what is held against records
// window by window takes these steps.
#pragma once

#include "sms/bench.hpp"
#include "sms/integrate.hpp"
#include "sms/platform.hpp"
#include "sms/tank.hpp"

namespace sms {

// gamma of the step.
template <typename S>
S stiff_share() {
  return S(0.29289321881345254);
}

// One step of size h. k1 is the rate at its beginning, and is used up; `end_rate(moved, k2)` gives the rate a step later,
// `solve(k)` divides k by I - gamma h A. On any but SMS_OK the state stays as it was.
template <typename State, typename EndRate, typename Solve>
sms_status stiff_step(const EndRate& end_rate, const Solve& solve, const typename State::Scalar& h, State& k1,
                      State& state) {
  using S = typename State::Scalar;
  State k2, moved;
  solve(k1);
  vector_of(moved) = vector_of(const_cast<const State&>(state)) + h * vector_of(k1);
  const sms_status status = end_rate(const_cast<const State&>(moved), k2);
  if (status != SMS_OK) {
    return status;
  }
  vector_of(k2) -= S(2) * vector_of(k1);
  solve(k2);
  vector_of(state) += (S(0.5) * h) * (S(3) * vector_of(k1) + vector_of(k2));
  return SMS_OK;
}

// |flow| over pressure difference, kg/(s Pa).
template <typename S>
S flow_secant(const S& flow, const S& from, const S& to) {
  using std::abs;
  const S difference = abs(from - to);
  return abs(flow) / (difference > S(100) ? difference : S(100));
}

// ---- what follows the command alone ----

template <typename S>
struct DriveStiffness {
  S spool;  // natural frequency, rad/s
  S spool_damping_ratio;
  S filter;  // zero where there is none
  S filter_damping_ratio;
};

template <typename S>
DriveStiffness<S> drive_stiffness(const Params<S>& p, DriveLaw law) {
  const bool filtered = law == DriveLaw::filtered;
  return {angular_frequency(p.valve_frequency), p.valve_damping_ratio,
          filtered ? angular_frequency(p.dac_filter_frequency) : S(0), p.dac_filter_damping_ratio};
}

template <typename S>
void solve_drive(const DriveStiffness<S>& s, const S& g, ActuatorState<S>& rate) {
  solve_lag<S>(s.spool, s.spool_damping_ratio, g, rate.spool);
  if (s.filter > S(0)) {
    solve_lag<S>(s.filter, s.filter_damping_ratio, g, rate.drive);
  }
}

// ---- an actuator that moves a mass ----

template <typename S>
struct ActuatorStiffness {
  S motion_position;  // d v'/d x
  S motion_velocity;  // d v'/d v
  S lower;            // d p_a'/d p_a
  S upper;
  S reservoir;
  S deflection;
  S film;  // d w'/d w, and with the other sign d w'/d v
  DriveStiffness<S> drive;
};

// `mass` in kg.
template <typename S>
ActuatorStiffness<S> actuator_stiffness(const Params<S>& p, const ActuatorLaws& laws, const S& mass,
                                        const ActuatorTerms<S>& a) {
  using std::abs;
  using std::cos;
  const FrictionLaw law = laws.friction;
  const S& extension = a.piston.extension;
  const S speed = abs(a.piston.velocity);
  S damping = p.viscous_friction + exponential_friction_slope(p, a.piston.velocity);
  if (law != FrictionLaw::dahl && law != FrictionLaw::lugre && speed < p.stiction_velocity) {
    const S steep = S(1.5707963267948966) / p.stiction_velocity;
    damping += p.coulomb_force * steep * cos(steep * speed);
  } else if (law == FrictionLaw::lugre) {
    damping += p.bristle_damping;
  }
  const bool contact = extension < S(0) || extension > p.stroke;
  if (contact) {
    damping += p.end_stop_stiffness * p.end_stop_damping * S(1e-4);
  }
  const S air = p.compression_heat_ratio * p.gas_constant * p.air_temperature;
  const Gas<S>&lower = a.ports.lower, &upper = a.ports.upper, &outside = a.ports.exhaust, &supply = a.ports.supply;
  const S feed_lower = flow_secant(a.edge.supply_lower, supply.pressure, lower.pressure);
  const S feed_upper = flow_secant(a.edge.supply_upper, supply.pressure, upper.pressure);
  const S vent_lower = flow_secant(a.edge.lower_exhaust, lower.pressure, outside.pressure);
  const S vent_upper = flow_secant(a.edge.upper_exhaust, upper.pressure, outside.pressure);
  ActuatorStiffness<S> s;
  s.motion_position = contact ? S(-(p.end_stop_stiffness / mass)) : S(0);
  s.motion_velocity = -(damping / mass);
  s.lower = -(air / a.lower.volume * (feed_lower + vent_lower));
  s.upper = -(air / a.upper.volume * (feed_upper + vent_upper));
  const S line = supply_line_slope<S>(p, p.supply_pressure - supply.pressure);
  s.reservoir =
      p.supply_line_resistance > S(0) ? S(-(air / p.reservoir_volume * (S(1) / line + feed_lower + feed_upper))) : S(0);
  s.deflection = law == FrictionLaw::lugre || law == FrictionLaw::dahl || p.presliding_share > S(0)
                     ? S(-(speed * p.bristle_stiffness / p.coulomb_force))
                     : S(0);
  s.film = film_is_state(p) ? S(-(S(1) / p.friction_lag)) : S(0);
  s.drive = drive_stiffness(p, laws.drive);
  return s;
}

// `acceleration`: of the piston, solved for.
template <typename S>
void solve_beside_motion(const ActuatorStiffness<S>& s, const S& g, const S& acceleration, ActuatorState<S>& rate) {
  rate.lower.pressure /= S(1) - g * s.lower;
  rate.upper.pressure /= S(1) - g * s.upper;
  rate.supply_pressure /= S(1) - g * s.reservoir;
  rate.deflection /= S(1) - g * s.deflection;
  if (s.film < S(0)) {
    rate.film = (rate.film - g * s.film * acceleration) / (S(1) - g * s.film);
  }
  solve_drive(s.drive, g, rate);
}

// k with (I - g A) k = rate
template <typename S>
void solve_stiff(const ActuatorStiffness<S>& s, const S& g, BenchState<S>& rate) {
  rate.velocity = (rate.velocity + g * s.motion_position * rate.extension) /
                  (S(1) - g * s.motion_velocity - g * g * s.motion_position);
  rate.extension = rate.extension + (s.motion_position < S(0) ? S(g * rate.velocity) : S(0));
  solve_beside_motion(s, g, rate.velocity, rate.actuator);
}

template <typename S>
ActuatorStiffness<S> stiffness(const Bench<S>& bench, const BenchState<S>&, const BenchTerms<S>& t) {
  return actuator_stiffness(bench.params, bench.laws, bench.params.moving_mass, t.actuator);
}

// ---- three of them under the platform ----

template <typename S>
struct PlatformStiffness {
  ActuatorStiffness<S> leg[3];  // of 1 kg each
  Mat3<S> mass;                 // in the coordinates of the mechanism
  Mat3<S> slope;                // J
};

template <typename S>
PlatformStiffness<S> stiffness(const Platform<S>& platform, const PlatformState<S>&, const PlatformTerms<S>& t) {
  PlatformStiffness<S> s;
  for (int i = 0; i < 3; ++i) {
    s.leg[i] = actuator_stiffness<S>(platform.params[i], platform.laws, S(1), t.actuator[i]);
  }
  s.mass = t.dynamics.mass_matrix;
  s.slope = t.dynamics.motion.extension_slope;
  return s;
}

template <typename S>
void solve_stiff(const PlatformStiffness<S>& s, const S& g, PlatformState<S>& rate) {
  Mat3<S> damping = Mat3<S>::Zero(), spring = Mat3<S>::Zero();
  bool contact = false;
  for (int i = 0; i < 3; ++i) {
    damping(i, i) = -s.leg[i].motion_velocity;
    spring(i, i) = -s.leg[i].motion_position;
    contact = contact || spring(i, i) > S(0);
  }
  const Mat3<S> stiff = s.slope.transpose() * (spring * s.slope);
  const Mat3<S> left = s.mass + g * (s.slope.transpose() * (damping * s.slope)) + (g * g) * stiff;
  rate.rate = solution<S>(left, s.mass * rate.rate - g * (stiff * rate.q));
  if (contact) {
    rate.q += g * rate.rate;
  }
  const Vec3<S> along = s.slope * rate.rate;
  for (int i = 0; i < 3; ++i) {
    solve_beside_motion<S>(s.leg[i], g, along(i), rate.actuator[i]);
  }
}

// ---- a tank ----

template <typename S>
struct TankStiffness {
  S pressure;     // d p'/d p
  S temperature;  // d T'/d T
  S reservoir;    // d p_R'/d p_R
  S spool;        // natural frequency, rad/s
  S spool_damping_ratio;
};

template <typename S>
TankStiffness<S> stiffness(const Tank<S>& tank, const TankState<S>& state, const TankTerms<S>& t) {
  const Params<S>& p = tank.params;
  const S of_air = p.gas_constant * p.air_temperature, stiff_air = p.heat_capacity_ratio * of_air;
  const S feed = flow_secant<S>(t.feed, state.supply_pressure, t.air.pressure);
  const S vent = flow_secant<S>(t.vent, t.air.pressure, p.ambient_pressure);
  const S thin = t.air.pressure > S(1e3) ? t.air.pressure : S(1e3);  // a bad guess may have emptied the tank
  TankStiffness<S> s;
  s.pressure = -(stiff_air / t.space.volume * (feed + vent));
  s.temperature = -(of_air * (t.flow.in + t.flow.out) / (thin * t.space.volume));
  const S line = supply_line_slope<S>(p, p.supply_pressure - state.supply_pressure);
  s.reservoir = p.supply_line_resistance > S(0) ? S(-(stiff_air / p.reservoir_volume * (S(1) / line + feed))) : S(0);
  s.spool = angular_frequency(p.valve_frequency);
  s.spool_damping_ratio = p.valve_damping_ratio;
  return s;
}

template <typename S>
void solve_stiff(const TankStiffness<S>& s, const S& g, TankState<S>& rate) {
  rate.gas.pressure /= S(1) - g * s.pressure;
  rate.gas.temperature /= S(1) - g * s.temperature;
  rate.supply_pressure /= S(1) - g * s.reservoir;
  solve_lag<S>(s.spool, s.spool_damping_ratio, g, rate.spool);
}

}  // namespace sms
