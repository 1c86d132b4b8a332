// Friction with a memory: what the seals do before they slide (dissertation, chapter 6, which names it as missing).
//
// A lip that is pushed first bends, like a bristle, and only then slides. Its mean deflection z is a state. In the Dahl
// model it grows with the motion until the spring carries the Coulomb force,
//
//   z' = v - |v| sigma_0 z / F_C,                       F = sigma_0 z
//
// In the LuGre model it saturates at the dry friction g(v) of steady sliding, eq. 6.1, and is damped,
//
//   z' = v - lambda |v| sigma_0 z / g(v),               F = sigma_0 z + sigma_1 z' + sigma v
//   g(v) = F_C + (F_S - F_C) exp(-|v / v_S|^delta)
//
// Plain LuGre has lambda = 1: a piston that is shaken while it sticks then creeps away. The elasto-plastic blend of P.
// Dupont et al. (IEEE Trans. Automatic Control 47, 2002) makes the first part of the deflection truly elastic,
//
//   lambda = 0                                          |z| <= z_b, or z against v
//   lambda = (1 + sin(pi (|z| - (z_s + z_b) / 2) / (z_s - z_b))) / 2      z_b < |z| < z_s
//   lambda = 1                                          |z| >= z_s,       z_s = g / sigma_0, z_b = breakaway_ratio z_s
//
// In steady sliding z' = 0, and the force is eq. 6.1 to the letter; at rest the force is sigma_0 z at any z up to z_s,
// so a load below F_S is held for ever. The sliding effects (pressure, position, direction) act on g.
//
// Passive: with the energy sigma_0 z^2 / 2 in the bristles, F v is never less than what that energy gains, provided
// that sigma_1 (F_S / F_C - 1) <= sigma; 514 N s/m with the published numbers.
#pragma once

#include "sms/friction.hpp"

namespace sms {

template <typename S>
struct BristleFriction {
  S force;            // N, positive against extension
  S deflection_rate;  // z', m/s
};

// Dry friction that the bristles can carry while moving with v, N. The effects may shrink it; it stays above 1 mN.
template <typename S>
S bristle_strength(const Params<S>& p, const Piston<S>& piston, const S& dry) {
  const S& v = piston.velocity;
  const S direction = v > S(0) ? p.direction_friction : (v < S(0) ? -p.direction_friction : S(0));
  const S strength = friction_map(p, v) * (seal_force(p, piston, dry) + direction);
  return strength > S(1e-3) ? strength : S(1e-3);
}

template <typename S>
BristleFriction<S> dahl_friction(const Params<S>& p, const Piston<S>& piston, const S& deflection) {
  using std::abs;
  const S strength = bristle_strength(p, piston, p.coulomb_force);
  const S force = p.bristle_stiffness * deflection;
  return {force, piston.velocity - abs(piston.velocity) * force / strength};
}

// lambda: the part of the motion that is sliding, from 0 to 1; `largest` is z_s.
template <typename S>
S sliding_part(const Params<S>& p, const S& velocity, const S& deflection, const S& largest) {
  using std::abs;
  using std::sin;
  if (!(p.breakaway_ratio > S(0))) {
    return S(1);
  }
  const S size = abs(deflection);
  const S elastic = p.breakaway_ratio * largest;
  if (velocity * deflection <= S(0) || size <= elastic) {
    return S(0);
  }
  if (size >= largest) {
    return S(1);
  }
  const S beyond_middle = (size - S(0.5) * (largest + elastic)) / (largest - elastic);
  return S(0.5) + S(0.5) * sin(S(3.14159265358979324) * beyond_middle);
}

// dry: what the bristles carry in steady sliding, before the effects on it, N.
template <typename S>
BristleFriction<S> lugre_friction(const Params<S>& p, const Piston<S>& piston, const S& deflection, const S& dry) {
  using std::abs;
  const S& v = piston.velocity;
  const S strength = bristle_strength(p, piston, dry);
  const S largest = strength / p.bristle_stiffness;
  const S rate = v - sliding_part(p, v, deflection, largest) * abs(v) * (deflection / largest);
  return {p.bristle_stiffness * deflection + p.bristle_damping * rate + friction_map(p, v) * (p.viscous_friction * v),
          rate};
}

template <typename S>
BristleFriction<S> lugre_friction(const Params<S>& p, const Piston<S>& piston, const S& deflection) {
  return lugre_friction<S>(p, piston, deflection, stribeck_force(p, piston.velocity));
}

}  // namespace sms
