// Newton's second law of a piston whose friction depends on the acceleration that it changes (dissertation, eq. 6.5).
//
//   M a = F - F_f(v, a)
//
// F is all that drives the piston but friction. This is an equation for a, not a formula: to use the acceleration of
// one sample before delays the friction by a sample and lets it ring. It is solved here, for v > 0 (v < 0 mirrored):
//
//   slowing down   F_f = F_2, whatever a:   a = (F - F_2) / M, if that is not positive
//   speeding up    F_f = F_1 + D exp(-(v / (a zeta v_S))^delta):   one scalar equation for a > 0
//   between        F lies between F_2 and F_1, neither branch holds:   a = 0
//
// For D >= 0 (F_S >= F_C) the right-hand side of  M a + F_f(a) = F  rises with a, so the solution is unique. It is
// bracketed by 0 and (F - F_1) / M; Newton's method runs inside the bracket, and bisects where it would leave it or
// does not halve the step. Then one more Newton step is made in the scalar S, which carries exact derivatives.
//
// Laws whose friction does not depend on the acceleration go through the same door, so that a plant names its law and
// nothing else changes.
//
// Two effects give the seals a memory under any of the laws; absent until data switches them on:
//   presliding     a share of the friction is carried by the seals' deformation (LuGre), up to what sliding needs, F_C
//   friction_lag   viscous friction follows the speed w of the lubricant's film, which is late: w' = (v - w) / lag
// Their force acts beside that of the law: what it takes of the acceleration does not change the law's branch.
#pragma once

#include <limits>

#include "sms/friction_dynamic.hpp"
#include "sms/scalar.hpp"

