// A pneumatic actuator whole: valve, two chambers, seals, ends of the stroke (dissertation, section 4.1 and figure 4.1).
//
//   command -> filter -> spool -> mass flows -> pressures -> force on the rod -> motion -> volumes -> pressures
//              drive     valve    mass_flow     chamber      piston, end_stop              chamber
//
// The motion is not in here: on the bench it is one force balance (bench.hpp), under the platform three that are coupled
// (platform.hpp). Both hand over extension and velocity and take the force; what the air does between is the same.
//
// State of one actuator: pressures and temperatures of two chambers, the spool and what drives it, the deflection of the
// seals and the speed of their film, and the pressure of the reservoir in front of the valve. A law or an effect that is
// not there leaves its own where it is.
#pragma once

#include "sms/end_stop.hpp"
#include "sms/force_balance.hpp"
#include "sms/vessel.hpp"

namespace sms {

// What is between the command and the valve.
enum class DriveLaw : int {
  direct,   // nothing
  filtered  // the filter behind the pulse width (section 7.3.3)
};

// Which law stands for which part.
struct ActuatorLaws {
  ValveLaw valve;
  FrictionLaw friction;
  ChamberLaw chamber;
  DriveLaw drive;
};

inline constexpr ActuatorLaws published_laws() {
  return {ValveLaw::iso_0_4_mpa, FrictionLaw::acceleration_dependent, ChamberLaw::polytropic, DriveLaw::direct};
}

template <typename S>
struct ActuatorState {
  using Scalar = S;

