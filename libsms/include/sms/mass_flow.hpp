// Mass flow of air through one orifice, by two laws (dissertation, sections 4.1.2.2.3 and 5.1).
//
// Air runs from the higher pressure p1 to the lower p2. Below a critical ratio r = p2/p1 it reaches the speed of sound
// in the narrowest section and the flow no longer depends on p2 (choked); above it the flow falls to zero at r = 1.
//
// The classic law is that of an ideal nozzle times a discharge coefficient,
//
//   m' = C_d A p1 / sqrt(T1)  C_1                                       r <= (2/(kappa+1))^(kappa/(kappa-1))
//   m' = C_d A p1 / sqrt(T1)  C_2 r^(1/kappa) sqrt(1 - r^((kappa-1)/kappa))          above      (eq. 4.20 to 4.22)
//
// ISO 6358 describes a whole component, orifices and tubes in series, by three measured numbers: the sonic conductance
// C, the critical ratio b, the subsonic index m,
//
//   m' = p1 C rho_0 sqrt(T0/T1)                                         r <= b
//   m' = p1 C rho_0 sqrt(T0/T1) sqrt(1 - ((r - b)/(1 - b))^m)           b < r < 0.999
//   m' = p1 k_1 sqrt(T0/T1) (1 - r)                                     r >= 0.999             (eq. 5.8, 5.9)
//
// The index stands inside the root, as the tables were fitted; the standard puts its own outside. Valid for 0 <= b <
// 0.999, m > 0 and any pressures; where there is no pressure upstream there is no flow.
//
// At r = 1 either root has an infinite slope, and every start-up is there. The linear (laminar) piece takes it away. It
// meets the root in value; its slope is about twice the root's at 0.999 (sqrt(1-r) against its chord), so derivatives
// are finite and one-sided there. For m < 1 the slope is infinite just above b, an integrable cusp of the fitted law.
// The classic law gets the same linear piece much closer to one, within the last 1e-5, where it alters no more than the
// last pascals of a tank that fills.
#pragma once

#include <cmath>

#include "sms/effect.hpp"
#include "sms/params.hpp"

