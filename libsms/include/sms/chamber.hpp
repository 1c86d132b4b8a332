// The air in a chamber: its pressure, and where heat matters its temperature (dissertation, section 4.1.3.2.1).
//
// Mass and energy of an ideal gas in a volume V that the piston changes, with h = c_p T for what flows in or out:
//
//   m'         = m_in' - m_out'
//   (m c_v T)' = sum c_p T_in m_in' - c_p T m_out' - p V' + Q'          (eq. 4.27; its h = c_v T is a misprint)
//
// and p V = m R T turn into rates of pressure and temperature,
//
//   p' = kappa R / V (sum m_in' T_in - m_out' T) - kappa p V' / V + (kappa - 1) Q' / V
//   T' = T (p'/p + V'/V - m'/m)
//
// with Q' = h A_wall (T_wall - T). Without heat (h = 0) the process is adiabatic, with much of it isothermal. The
// source stays between the two without a state for it: temperature constant, and a ratio of heat capacities of its own
// for each of the three terms,
//
//   p' = R / V (alpha_i sum m_in' T_in - alpha_o m_out' T) - alpha p V' / V                              (eq. 4.30)
//
// with 1.4, 1.0 and 1.2. All ratios kappa, it is the full equation without heat at equal temperatures.
//
// heat_share lies between the two, from the polytropic law (0) to the energy equation with heat through the wall (1). In
// between the temperature is a state, flows see air that is warmer than the supplied by that share of it, and the rate
// of the pressure is that mixture of both. An effect of the polytropic law, absent at zero.
//
// The volumes: V = V_dead + A x below the piston and V_dead + A_b (stroke - x) above it, x the extension. Their rates
// have opposite signs (eq. 4.31; eq. 4.32 prints one sign for both). The tube between valve and chamber adds its
// volume. Valid for p, T, V > 0; nothing here guards a chamber that has been emptied.
#pragma once

#include "sms/piston.hpp"
#include "sms/tube.hpp"
#include "sms/valve.hpp"

