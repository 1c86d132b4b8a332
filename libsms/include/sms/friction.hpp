// Friction of the pneumatic cylinder (dissertation, chapter 6).
//
// Two lips and a bearing rub on the bore. Pushed slowly the seal sticks; once it slides, friction falls from the static
// force F_S to the Coulomb force F_C and then grows with speed. On this cylinder the measured fall depended on how fast
// the piston was speeding up, and did not show while it slowed down; hence, with v the velocity, a the acceleration,
//
//   F = alpha { sgn(v) [ F_C + (F_S - F_C) exp(-|v / (a zeta v_S)|^delta) + F_UE (exp(gamma |v|) - 1) ] + sigma v }
//
//                                                                                            (eq. 6.5, 6.6)
// where the Stribeck term is present only while speeding up (sgn a = sgn v), F_C and sigma may differ between speeding
// up and slowing down, and alpha leads the force through zero inside |v| < eps:
//
//   alpha = sin(pi |v| / (2 eps))   for |v| < eps,   1 beyond                               (eq. 6.7)
//
// With a Stribeck velocity that stays v_S whatever the acceleration this is eq. 6.2; with one branch and without the
// ramp it is eq. 6.1, the same law as eq. 4.33.
//
// Valid for sliding. Inside eps a loaded piston creeps instead of sticking; true stiction needs a pre-sliding model,
// see friction_dynamic.hpp. As friction depends on the acceleration that it changes, a force balance has to be solved
// for it: force_balance.hpp.
//
// Limits: at a = 0 the Stribeck velocity |a| zeta v_S is zero and so is the term; at v = 0 the force is zero with slope
// (pi / (2 eps)) [F_C2], which the sine carries exactly, derivatives included.
//
// No curve is exact. friction_map_extend_1.. and friction_map_retract_1.. are the relative error of friction at some
// speeds of either direction, linear in between and constant beyond; zero leaves every result unchanged.
//
// Three effects, absent until data switches them on (their parameters are zero):
//   pressure_dependent_friction   the lips are pressed on the bore by the chamber pressures: Coulomb friction grows, and
//                                 what static friction is more than that (pressure_stiction)
//   direction_dependent_friction  a lip seal rubs more one way than the other
//   position_dependent_friction   the bore is not equally wide, the rod not quite straight
#pragma once

#include <cmath>

#include "sms/effect.hpp"
#include "sms/map_error.hpp"
#include "sms/params.hpp"
#include "sms/piston.hpp"
#include "sms/scalar.hpp"