  Gas<S> lower;
  Gas<S> upper;
  Lag<S> spool;       // as the command that would hold it there: V, V/s
  Lag<S> drive;       // voltage at the valve, V, V/s; with DriveLaw::filtered
  S deflection;       // of the seals, m; Dahl, LuGre, presliding_share
  S supply_pressure;  // in the reservoir at the valve, Pa; with supply_line_resistance
  S film;             // speed of the lubricant's film, m/s; with friction_lag
};

template <typename S>
SealState<S> seals_of(const ActuatorState<S>& state) {
  return {state.deflection, state.film};
}

// The air at one pose and rate; filled by fill_chambers().
template <typename S>
struct ActuatorTerms {
  ChamberSpace<S> lower;
  ChamberSpace<S> upper;
  ValvePorts<S> ports;
  EdgeFlows<S> edge;  // behind the tubes
  ActuatorFlows<S> flow;
  Piston<S> piston;  // what the seals feel; acceleration is left to the force balance
  S force;           // N: gas and ends of the stroke on the rod, friction not
};

template <typename S>
void fill_chambers(const Params<S>& p, const ActuatorLaws& laws, const ActuatorState<S>& state, const S& extension,
                   const S& velocity, ActuatorTerms<S>& t) {
  t.lower = lower_space(p, extension, velocity);
  t.upper = upper_space(p, extension, velocity);
  t.ports = {{state.supply_pressure, p.air_temperature},
             seen_air(p, laws.chamber, state.lower),
             seen_air(p, laws.chamber, state.upper),
             {p.ambient_pressure, p.air_temperature}};
  const EdgeFlows<S> edge = valve_flows(p, laws.valve, heat_ratios(p, laws.chamber), state.spool.value, t.ports);
  t.edge = through_tubes(p, edge, t.ports);
  t.flow = actuator_flows(p, t.edge, t.ports);
  t.piston = {extension, velocity, S(0), state.lower.pressure, state.upper.pressure};
  t.force = pressure_force(p, t.piston) + end_stop_force(p, extension, velocity);
}

// Only these depend on the command, V: an integrator whose step ends where the command jumps need renew no more.
template <typename S>
void drive_rates(const Params<S>& p, const ActuatorLaws& laws, const ActuatorState<S>& state, const S& command,
                 ActuatorState<S>& rate) {
  if (laws.drive == DriveLaw::filtered) {
    const S omega = angular_frequency(p.dac_filter_frequency);
    rate.drive = lag_rate(omega, p.dac_filter_damping_ratio, state.drive, command);
    rate.spool = spool_rate(p, state.spool, state.drive.value);
  } else {
    rate.drive = {S(0), S(0)};
    rate.spool = spool_rate(p, state.spool, command);
  }
}

template <typename S>
void seal_rates(const ForceBalance<S>& balance, ActuatorState<S>& rate) {
  rate.deflection = balance.deflection_rate;
  rate.film = balance.film_rate;
}

// All rates but those of the seals, which come out of the force balance; after fill_chambers().
template <typename S>
void actuator_rates(const Params<S>& p, const ActuatorLaws& laws, const ActuatorState<S>& state, const S& command,
                    const ActuatorTerms<S>& t, ActuatorState<S>& rate) {
  rate.lower = gas_rate(p, laws.chamber, state.lower, t.ports.lower, t.lower, t.flow.lower);
  rate.upper = gas_rate(p, laws.chamber, state.upper, t.ports.upper, t.upper, t.flow.upper);
  drive_rates(p, laws, state, command, rate);
  rate.supply_pressure = reservoir_pressure_rate(p, state.supply_pressure, t.flow.drawn);
}

// Closed, at rest, the reservoir full, and the two pressures as given, Pa.
template <typename S>
ActuatorState<S> actuator_at_rest(const Params<S>& p, const S& pressure_lower, const S& pressure_upper) {
  const Lag<S> closed = {p.valve_centre, S(0)};
  return {{pressure_lower, p.air_temperature},
          {pressure_upper, p.air_temperature},
          closed,
          closed,
          S(0),
          p.supply_pressure,
          S(0)};
}

// Sizes against which an error of the state is judged: the ranges that it runs through.
template <typename S>
ActuatorState<S> actuator_scale() {
  const Gas<S> gas = {S(4e5), S(300)};
  const Lag<S> voltage = {S(10), S(4e3)};
  return {gas, gas, voltage, voltage, S(1e-3), S(4e5), S(0.5)};
}

// False where the piston has gone so far into an end that a chamber holds no air any more: less than a cubic millimetre,
// whose pressure would change by its own size within microseconds.
template <typename S>
bool has_room(const ActuatorTerms<S>& t) {
  return t.lower.volume > S(1e-9) && t.upper.volume > S(1e-9);
}

// ---- kinks ----

// Functions of the state that change sign where the equations have a kink: the ends of the stroke, the reversal, the
// valve's middle and the edges of its dead zone, and under eq. 6.2 the change from one branch of the friction to the
// other.
constexpr int actuator_switch_count() { return 8; }

// The dead zone of a table ends at its first row, that of the classic law where the land uncovers its slot.
template <typename S>
void valve_switches(const Params<S>& p, ValveLaw law, const S& voltage, S* value) {
  const S opening = valve_opening(p, voltage);
  value[0] = opening;
  if (law == ValveLaw::classic) {
    const S spool = spool_cubic(p, S(5) + opening), overlap = S(0.5) * (p.land_width - p.port_width);
    value[1] = spool - overlap;
    value[2] = spool + overlap;
  } else {
    const S first(valve_table_0_4_mpa<ValueOf<S>>().opening[0]);
    value[1] = opening - first;
    value[2] = opening + first;
  }
}

// What drives the piston beyond either branch of eq. 6.2, N. Slowing down, the friction is that branch and the
// acceleration tells how far the drive is from it; held, it is the other way round.
template <typename S>
void branch_switches(const Params<S>& p, const Piston<S>& piston, const S& acceleration, const S& friction, S* value) {
  const S direction = piston.velocity < S(0) ? S(-1) : S(1);
  const S drive = friction + p.moving_mass * acceleration;
  Piston<S> changing = piston;
  changing.acceleration = -direction;
  value[0] = direction * (drive - friction_two_branch(p, changing));
  changing.acceleration = direction;
  value[1] = direction * (drive - friction_two_branch(p, changing));
}

// After derivative(): `acceleration` is the piston's, m/s^2, `friction` its friction, N.
template <typename S>
void actuator_switches(const Params<S>& p, const ActuatorLaws& laws, const ActuatorState<S>& state,
                       const Piston<S>& piston, const S& acceleration, const S& friction, S* value) {
  value[0] = piston.extension;
  value[1] = p.stroke - piston.extension;
  value[2] = piston.velocity;
  valve_switches<S>(p, laws.valve, state.spool.value, value + 3);
  if (laws.friction == FrictionLaw::two_branch) {
    branch_switches<S>(p, piston, acceleration, friction, value + 6);
  } else {
    value[6] = value[7] = S(1);
  }
}

}  // namespace sms