namespace sms {

// What becomes of heat.
enum class ChamberLaw : int {
  polytropic,  // eq. 4.30: temperature constant, three ratios
  energy       // temperature a state, heat through the wall
};

template <typename S>
HeatRatios<S> polytropic_ratios(const Params<S>& p) {
  return {p.inflow_heat_ratio, p.outflow_heat_ratio, p.compression_heat_ratio};
}

// Those of the full energy equation.
template <typename S>
HeatRatios<S> adiabatic_ratios(const Params<S>& p) {
  return {p.heat_capacity_ratio, p.heat_capacity_ratio, p.heat_capacity_ratio};
}

// ---- the room ----

template <typename S>
struct ChamberSpace {
  S volume;     // V, m^3
  S rate;       // V', m^3/s
  S wall_area;  // what exchanges heat, m^2
};

template <typename S>
ChamberSpace<S> lower_space(const Params<S>& p, const S& extension, const S& velocity) {
  const PistonAreas<S> area = piston_areas(p);
  return {p.dead_volume_lower + tube_volume(p) + area.lower * extension, area.lower * velocity,
          S(2) * area.lower + S(3.14159265358979324) * p.bore_diameter * extension};
}

template <typename S>
ChamberSpace<S> upper_space(const Params<S>& p, const S& extension, const S& velocity) {
  const PistonAreas<S> area = piston_areas(p);
  const S length = p.stroke - extension;
  return {p.dead_volume_upper + tube_volume(p) + area.upper * length, -(area.upper * velocity),
          S(2) * area.upper + S(3.14159265358979324) * (p.bore_diameter + p.rod_diameter) * length};
}

// ---- what flows ----

// Air that crosses the border of one chamber.
template <typename S>
struct ChamberFlow {
  S in;       // m_in', kg/s
  S in_heat;  // sum of m_in' T_in, kg K/s
  S out;      // m_out', kg/s
};

// Adds a flow that comes from `other`. The pressures say which way it runs: a flow of zero then has its derivative on
// the right side.
template <typename S>
void add_flow(ChamberFlow<S>& flow, const S& inward, const Gas<S>& chamber, const Gas<S>& other) {
  if (other.pressure > chamber.pressure) {
    flow.in += inward;
    flow.in_heat += inward * other.temperature;
  } else {
    flow.out -= inward;
  }
}

template <typename S>
struct ActuatorFlows {
  ChamberFlow<S> lower;
  ChamberFlow<S> upper;
  S drawn;  // from the supply, kg/s
};

// The valve's edges and the leaks of the cylinder, sorted by chamber.
template <typename S>
ActuatorFlows<S> actuator_flows(const Params<S>& p, const EdgeFlows<S>& edge, const ValvePorts<S>& ports) {
  const Gas<S>&lower = ports.lower, &upper = ports.upper, &outside = ports.exhaust;
  ActuatorFlows<S> flow = {{S(0), S(0), S(0)}, {S(0), S(0), S(0)}, edge.supply_lower + edge.supply_upper};
  add_flow(flow.lower, edge.supply_lower, lower, ports.supply);
  add_flow<S>(flow.lower, -edge.lower_exhaust, lower, outside);
  add_flow(flow.upper, edge.supply_upper, upper, ports.supply);
  add_flow<S>(flow.upper, -edge.upper_exhaust, upper, outside);
  const S past_piston = leak_flow(p.piston_leakage, p.piston_leakage_index, lower.pressure, upper.pressure);
  add_flow<S>(flow.lower, -past_piston, lower, upper);
  add_flow(flow.upper, past_piston, upper, lower);
  const S into_lower =
      leak_flow(p.chamber_leakage_lower, p.chamber_leakage_index_lower, outside.pressure, lower.pressure);
  add_flow(flow.lower, into_lower, lower, outside);
  const S into_upper =
      leak_flow(p.chamber_leakage_upper, p.chamber_leakage_index_upper, outside.pressure, upper.pressure);
  add_flow(flow.upper, into_upper, upper, outside);
  return flow;
}

// ---- rates ----

// p', Pa/s, eq. 4.30: temperature stays, three ratios.
template <typename S>
S polytropic_pressure_rate(const Params<S>& p, const HeatRatios<S>& ratios, const Gas<S>& gas,
                           const ChamberSpace<S>& space, const ChamberFlow<S>& flow) {
  const S flowing = ratios.in * flow.in_heat - ratios.out * flow.out * gas.temperature;
  return (p.gas_constant * flowing - ratios.work * gas.pressure * space.rate) / space.volume;
}

// m = p V / (R T), kg
template <typename S>
S air_mass(const Params<S>& p, const Gas<S>& gas, const S& volume) {
  return gas.pressure * volume / (p.gas_constant * gas.temperature);
}

// m c_v T = p V / (kappa - 1), J
template <typename S>
S internal_energy(const Params<S>& p, const Gas<S>& gas, const S& volume) {
  return gas.pressure * volume / (p.heat_capacity_ratio - S(1));
}

// Q', W, from the wall into the air.
template <typename S>
S wall_heat(const Params<S>& p, const Gas<S>& gas, const ChamberSpace<S>& space) {
  return p.heat_transfer_coefficient * space.wall_area * (p.wall_temperature - gas.temperature);
}

template <typename S>
struct GasRate {
  S pressure;     // Pa/s
  S temperature;  // K/s
  S mass;         // kg/s; p V = m R T holds for the three
};

// The full energy equation, temperature a state.
template <typename S>
GasRate<S> energy_rates(const Params<S>& p, const Gas<S>& gas, const ChamberSpace<S>& space,
                        const ChamberFlow<S>& flow) {
  const S& kappa = p.heat_capacity_ratio;
  const S flowing = flow.in_heat - flow.out * gas.temperature;
  const S pressure =
      (kappa * (p.gas_constant * flowing - gas.pressure * space.rate) + (kappa - S(1)) * wall_heat(p, gas, space)) /
      space.volume;
  const S mass = flow.in - flow.out;
  const S relative = pressure / gas.pressure + space.rate / space.volume - mass / air_mass(p, gas, space.volume);
  return {pressure, gas.temperature * relative, mass};
}

template <typename S>
Gas<S> chamber_rate(const Params<S>& p, ChamberLaw law, const Gas<S>& gas, const ChamberSpace<S>& space,
                    const ChamberFlow<S>& flow) {
  if (law == ChamberLaw::energy) {
    const GasRate<S> rate = energy_rates(p, gas, space, flow);
    return {rate.pressure, rate.temperature};
  }
  return {polytropic_pressure_rate(p, polytropic_ratios(p), gas, space, flow), S(0)};
}

// ---- between the two laws: heat_share ----

template <typename S>
bool is_partly_warm(const Params<S>& p, ChamberLaw law) {
  return law == ChamberLaw::polytropic && !is_absent(p.heat_share);
}

template <typename S>
bool temperature_is_state(const Params<S>& p, ChamberLaw law) {
  return law == ChamberLaw::energy || is_partly_warm(p, law);
}

// The air as flows and thermometers see it.
template <typename S>
Gas<S> seen_air(const Params<S>& p, ChamberLaw law, const Gas<S>& gas) {
  if (!is_partly_warm(p, law)) {
    return gas;
  }
  return {gas.pressure, p.air_temperature + p.heat_share * (gas.temperature - p.air_temperature)};
}

// K/s of its temperature, from that of the state.
template <typename S>
S seen_temperature_rate(const Params<S>& p, ChamberLaw law, const S& rate) {
  return is_partly_warm(p, law) ? S(p.heat_share * rate) : rate;
}

// The valve's tables hold for a tank of given heat ratios, and its flow follows them (valve_table.hpp).
template <typename S>
HeatRatios<S> heat_ratios(const Params<S>& p, ChamberLaw law) {
  if (law == ChamberLaw::energy) {
    return adiabatic_ratios(p);
  }
  HeatRatios<S> ratios = polytropic_ratios(p);
  if (is_partly_warm(p, law)) {
    ratios.in += p.heat_share * (p.heat_capacity_ratio - ratios.in);
    ratios.out += p.heat_share * (p.heat_capacity_ratio - ratios.out);
  }
  return ratios;
}

// Pa/s and K/s of a chamber whose flows see `seen`.
template <typename S>
Gas<S> gas_rate(const Params<S>& p, ChamberLaw law, const Gas<S>& gas, const Gas<S>& seen, const ChamberSpace<S>& space,
                const ChamberFlow<S>& flow) {
  Gas<S> rate = chamber_rate(p, law, seen, space, flow);
  if (is_partly_warm(p, law)) {
    const GasRate<S> warm = energy_rates(p, gas, space, flow);
    rate.pressure += p.heat_share * (warm.pressure - rate.pressure);
    rate.temperature = warm.temperature;
  }
  return rate;
}

}  // namespace sms