namespace sms {

// sgn(v) alpha of eq. 6.7: an odd function, from -1 to 1, smooth through v = 0.
template <typename S>
S friction_ramp(const S& velocity, const S& stiction_velocity) {
  using std::abs;
  using std::sin;
  if (abs(velocity) < stiction_velocity) {
    return sin(S(1.5707963267948966) * velocity / stiction_velocity);
  }
  return velocity < S(0) ? S(-1) : S(1);
}

// The same with the form of the rise left open: the sine of eq. 6.7, a hyperbolic tangent of the same slope at rest, or a
// mixture (stiction_shape from 0 to 1). How friction rises through zero is a regularisation: no test has shown its form,
// and a slow creep feels it.
template <typename S>
S friction_ramp(const Params<S>& p, const S& velocity) {
  using std::abs;
  using std::exp;
  S ramp = friction_ramp(velocity, p.stiction_velocity);
  if (!is_absent(p.stiction_shape)) {
    const S x = S(3.1415926535897932) * velocity / p.stiction_velocity;
    const S tangent = abs(x) < S(20) ? S(S(1) - S(2) / (exp(x) + S(1))) : (x < S(0) ? S(-1) : S(1));
    ramp += p.stiction_shape * (tangent - ramp);
  }
  return ramp;
}

// Friction over that of the curve: 1 and the curve's relative error at this velocity.
template <typename S>
S friction_map(const Params<S>& p, const S& velocity) {
  using P = Params<S>;
  using V = ValueOf<S>;
  static constexpr MapKnots<V, 3> knots({V(0.03), V(0.12), V(0.3)});  // m/s
  static constexpr S P::*at_knot[2][3] = {
      {&P::friction_map_retract_1, &P::friction_map_retract_2, &P::friction_map_retract_3},
      {&P::friction_map_extend_1, &P::friction_map_extend_2, &P::friction_map_extend_3}};
  using std::abs;
  const S speed = abs(velocity);
  return S(1) + map_error(p, at_knot[velocity > S(0) ? 1 : 0], map_place<S>(knots, speed));
}

// |v / width|^delta, held at 1000 from a million widths on: with delta >= 0.5 (its bound) it is no less there, and exp
// of its negative has long underflowed. So width -> 0 needs no case of its own, derivatives included.
template <typename S>
S stribeck_power(const S& velocity, const S& width, const S& exponent) {
  using std::abs;
  using std::pow;
  const S speed = abs(velocity);
  if (!(speed < S(1e6) * width)) {
    return S(1e3);
  }
  return speed > S(0) ? S(pow(speed / width, exponent)) : S(0);
}

// exp(-|v / width|^delta), the fall from static to Coulomb friction.
template <typename S>
S stribeck_fall(const S& velocity, const S& width, const S& exponent) {
  using std::exp;
  return exp(-stribeck_power(velocity, width, exponent));
}

// F_UE (exp(gamma |v|) - 1), eq. 6.6; the exponent is held at 50, far beyond any speed of a cylinder, to stay finite.
template <typename S>
S exponential_friction(const Params<S>& p, const S& velocity) {
  using std::abs;
  using std::exp;
  if (is_absent(p.exponential_friction_force)) {
    return S(0);
  }
  const S growth = p.exponential_friction_rate * abs(velocity);
  return p.exponential_friction_force * (exp(growth < S(50) ? growth : S(50)) - S(1));
}

// Its slope over speed, N s/m.
template <typename S>
S exponential_friction_slope(const Params<S>& p, const S& velocity) {
  return p.exponential_friction_rate * (exponential_friction(p, velocity) + p.exponential_friction_force);
}

// Growth of dry friction where the bore is narrower than at mid-stroke, 1 without position_dependent_friction.
template <typename S>
S position_factor(const Params<S>& p, const Piston<S>& piston) {
  const S beyond_mid_stroke = piston.extension - S(0.5) * p.stroke;
  return S(1) + p.position_friction * beyond_mid_stroke;
}

// p_a + p_b - 2 p_A, what presses the lips on the bore, Pa
template <typename S>
S lip_pressure(const Params<S>& p, const Piston<S>& piston) {
  return piston.pressure_lower + piston.pressure_upper - S(2) * p.ambient_pressure;
}

// Growth of what dry friction is more than the Coulomb force.
template <typename S>
S excess_factor(const Params<S>& p, const Piston<S>& piston) {
  return position_factor(p, piston) + p.pressure_stiction * lip_pressure(p, piston);
}

// What the seals make of their dry friction (Coulomb and Stribeck), N: the effects that act on it, and eq. 6.6.
template <typename S>
S seal_force(const Params<S>& p, const Piston<S>& piston, const S& dry) {
  const S pressed = p.pressure_friction + p.pressure_stiction * (dry - p.coulomb_force);
  return dry * position_factor(p, piston) + pressed * lip_pressure(p, piston) +
         exponential_friction(p, piston.velocity);
}

// Eq. 6.2 and 6.5 with a given Stribeck velocity, m/s.
template <typename S>
S friction_of_width(const Params<S>& p, const Piston<S>& piston, const S& width) {
  using std::abs;
  const S& v = piston.velocity;
  const S& a = piston.acceleration;
  const S ramp = friction_map(p, v) * friction_ramp(p, v);
  const bool speeding_up = (v > S(0) && a > S(0)) || (v < S(0) && a < S(0));

  S coulomb = p.coulomb_force;
  S slope = p.viscous_friction;
  S stribeck = S(0);
  if (speeding_up) {
    stribeck = (p.stiction_force - p.coulomb_force) * stribeck_fall(v, width, p.stribeck_exponent);
  } else {
    coulomb += p.coulomb_force_deceleration_change;
    slope += p.viscous_friction_deceleration_change;
  }
  const S seal = seal_force<S>(p, piston, coulomb + stribeck);
  return ramp * seal + abs(ramp) * (slope * v + p.direction_friction);
}

// Friction force, N, positive against extension: eq. 6.5 to 6.7 with the effects on friction.
template <typename S>
S friction(const Params<S>& p, const Piston<S>& piston) {
  using std::abs;
  return friction_of_width<S>(p, piston,
                              abs(piston.acceleration) * p.stribeck_acceleration_factor * p.stribeck_velocity);
}

// Eq. 6.2: the acceleration only chooses the branch.
template <typename S>
S friction_two_branch(const Params<S>& p, const Piston<S>& piston) {
  return friction_of_width(p, piston, p.stribeck_velocity);
}

// F_C + (F_S - F_C) exp(-|v / v_S|^delta), N
template <typename S>
S stribeck_force(const Params<S>& p, const S& velocity) {
  const S fall = stribeck_fall(velocity, p.stribeck_velocity, p.stribeck_exponent);
  return p.coulomb_force + (p.stiction_force - p.coulomb_force) * fall;
}

// The simple friction law, eq. 4.33 and 6.1: static and Coulomb force, one slope, no dependence on acceleration. It
// jumps at v = 0, where it is zero by sgn(0) = 0.
template <typename S>
S friction_stribeck(const Params<S>& p, const S& velocity) {
  const S dry = stribeck_force(p, velocity);
  const S sign = velocity > S(0) ? S(1) : (velocity < S(0) ? S(-1) : S(0));
  return friction_map(p, velocity) * (p.viscous_friction * velocity + sign * dry);
}

}  // namespace sms