namespace sms {

// The state of air at a port.
template <typename S>
struct Gas {
  S pressure;     // Pa absolute
  S temperature;  // K
};

// ---- classic ----

// (2 / (kappa + 1))^(kappa / (kappa - 1)), eq. 4.18
template <typename S>
S critical_pressure_ratio(const S& kappa) {
  using std::pow;
  return pow(S(2) / (kappa + S(1)), kappa / (kappa - S(1)));
}

// C_1 of eq. 4.21, sqrt(kg K / J)
template <typename S>
S choked_flow_constant(const Params<S>& p) {
  using std::pow;
  using std::sqrt;
  const S& kappa = p.heat_capacity_ratio;
  return sqrt(kappa / p.gas_constant * pow(S(2) / (kappa + S(1)), (kappa + S(1)) / (kappa - S(1))));
}

// m' sqrt(T1) / (C_d A p1) above the critical ratio, without the linear piece.
template <typename S>
S subsonic_flow(const Params<S>& p, const S& ratio) {
  using std::pow;
  using std::sqrt;
  const S& kappa = p.heat_capacity_ratio;
  const S constant = sqrt(S(2) / p.gas_constant * kappa / (kappa - S(1)));  // C_2 of eq. 4.22
  return constant * pow(ratio, S(1) / kappa) * sqrt(S(1) - pow(ratio, (kappa - S(1)) / kappa));
}

// kg/s through an orifice of `area` (m^2) from a gas into a lower pressure.
template <typename S>
S classic_mass_flow_down(const Params<S>& p, const S& area, const Gas<S>& from, const S& pressure) {
  using std::sqrt;
  if (from.pressure <= S(0)) {
    return S(0);
  }
  const S linear_from = S(1) - S(1e-5);
  const S effective = p.discharge_coefficient * area / sqrt(from.temperature);
  const S ratio = pressure / from.pressure;
  if (ratio <= critical_pressure_ratio(p.heat_capacity_ratio)) {
    return effective * from.pressure * choked_flow_constant(p);
  }
  if (ratio < linear_from) {
    return effective * from.pressure * subsonic_flow(p, ratio);
  }
  return effective * (from.pressure - pressure) * (subsonic_flow(p, linear_from) / (S(1) - linear_from));
}

// kg/s, positive from the first gas to the second.
template <typename S>
S classic_mass_flow(const Params<S>& p, const S& area, const Gas<S>& from, const Gas<S>& to) {
  if (from.pressure < to.pressure) {
    return -classic_mass_flow_down(p, area, to, from.pressure);
  }
  return classic_mass_flow_down(p, area, from, to.pressure);
}

// ---- ISO 6358 ----

template <typename S>
struct IsoFlow {
  S sonic_conductance;  // C, m^3/(s Pa)
  S critical_ratio;     // b
  S subsonic_index;     // m
};

// sqrt(1 - ((r - b)/(1 - b))^m): the flow over the choked flow, for b < r < 1.
template <typename S>
S iso_subsonic_flow(const IsoFlow<S>& flow, const S& ratio) {
  using std::pow;
  using std::sqrt;
  return sqrt(S(1) - pow((ratio - flow.critical_ratio) / (S(1) - flow.critical_ratio), flow.subsonic_index));
}

// kg/s from a gas into a lower pressure.
template <typename S>
S iso_mass_flow_down(const Params<S>& p, const IsoFlow<S>& flow, const Gas<S>& from, const S& pressure) {
  using std::sqrt;
  if (from.pressure <= S(0)) {
    return S(0);
  }
  const S laminar_from = S(0.999);
  const S conductance = flow.sonic_conductance * p.reference_density * sqrt(p.reference_temperature / from.temperature);
  const S ratio = pressure / from.pressure;
  if (ratio <= flow.critical_ratio) {
    return conductance * from.pressure;
  }
  if (ratio < laminar_from) {
    return conductance * from.pressure * iso_subsonic_flow(flow, ratio);
  }
  return conductance * (from.pressure - pressure) * (iso_subsonic_flow(flow, laminar_from) / (S(1) - laminar_from));
}

// kg/s, positive from the first gas to the second.
template <typename S>
S iso_mass_flow(const Params<S>& p, const IsoFlow<S>& flow, const Gas<S>& from, const Gas<S>& to) {
  if (from.pressure < to.pressure) {
    return -iso_mass_flow_down(p, flow, to, from.pressure);
  }
  return iso_mass_flow_down(p, flow, from, to.pressure);
}

// ---- leaks ----

// kg/s from a gas into a lower pressure, past a seal or through a crack whose shape nobody knows: the power law of leaks,
// a dp^n, n from 1 (laminar) to 0.5 (turbulent), for a gas, whose flow at one ratio of pressures is proportional to the
// upstream pressure,
//
//   g p1/2 (2 (1 - p2/p1))^n;      n = 1:  g (p1 - p2)
//
// so that g is the flow per pressure difference where p2 is half of p1, whatever n. But for g, n = 0.5 is within 2 % of
// the ISO law with b = 0 and m = 1.1, as most rows of the valve's tables have, for 0.1 < p2/p1 < 0.99; 0.45 within 9 % of
// a labyrinth, sqrt(p1^2 - p2^2).
template <typename S>
S leak_flow_down(const S& conductance, const S& index, const S& from, const S& to) {
  using std::pow;
  const S drop = from - to;
  const S bent = index - S(1);
  if (is_absent(bent) || from <= S(0)) {
    return conductance * drop;
  }
  const S laminar_below = S(0.001);  // of the upstream pressure, as the ISO law
  const S share = drop / from;
  return conductance * drop * pow(S(2) * (share < laminar_below ? laminar_below : share), bent);
}

// kg/s, positive from the first pressure to the second.
template <typename S>
S leak_flow(const S& conductance, const S& index, const S& from, const S& to) {
  return from < to ? S(-leak_flow_down(conductance, index, to, from)) : leak_flow_down(conductance, index, from, to);
}

// C of an orifice that the classic law describes by its area, m^3/(s Pa): eq. 5.10, equal flows when choked.
template <typename S>
S sonic_conductance(const Params<S>& p, const S& area) {
  using std::sqrt;
  return area * p.discharge_coefficient / p.reference_density * choked_flow_constant(p) / sqrt(p.reference_temperature);
}

}  // namespace sms
