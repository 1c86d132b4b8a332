// One step of a pneumatic actuator that is held against records, on the bench as under the platform.
//
// Friction inside its ramp is stiff (38 N over 5 mm/s on 3.6 kg: 0.3 ms), and so are a chamber that is nearly closed and
// the contact at an end. A Rosenbrock method of second order with an approximate Jacobian A (ROS2; Verwer, Spee, Blom and
// Hundsdorfer 1999) stays stable there and keeps its order whatever A is:
//
//   (I - gamma h A) k1 = f(t, y)
//   (I - gamma h A) k2 = f(t + h, y + h k1) - 2 k1,      y + h (3 k1 + k2) / 2,      gamma = 1 - 1/sqrt(2)
//
// A has the slope of friction and contact for (x, v), and a chamber's flow over its pressure difference for each
// pressure.
#pragma once

#include "estimation/recorded.hpp"
#include "sms/bench.hpp"
#include "sms/integrate.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {
namespace detail {

// gamma of the step.
constexpr double kStiffShare = 0.29289321881345254;

// ---- valve ----

// The spool at sample `first`: it follows the command alone, and is run up over the 50 ms before, `steps` steps of h a
// sample. `late`: of the command, in samples.
template <typename S>
Lag<S> spool_at(const Params<S>& p, const Eigen::VectorXd& command, int first, int steps, const S& h, const S& late) {
  const int run_up = static_cast<int>(0.05 / value_of(h)) + 1;
  Lag<S> spool{command_at<S>(command, S(first - double(run_up) / steps) - late), S(0)};
  for (int i = -run_up; i < 0; ++i) {
    const S at = S(first + double(i) / steps) - late;
    const Lag<S> k1 = spool_rate(p, spool, command_at<S>(command, at));
    const Lag<S> moved{spool.value + h * k1.value, spool.rate + h * k1.rate};
    const Lag<S> k2 = spool_rate(p, moved, command_at<S>(command, at + S(1.0 / steps)));
    spool = {spool.value + S(0.5) * h * (k1.value + k2.value), spool.rate + S(0.5) * h * (k1.rate + k2.rate)};
  }
  return spool;
}

// ---- seals ----

// A quantity that follows `now` with a lag of first order, a time h later; in between `now` runs straight to `then`.
template <typename S>
S lagging(const S& late, const S& now, const S& then, const S& lag, const S& h) {
  using std::exp;
  const S behind = lag * (then - now) / h;
  return lag > S(0) ? S(then - behind + (late - now + behind) * exp(-h / lag)) : S(then - behind);
}

// Friction that deviates from its law: by how much, N; sets the rate of the seals' deflection. Presliding: they carry a
// share by their deformation, up to what eq. 6.5 says of steady sliding, F_C. friction_lag: viscous friction follows the
// speed of the lubricant's film, which is late.
template <typename S>
S seal_deviation(const Params<S>& p, const Piston<S>& piston, const S& by_law, const S& deflection, const S& film,
                 S* deflection_rate) {
  S force(0);
  if (!is_absent(p.presliding_share)) {
    const BristleFriction<S> bristle = lugre_friction<S>(p, piston, deflection, p.coulomb_force);
    force += p.presliding_share * (bristle.force - by_law);
    *deflection_rate = bristle.deflection_rate;
  }
  if (!is_absent(p.friction_lag)) {
    force += p.viscous_friction * (film - piston.velocity);
  }
  return force;
}

// Whether their deflection is a state.
template <typename S>
bool seals_deform(const Params<S>& p, FrictionLaw law) {
  return law == FrictionLaw::dahl || law == FrictionLaw::lugre || !is_absent(p.presliding_share);
}

// ---- heat ----

// heat_share lies between the polytropic law at constant temperature (0) and the energy equation with heat through the
// wall (1). In between, flows see air that is warmer than the supplied by the share of what the energy equation says.
template <typename S>
bool is_partly_warm(const Params<S>& p, const ActuatorLaws& laws) {
  return laws.chamber == ChamberLaw::polytropic && !is_absent(p.heat_share);
}

// The valve's tables hold for a tank of given heat ratios, and its flow follows them (valve_table.hpp).
template <typename S>
Params<S> partly_warm(Params<S> p) {
  p.inflow_heat_ratio += p.heat_share * (p.heat_capacity_ratio - p.inflow_heat_ratio);
  p.outflow_heat_ratio += p.heat_share * (p.heat_capacity_ratio - p.outflow_heat_ratio);
  return p;
}

template <typename S>
ActuatorState<S> partly_warm(const Params<S>& p, ActuatorState<S> state) {
  state.lower.temperature = p.air_temperature + p.heat_share * (state.lower.temperature - p.air_temperature);
  state.upper.temperature = p.air_temperature + p.heat_share * (state.upper.temperature - p.air_temperature);
  return state;
}

// The rates of one chamber, from those of the polytropic law.
template <typename S>
void add_heat(const Params<S>& p, const Gas<S>& gas, const ChamberSpace<S>& space, const ChamberFlow<S>& flow,
              Gas<S>& rate) {
  const GasRate<S> warm = energy_rates(p, gas, space, flow);
  rate.pressure += p.heat_share * (warm.pressure - rate.pressure);
  rate.temperature = warm.temperature;
}

// ---- the stiff step ----

// A of the step.
template <typename S>
struct ActuatorStiffness {
  S motion_position;  // d v'/d x
  S motion_velocity;  // d v'/d v
  S lower;            // d p_a'/d p_a
  S upper;
  S reservoir;
  S deflection;
};

// Of an actuator that moves `mass` kg.
template <typename S>
ActuatorStiffness<S> actuator_stiffness(const Params<S>& p, FrictionLaw law, const S& mass, const ActuatorTerms<S>& a) {
  using std::abs;
  using std::cos;
  const S& extension = a.piston.extension;
  const S speed = abs(a.piston.velocity);
  S damping = p.viscous_friction;
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
  const S feed_lower = secant(a.edge.supply_lower, supply.pressure, lower.pressure);
  const S feed_upper = secant(a.edge.supply_upper, supply.pressure, upper.pressure);
  const S vent_lower = secant(a.edge.lower_exhaust, lower.pressure, outside.pressure);
  const S vent_upper = secant(a.edge.upper_exhaust, upper.pressure, outside.pressure);
  ActuatorStiffness<S> s;
  s.motion_position = contact ? S(-(p.end_stop_stiffness / mass)) : S(0);
  s.motion_velocity = -(damping / mass);
  s.lower = -(air / a.lower.volume * (feed_lower + vent_lower));
  s.upper = -(air / a.upper.volume * (feed_upper + vent_upper));
  s.reservoir = p.supply_line_resistance > S(0)
                    ? S(-(air / p.reservoir_volume * (S(1) / p.supply_line_resistance + feed_lower + feed_upper)))
                    : S(0);
  s.deflection = law == FrictionLaw::lugre || law == FrictionLaw::dahl || p.presliding_share > S(0)
                     ? S(-(speed * p.bristle_stiffness / p.coulomb_force))
                     : S(0);
  return s;
}

// k with (I - g A) k = rate
template <typename S>
void solve_stiff(const ActuatorStiffness<S>& s, const S& g, BenchState<S>& rate) {
  rate.velocity = (rate.velocity + g * s.motion_position * rate.extension) /
                  (S(1) - g * s.motion_velocity - g * g * s.motion_position);
  rate.extension = rate.extension + (s.motion_position < S(0) ? S(g * rate.velocity) : S(0));
  rate.actuator.lower.pressure /= S(1) - g * s.lower;
  rate.actuator.upper.pressure /= S(1) - g * s.upper;
  rate.actuator.supply_pressure /= S(1) - g * s.reservoir;
  rate.actuator.deflection /= S(1) - g * s.deflection;
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
