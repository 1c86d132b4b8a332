// The flow test: a tank is charged or discharged through the component under test, and its pressure is recorded
// (dissertation, chapter 5; ISO 6358-2 calls it the charge and the discharge method).
//
// A valve opens, and a tank of known volume fills from the supply or empties to ambient. How fast its pressure changes
// says the mass flow, and how that depends on the pressures says C, b and m of the component:
//
//   charge      supply -> component -> tank          discharge   tank -> component -> ambient
//
// The tank is that of vessel.hpp. Its heat is either the source's (temperature constant, one ratio of heat capacities
// for air that enters and one for air that leaves), or the full energy equation, in which temperature is a state and
// h = 0 is the adiabatic tank. Before the valve opens, the air is at the wall's temperature.
//
// The valve opens over `opening_duration` with a smooth step 3 u^2 - 2 u^3 of its area. The test has a clock of its own
// that starts with the opening, so that the moment of opening moves the whole curve and nothing else.
//
// What the instruments say of it:
//   - the pressure sensor sits in the line and reads tank_line_resistance m' more than the tank, m' inward; it has a
//     floor and a ceiling, outside which it stays at its end of range;
//   - the thermocouple follows with a first-order lag, T_tc' = (T - T_tc) / tau; none where tau = 0.
//
// Valid for a component whose own volume is small against the tank's.
#pragma once

#include "sms/actuator.hpp"
#include "sms/limit.hpp"
#include "sms/sensor.hpp"
#include "sms/vessel.hpp"

namespace sms {

enum class FlowLaw { iso, classic };

struct FlowTestKind {
  FlowLaw law = FlowLaw::iso;
  ChamberLaw heat = ChamberLaw::polytropic;
};

template <typename S>
struct FlowTest {
  using Scalar = S;
  S pressure;      // in the tank, Pa absolute
  S temperature;   // K
  S thermocouple;  // K
};

template <typename S>
FlowTest<S> flow_test_start(const Params<S>& p, FlowTestKind kind) {
  const S temperature = kind.heat == ChamberLaw::energy ? p.wall_temperature : p.air_temperature;
  return {p.tank_initial_pressure, temperature, temperature};
}

// Share of its final area that the valve has opened `time` after it began to, 0 to 1.
template <typename S>
S opened_share(const Params<S>& p, const S& time) {
  if (time >= p.opening_duration) {
    return S(1);
  }
  if (time <= S(0)) {
    return S(0);
  }
  const S u = time / p.opening_duration;
  return u * u * (S(3) - S(2) * u);
}

// kg/s into the tank, from `outside` at the supply's or the ambient pressure.
template <typename S>
S flow_test_inflow(const Params<S>& p, FlowLaw law, const S& time, const FlowTest<S>& test, const S& outside) {
  const S share = opened_share(p, time);
  const Gas<S> tank = {test.pressure, test.temperature};
  const Gas<S> surroundings = {outside, p.air_temperature};
  if (law == FlowLaw::classic) {
    return classic_mass_flow<S>(p, share * orifice_area(p, p.spool_position), surroundings, tank);
  }
  const IsoFlow<S> component = {share * p.component_conductance, p.component_critical_ratio,
                                p.component_subsonic_index};
  return iso_mass_flow(p, component, surroundings, tank);
}

// d/dt of the test, `time` after the valve began to open.
template <typename S>
FlowTest<S> flow_test_rate(const Params<S>& p, FlowTestKind kind, const S& time, const FlowTest<S>& test,
                           const S& outside) {
  const Gas<S> tank = {test.pressure, test.temperature};
  ChamberFlow<S> flow = {S(0), S(0), S(0)};
  add_flow<S>(flow, flow_test_inflow(p, kind.law, time, test, outside), tank, {outside, p.air_temperature});
  const Gas<S> gas = chamber_rate(p, kind.heat, tank, tank_space(p), flow);
  FlowTest<S> rate = {gas.pressure, gas.temperature, S(0)};
  if (p.thermocouple_time_constant > S(0)) {
    rate.thermocouple = (test.temperature - test.thermocouple) / p.thermocouple_time_constant;
  } else {
    rate.thermocouple = rate.temperature;
  }
  return rate;
}

// Pa absolute, what the pressure sensor says while `inflow` passes its line.
template <typename S>
S tank_pressure_reading(const Params<S>& p, const S& pressure, const S& inflow) {
  const S seen = tank_pressure_sensor(p).reading(pressure + p.tank_line_resistance * inflow);
  return limited(seen, p.tank_pressure_floor, p.tank_pressure_ceiling);
}

}  // namespace sms
