// Vessels of constant volume: the tank of the flow test and the reservoir in front of the valve (dissertation, sections
// 5.1.1 and 4.1.5).
//
// The tank stands for a chamber whose piston is held. One port, air enters or leaves:
//
//   p' = alpha_i R T m_in' / V   or   -alpha_o R T m_out' / V                                   (eq. 5.5, 5.15)
//
// From the measured p(t) the tables of the valve were fitted with this equation, alpha_i = 1.4 and alpha_o = 1.0. With
// the full energy equation its temperature is a state, and chamber.hpp has the rates.
//
// The reservoir smooths the supply. A line with the resistance r feeds it, the valve draws from it, and both flows pass
// with one ratio of heat capacities, so that a steady draw leaves the pressure at p_s - r m':
//
//   p_R' = alpha R T / V_R ((p_s - p_R) / r - m_drawn')
//
// r = 0 is the source's assumption: the valve sees p_s at any draw. A regulator or a long line is turbulent: with k the
// flow is that which loses r m' + k m'^2 (supply_line_flow).
#pragma once

#include "sms/chamber.hpp"

namespace sms {

template <typename S>
ChamberSpace<S> tank_space(const Params<S>& p) {
  return {p.tank_volume, S(0), p.tank_wall_area};
}

// The flow into the tank through a component that joins it to `outside`, by the tables alone (no mass_flow_gain).
template <typename S>
ChamberFlow<S> tank_flow(const Params<S>& p, const IsoFlow<S>& component, const Gas<S>& tank, const Gas<S>& outside) {
  ChamberFlow<S> flow = {S(0), S(0), S(0)};
  add_flow<S>(flow, iso_mass_flow(p, component, outside, tank), tank, outside);
  return flow;
}

// Pa/s, eq. 5.5
template <typename S>
S tank_pressure_rate(const Params<S>& p, const IsoFlow<S>& component, const Gas<S>& tank, const Gas<S>& outside) {
  return polytropic_pressure_rate(p, polytropic_ratios(p), tank, tank_space(p), tank_flow(p, component, tank, outside));
}

// d(loss) / dm' of the supply line where it loses `drop`, Pa s/kg
template <typename S>
S supply_line_slope(const Params<S>& p, const S& drop) {
  using std::abs;
  using std::sqrt;
  const S& r = p.supply_line_resistance;
  return is_absent(p.supply_line_turbulence) ? r : S(sqrt(r * r + S(4) * p.supply_line_turbulence * abs(drop)));
}

// kg/s through the line that loses `drop`, Pa: r m' + k m' |m'| = drop, r > 0.
template <typename S>
S supply_line_flow(const Params<S>& p, const S& drop) {
  return S(2) * drop / (p.supply_line_resistance + supply_line_slope(p, drop));
}

// Pa/s; `drawn` in kg/s by all valves at this reservoir. Zero without a supply line: its pressure is supply_pressure.
template <typename S>
S reservoir_pressure_rate(const Params<S>& p, const S& pressure, const S& drawn) {
  if (!(p.supply_line_resistance > S(0))) {
    return S(0);
  }
  const S fed = supply_line_flow<S>(p, p.supply_pressure - pressure);
  return p.compression_heat_ratio * p.gas_constant * p.air_temperature / p.reservoir_volume * (fed - drawn);
}

}  // namespace sms
