// The piston of one pneumatic cylinder and the force of the gas on it (dissertation, eq. 6.4 and 4.34).
//
//   (M_L + M_p) a = p_a A_a - p_b A_b - p_A A_r - F_f - F_L
//
// a: the chamber that extends the rod, b: the one that retracts it, A_r = A_a - A_b the rod's section, on which the
// ambient pressure p_A stands, F_f the friction, F_L the force of the rod on its load. A single-acting cylinder is the
// same with its other chamber open: p_b = p_A, so that p_b A_b + p_A A_r = p_A A_a.
#pragma once

#include "sms/params.hpp"
#include "sms/scalar.hpp"

namespace sms {

// The piston of one cylinder, and what its seals feel.
template <typename S>
struct Piston {
  S extension;       // x, m, 0 retracted
  S velocity;        // v, m/s, positive while extending
  S acceleration;    // a, m/s^2
  S pressure_lower;  // p_a, Pa absolute: extends the rod
  S pressure_upper;  // p_b, Pa absolute; ambient for a single-acting cylinder
};

template <typename S>
bool is_finite(const Piston<S>& piston) {
  return is_finite(piston.extension) && is_finite(piston.velocity) && is_finite(piston.acceleration) &&
         is_finite(piston.pressure_lower) && is_finite(piston.pressure_upper);
}

template <typename S>
S circle_area(const S& diameter) {
  return S(0.78539816339744831) * diameter * diameter;
}

// A_a, A_b, A_r, m^2
template <typename S>
struct PistonAreas {
  S lower;
  S upper;
  S rod;
};

template <typename S>
PistonAreas<S> piston_areas(const Params<S>& p) {
  const S lower = circle_area(p.bore_diameter);
  const S rod = circle_area(p.rod_diameter);
  return {lower, lower - rod, rod};
}

// Net force of the gas on the piston, N, positive outwards. Written in pressures above ambient, where nothing cancels.
template <typename S>
S pressure_force(const Params<S>& p, const Piston<S>& piston) {
  const PistonAreas<S> area = piston_areas(p);
  return (piston.pressure_lower - p.ambient_pressure) * area.lower -
         (piston.pressure_upper - p.ambient_pressure) * area.upper;
}

}  // namespace sms