namespace sms {

enum class FrictionLaw : int {
  acceleration_dependent,  // eq. 6.5, the source's own
  two_branch,              // eq. 6.2
  stribeck,  // eq. 6.1 and 4.33; its jump at v = 0, where no balance has a solution, by the ramp of eq. 6.7
  dahl,      // with a deflection of the seals
  lugre      // with a deflection of the seals, elasto-plastic
};

inline constexpr bool depends_on_acceleration(FrictionLaw law) {
  return law == FrictionLaw::acceleration_dependent || law == FrictionLaw::two_branch;
}

// What a motion costs and does; all laws fill it.
template <typename S>
struct ForceBalance {
  S acceleration;     // m/s^2
  S friction;         // N, positive against extension
  S deflection_rate;  // z', m/s; 0 for laws without one
  S film_rate;        // of the lubricant's film, m/s^2; 0 without friction_lag
};

namespace detail {

// F_f against the direction of motion: `slowing`, or `starting` + `rise` exp(-(speed / (a width))^delta).
template <typename S>
struct FrictionBranches {
  S slowing;   // F_2
  S starting;  // F_1
  S rise;      // D
};

template <typename S>
FrictionBranches<S> friction_branches(const Params<S>& p, const Piston<S>& piston) {
  using std::abs;
  const S& v = piston.velocity;
  const S ramp = friction_map(p, v) * friction_ramp(p, v);
  const S factor = excess_factor(p, piston);
  const S starting =
      ramp * seal_force(p, piston, p.coulomb_force) + abs(ramp) * (p.viscous_friction * v + p.direction_friction);
  const S change =
      ramp * factor * p.coulomb_force_deceleration_change + abs(ramp) * v * p.viscous_friction_deceleration_change;
  return {starting + change, starting, ramp * factor * (p.stiction_force - p.coulomb_force)};
}

// exp(-(speed / (a width))^delta) and its derivative by a, for a > 0.
template <typename S>
struct Fall {
  S value;
  S slope;
};

// power: (speed / (a width))^delta
template <typename S>
Fall<S> fall_of(const S& power, const S& exponent, const S& acceleration) {
  using std::exp;
  const S value = exp(-power);
  return {value, value * exponent * power / acceleration};
}

template <typename S>
Fall<S> fall_at(const S& acceleration, const S& speed, const S& width, const S& exponent) {
  return fall_of<S>(stribeck_power<S>(speed, acceleration * width, exponent), exponent, acceleration);
}

// And its second derivative by a, which costs nothing beside the first.
template <typename S>
S fall_curvature(const Fall<S>& fall, const S& power, const S& exponent, const S& acceleration) {
  return fall.slope * (exponent * (power - S(1)) - S(1)) / acceleration;
}

// a > 0 with  mass a + rise fall(a) = excess,  for plain numbers and excess > 0: by steps of Halley's method
// within an interval that holds the root.
template <typename V>
V solve_speeding_up(const V& mass, const V& rise, const V& excess, const V& speed, const V& width, const V& exponent) {
  using std::abs;
  constexpr V kSmall = V(4) * std::numeric_limits<V>::epsilon();
  // The next step is about the third power of one, in shares of a, times the square of the fall's steepness.
  constexpr V kSteepest = V(1e4);
  constexpr int kBound = 3 * std::numeric_limits<V>::digits;
  V low = V(0), high = (rise < V(0) ? excess - rise : excess) / mass;
  V a = high, last_step = high;
  for (int i = 0; i < kBound && high - low > kSmall * high; ++i) {
    const V power = stribeck_power<V>(speed, a * width, exponent);
    const Fall<V> fall = fall_of<V>(power, exponent, a);
    const V off = mass * a + rise * fall.value - excess;
    const V slope = mass + rise * fall.slope;
    const V curvature = rise * fall_curvature<V>(fall, power, exponent, a);
    (off > V(0) ? high : low) = a;
    V next = a - off / (slope - V(0.5) * off * curvature / slope);
    const V step = abs(next - a), share = step / a;
    const bool within = next > low && next < high;
    if (step <= kSmall * a || (within && kSteepest * share * share * share <= kSmall)) {
      return next;
    }
    if (!within || step > V(0.5) * last_step) {
      next = low + V(0.5) * (high - low);
    }
    last_step = abs(next - a);
    a = next;
  }
  return a;
}

}  // namespace detail

// a of eq. 6.5; `piston.acceleration` is not read. mass in kg, drive in N.
template <typename S>
S acceleration_against_friction(const Params<S>& p, const Piston<S>& piston, const S& mass, const S& drive) {
  using std::abs;
  const S direction = piston.velocity < S(0) ? S(-1) : S(1);
  const detail::FrictionBranches<S> branch = detail::friction_branches(p, piston);
  const S over_slowing = direction * (drive - branch.slowing);
  if (!(over_slowing > S(0))) {
    return direction * over_slowing / mass;
  }
  const S excess = direction * (drive - branch.starting);
  if (!(excess > S(0))) {
    return S(0);
  }
  const S rise = direction * branch.rise;
  const S speed = abs(piston.velocity);
  const S width = p.stribeck_acceleration_factor * p.stribeck_velocity;
  const S a(detail::solve_speeding_up(value_of(mass), value_of(rise), value_of(excess), value_of(speed),
                                      value_of(width), value_of(p.stribeck_exponent)));
  const detail::Fall<S> fall = detail::fall_at(a, speed, width, p.stribeck_exponent);
  return direction * (a - (mass * a + rise * fall.value - excess) / (mass + rise * fall.slope));
}

// a of eq. 6.2, where the acceleration only chooses the branch.
template <typename S>
S acceleration_against_two_branches(const Params<S>& p, const Piston<S>& piston, const S& mass, const S& drive) {
  const S direction = piston.velocity < S(0) ? S(-1) : S(1);
  Piston<S> changing = piston;
  changing.acceleration = -direction;
  const S over_slowing = drive - friction_two_branch(p, changing);
  if (!(direction * over_slowing > S(0))) {
    return over_slowing / mass;
  }
  changing.acceleration = direction;
  const S excess = drive - friction_two_branch(p, changing);
  return direction * excess > S(0) ? S(excess / mass) : S(0);
}

// The piston under any of the laws. `piston.acceleration` is not read; `deflection` is z where the law has one.
template <typename S>
ForceBalance<S> force_balance(const Params<S>& p, FrictionLaw law, const Piston<S>& piston, const S& deflection,
                              const S& mass, const S& drive) {
  switch (law) {
    case FrictionLaw::acceleration_dependent: {
      const S a = acceleration_against_friction(p, piston, mass, drive);
      return {a, drive - mass * a, S(0), S(0)};
    }
    case FrictionLaw::two_branch: {
      const S a = acceleration_against_two_branches(p, piston, mass, drive);
      return {a, drive - mass * a, S(0), S(0)};
    }
    case FrictionLaw::stribeck: {
      const S dry = stribeck_force(p, piston.velocity);
      const S ramp = friction_ramp(piston.velocity, p.stiction_velocity);
      const S force = friction_map(p, piston.velocity) * (p.viscous_friction * piston.velocity + ramp * dry);
      return {(drive - force) / mass, force, S(0), S(0)};
    }
    case FrictionLaw::dahl:
    case FrictionLaw::lugre:
      break;
  }
  const BristleFriction<S> bristle =
      law == FrictionLaw::dahl ? dahl_friction(p, piston, deflection) : lugre_friction(p, piston, deflection);
  return {(drive - bristle.force) / mass, bristle.force, bristle.deflection_rate, S(0)};
}

// ---- seals with a memory, whatever the law ----

// What seals remember.
template <typename S>
struct SealState {
  S deflection;  // z, m
  S film;        // speed of the lubricant's film, m/s
};

template <typename S>
bool seals_deviate(const Params<S>& p) {
  return !is_absent(p.presliding_share) || !is_absent(p.friction_lag);
}

// Whether their deflection is a state.
template <typename S>
bool seals_deform(const Params<S>& p, FrictionLaw law) {
  return law == FrictionLaw::dahl || law == FrictionLaw::lugre || !is_absent(p.presliding_share);
}

// A film that is late by less than half a millisecond is late to first order, w = v - lag a.
template <typename S>
bool film_is_state(const Params<S>& p) {
  return !(p.friction_lag < S(5e-4));
}

// By how much friction is more than its law says, N; `balance` is that of the law and gets the rates of the seals' state.
template <typename S>
S seal_deviation(const Params<S>& p, const Piston<S>& piston, const SealState<S>& seals, ForceBalance<S>& balance) {
  S force(0);
  if (!is_absent(p.presliding_share)) {
    const BristleFriction<S> bristle = lugre_friction<S>(p, piston, seals.deflection, p.coulomb_force);
    force += p.presliding_share * (bristle.force - balance.friction);
    balance.deflection_rate = bristle.deflection_rate;
  }
  if (!is_absent(p.friction_lag)) {
    if (film_is_state(p)) {
      force += p.viscous_friction * (seals.film - piston.velocity);
      balance.film_rate = (piston.velocity - seals.film) / p.friction_lag;
    } else {
      force -= p.viscous_friction * p.friction_lag * balance.acceleration;
    }
  }
  return force;
}

// The piston with its seals as they are.
template <typename S>
ForceBalance<S> seal_balance(const Params<S>& p, FrictionLaw law, const Piston<S>& piston, const SealState<S>& seals,
                             const S& mass, const S& drive) {
  ForceBalance<S> balance = force_balance(p, law, piston, seals.deflection, mass, drive);
  if (seals_deviate(p)) {
    const S deviation = seal_deviation(p, piston, seals, balance);
    balance.acceleration -= deviation / mass;
    balance.friction += deviation;
  }
  return balance;
}

// F_L, N: the force with which the rod pushes on its load, from the motion (eq. 6.4).
template <typename S>
S rod_force(const Params<S>& p, const Piston<S>& piston) {
  return pressure_force(p, piston) - friction(p, piston) - p.moving_mass * piston.acceleration;
}

}  // namespace sms
