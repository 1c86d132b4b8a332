// The force balance of one pneumatic cylinder (dissertation, eq. 6.4 and 4.34).
//
//   (M_L + M_p) a = p_a A_a - p_b A_b - p_A A_r - F_f - F_L
//
// a: the chamber that extends the rod, b: the one that retracts it, A_r = A_a - A_b the rod's section, on which the
// ambient pressure p_A stands, F_f the friction, F_L the force of the rod on its load. A single-acting cylinder is the
// same with its other chamber open: p_b = p_A, so that p_b A_b + p_A A_r = p_A A_a.
#pragma once

#include "sms/friction.hpp"

namespace sms {

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

// F_L, N: the force with which the rod pushes on its load, from the motion.
template <typename S>
S rod_force(const Params<S>& p, const Piston<S>& piston) {
  return pressure_force(p, piston) - friction(p, piston) - p.moving_mass * piston.acceleration;
}

}  // namespace sms
