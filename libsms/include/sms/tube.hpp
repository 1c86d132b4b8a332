// The tube between valve and chamber: volume, loss and delay (dissertation, section 4.1.4).
//
// After E. Richer and Y. Hurmuzlu (ASME J. Dyn. Sys. Meas. Control 122, 2000) a mass flow that enters a tube of length
// L leaves it L / c later, weakened by friction on the way,
//
//   m'(L, t) = exp(-R_t R T L / (2 p c)) m'(0, t - L / c),      c = sqrt(kappa R T)
//   R_t = 32 mu / d^2 laminar,  0.158 mu / d^2 Re^(3/4) turbulent,   Re = 4 |m'| / (pi d mu)
//
// Of the two resistances the larger one holds; they meet at Re = 1190. Fittings and bends multiply it
// (tube_loss_factor). The loss is put on the valve's edges, so that
// what the chamber does not receive has not left the supply either: no air is lost. Its volume belongs to the chamber.
//
// The machine's tubes are shorter than 0.3 m: 0.87 ms and a few per cent at full flow. The source leaves them out, and
// so does tube_length = 0, to the bit.
#pragma once

#include "sms/effect.hpp"
#include "sms/valve.hpp"

namespace sms {

// m^3
template <typename S>
S tube_volume(const Params<S>& p) {
  return S(0.78539816339744831) * p.tube_diameter * p.tube_diameter * p.tube_length;
}

// s
template <typename S>
S tube_delay(const Params<S>& p) {
  using std::sqrt;
  return p.tube_length / sqrt(p.heat_capacity_ratio * p.gas_constant * p.air_temperature);
}

// s, from the command to the chamber: what the electronics and the tube take. Whoever carries delays puts both into the
// command's delay line (electronics.hpp).
template <typename S>
S delay_to_chamber(const Params<S>& p) {
  return p.command_delay + tube_delay(p);
}

// The part of a mass flow that the tube lets through, from 0 to 1; `pressure` is the chamber's.
template <typename S>
S tube_transmission(const Params<S>& p, const S& mass_flow, const S& pressure) {
  using std::abs;
  using std::exp;
  using std::pow;
  const S reynolds = S(1.27323954473516269) * abs(mass_flow) / (p.tube_diameter * p.air_viscosity);
  const S shape = reynolds > S(1190) ? S(32) * pow(reynolds / S(1190), S(0.75)) : S(32);
  const S resistance = p.tube_loss_factor * shape * p.air_viscosity / (p.tube_diameter * p.tube_diameter);
  return exp(-(resistance * p.gas_constant * p.air_temperature / (S(2) * pressure) * tube_delay(p)));
}

// The edges of a valve behind which there are tubes.
template <typename S>
EdgeFlows<S> through_tubes(const Params<S>& p, const EdgeFlows<S>& edge, const ValvePorts<S>& ports) {
  if (is_absent(p.tube_length)) {
    return edge;
  }
  const S lower = tube_transmission<S>(p, edge.supply_lower - edge.lower_exhaust, ports.lower.pressure);
  const S upper = tube_transmission<S>(p, edge.supply_upper - edge.upper_exhaust, ports.upper.pressure);
  return {edge.supply_lower * lower, edge.lower_exhaust * lower, edge.supply_upper * upper, edge.upper_exhaust * upper};
}

}  // namespace sms
