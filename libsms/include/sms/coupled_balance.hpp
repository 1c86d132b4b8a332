// The force balance of three pistons that carry one platform, with friction that depends on their accelerations.
//
//   M a + F_f(v, a) = F        three equations; M, kg, symmetric and positive definite, couples them
//
// In the coordinates of the mechanism its equations of motion read M_q q'' + bias = J^T (F_pistons - F_f); along the
// actuators, with a = J q'' + J' q', that is M = J^-T M_q J^-1 and everything else in F. Each friction rises with its
// own acceleration (force_balance.hpp, F_S >= F_C), so the left-hand side is the gradient of a strictly convex function
// of a: the solution is unique.
//
// Chebyshev's method, Newton's with the curvature of the friction beside its slope, finds it in two steps nearly always:
// the powers and exponentials of a third are dear. Where it does not settle, the pistons are solved one after the other
// for a while, each exactly, by the scalar balance, which on a convex function always comes nearer; a piston that then
// stays between its two branches is held at a = 0, and Chebyshev's method tries again. A last Newton step in S carries
// exact derivatives.
#pragma once

#include "sms/force_balance.hpp"

namespace sms {

namespace detail {

// One piston's friction over its acceleration, and the slope; plain numbers.
template <typename V>
struct FrictionCurve {
  FrictionBranches<V> branch;  // in the direction of motion
  V direction;
  V speed;
  V width;
  V exponent;
};

// Under eq. 6.2 the fall is one of speed alone, and what is left of the rise belongs to the branch.
template <typename S>
FrictionCurve<S> friction_curve(const Params<S>& p, FrictionLaw law, const Piston<S>& piston) {
  using std::abs;
  const S direction = piston.velocity < S(0) ? S(-1) : S(1);
  FrictionBranches<S> b = friction_branches(p, piston);
  if (law == FrictionLaw::two_branch) {
    b.starting += b.rise * stribeck_fall(piston.velocity, p.stribeck_velocity, p.stribeck_exponent);
    b.rise = S(0);
  }
  return {{direction * b.slowing, direction * b.starting, direction * b.rise},
          direction,
          abs(piston.velocity),
          p.stribeck_acceleration_factor * p.stribeck_velocity,
          p.stribeck_exponent};
}

template <typename S>
FrictionCurve<ValueOf<S>> value_of(const FrictionCurve<S>& c) {
  using sms::value_of;
  return {{value_of(c.branch.slowing), value_of(c.branch.starting), value_of(c.branch.rise)},
          value_of(c.direction),
          value_of(c.speed),
          value_of(c.width),
          value_of(c.exponent)};
}

// Friction over the acceleration: value, slope, curvature; and how fast, relative to it, the curvature changes with the
// acceleration's own share.
template <typename S>
struct FrictionNear {
  S value;
  S slope;
  S curvature;
  S steepness;
};

template <typename S>
FrictionNear<S> friction_near(const FrictionCurve<S>& c, const S& acceleration) {
  const S ahead = c.direction * acceleration;
  if (!(ahead > S(0))) {
    return {c.direction * c.branch.slowing, S(0), S(0), S(0)};
  }
  const S power = stribeck_power<S>(c.speed, ahead * c.width, c.exponent);
  const Fall<S> fall = fall_of(power, c.exponent, ahead);
  const S curvature = fall_curvature(fall, power, c.exponent, ahead);
  return {c.direction * (c.branch.starting + c.branch.rise * fall.value), c.branch.rise * fall.slope,
          c.direction * c.branch.rise * curvature, c.exponent * (power + S(1)) + S(2)};
}

// a of mass a + friction(a) = force for one piston.
template <typename V>
V solve_one(const FrictionCurve<V>& c, const V& mass, const V& force) {
  const V ahead = c.direction * force;
  if (!(ahead > c.branch.slowing)) {
    return c.direction * (ahead - c.branch.slowing) / mass;
  }
  const V excess = ahead - c.branch.starting;
  return excess > V(0) ? c.direction * solve_speeding_up(mass, c.branch.rise, excess, c.speed, c.width, c.exponent)
                       : V(0);
}

// What is missing of the balance at a, and what a step makes of it; a piston that is `held` keeps its a = 0.
template <typename S>
struct NearBalance {
  Mat3<S> slope;
  Vec3<S> missing;
  FrictionNear<S> friction[3];
};

template <typename S>
NearBalance<S> near_balance(const FrictionCurve<S> (&curve)[3], const bool (&held)[3], const Mat3<S>& mass,
                            const Vec3<S>& drive, const Vec3<S>& a) {
  NearBalance<S> near;
  near.slope = mass;
  near.missing = drive - mass * a;
  for (int i = 0; i < 3; ++i) {
    FrictionNear<S>& friction = near.friction[i];
    if (held[i]) {
      near.slope.row(i).setZero();
      near.slope(i, i) = S(1);
      near.missing(i) = S(0);
      friction = {S(0), S(0), S(0), S(0)};
      continue;
    }
    friction = friction_near(curve[i], a(i));
    near.slope(i, i) += friction.slope;
    near.missing(i) -= friction.value;
  }
  return near;
}

template <typename V>
V largest(const Vec3<V>& v) {
  return v.cwiseAbs().maxCoeff();
}

// A step, and about what the next would be.
template <typename V>
struct ChebyshevStep {
  Vec3<V> step;
  V left;
};

// Without the curvature's part where a piston changes its branch, or goes so far that its friction changes its shape.
template <typename V>
ChebyshevStep<V> chebyshev_step(const FrictionCurve<V> (&curve)[3], const NearBalance<V>& near, const Vec3<V>& a) {
  using std::abs;
  const Mat3<V> per_force = inverse(near.slope);
  const Vec3<V> straight = per_force * near.missing;
  const auto bending = [&near, &straight](int i) -> V {
    return V(-0.5) * near.friction[i].curvature * straight(i) * straight(i);
  };
  const Vec3<V> correction = per_force * Vec3<V>(bending(0), bending(1), bending(2));
  const V size = largest(straight), bent = largest(correction);
  const Vec3<V> step = straight + correction;
  bool same_branches = true;
  V steepest(0);
  for (int i = 0; i < 3; ++i) {
    const V ahead = curve[i].direction * a(i), next = curve[i].direction * (a(i) + step(i));
    same_branches = same_branches && (ahead > V(0)) == (next > V(0));
    if (ahead > V(0)) {
      steepest = larger(steepest, V(abs(straight(i)) * near.friction[i].steepness / ahead));
    }
  }
  if (!same_branches || !(bent < V(0.25) * size) || !(steepest < V(0.5))) {
    return {straight, size};
  }
  return {step, bent * (V(2) * bent / size + steepest)};
}

// Chebyshev's method from a; false, and a as it was, when it does not settle, or a held piston would have to move.
template <typename V>
bool solve_together(const FrictionCurve<V> (&curve)[3], const bool (&held)[3], const Mat3<V>& mass,
                    const Vec3<V>& drive, Vec3<V>& a) {
  constexpr V kSmall = V(1000) * std::numeric_limits<V>::epsilon();
  Vec3<V> next = a;
  bool settled = false;
  for (int i = 0; i < 8 && !settled; ++i) {
    const ChebyshevStep<V> step = chebyshev_step(curve, near_balance(curve, held, mass, drive, next), next);
    next += step.step;
    settled = step.left <= kSmall * largest(next);
  }
  for (int i = 0; i < 3; ++i) {
    const V left = curve[i].direction * (drive(i) - mass.row(i).dot(next));
    settled = settled && !(held[i] && (left < curve[i].branch.slowing || left > curve[i].branch.starting));
  }
  if (settled) {
    a = next;
  }
  return settled;
}

// One piston after the other, some twenty times, with the others' accelerations as they are.
template <typename V>
void solve_in_turn(const FrictionCurve<V> (&curve)[3], bool (&held)[3], const Mat3<V>& mass, const Vec3<V>& drive,
                   Vec3<V>& a) {
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (int i = 0; i < 3; ++i) {
      const V others = mass.row(i).dot(a) - mass(i, i) * a(i);
      a(i) = solve_one<V>(curve[i], mass(i, i), drive(i) - others);
      held[i] = !(a(i) < V(0)) && !(a(i) > V(0)) && curve[i].branch.starting > curve[i].branch.slowing;
    }
  }
}

}  // namespace detail

// Accelerations of the three pistons, m/s^2, each with parameters of its own, under eq. 6.5 or 6.2; their own
// `acceleration` is not read, and `acceleration` comes in as a first guess: any, what was found a moment ago saves half
// of the work. SMS_NOT_CONVERGED for a mass that is not positive definite; it stays as it was then.
template <typename S>
sms_status coupled_accelerations(const Params<S> (&p)[3], FrictionLaw law, const Piston<S> (&piston)[3],
                                 const Mat3<S>& mass, const Vec3<S>& drive, Vec3<S>& acceleration) {
  using V = ValueOf<S>;
  detail::FrictionCurve<S> curve[3];
  detail::FrictionCurve<V> plain[3];
  for (int i = 0; i < 3; ++i) {
    curve[i] = detail::friction_curve(p[i], law, piston[i]);
    plain[i] = detail::value_of(curve[i]);
  }
  bool held[3] = {false, false, false};
  const Mat3<V> plain_mass = value_of(mass);
  const Vec3<V> force = value_of(drive);
  const Vec3<V> guess = value_of(acceleration);
  Vec3<V> a = is_finite(guess) ? guess : Vec3<V>(Vec3<V>::Zero());
  bool found = detail::solve_together<V>(plain, held, plain_mass, force, a);
  for (int round = 0; round < 50 && !found; ++round) {
    detail::solve_in_turn<V>(plain, held, plain_mass, force, a);
    found = detail::solve_together<V>(plain, held, plain_mass, force, a);
  }
  if (!found || !is_finite(a)) {
    return SMS_NOT_CONVERGED;
  }
  const Vec3<S> start(S(a(0)), S(a(1)), S(a(2)));
  if (std::is_same<S, V>::value) {
    acceleration = start;
  } else {
    const detail::NearBalance<S> near = detail::near_balance(curve, held, mass, drive, start);
    acceleration = start + solution(near.slope, near.missing);
  }
  return SMS_OK;
}

// The balance of three pistons with their seals, under any of the laws:  mass e'' + friction = drive. `by_law` comes in
// as a first guess of the accelerations, and leaves as what they are by the law alone: where the next search begins.
template <typename S>
sms_status balance_pistons(const Params<S> (&p)[3], FrictionLaw law, const Piston<S> (&piston)[3],
                           const SealState<S> (&seals)[3], const Mat3<S>& mass, const Vec3<S>& drive, Vec3<S>& by_law,
                           ForceBalance<S> (&balance)[3]) {
  Vec3<S> friction;
  if (depends_on_acceleration(law)) {
    const sms_status status = coupled_accelerations(p, law, piston, mass, drive, by_law);
    if (status != SMS_OK) {
      return status;
    }
    friction = drive - mass * by_law;
    for (int i = 0; i < 3; ++i) {
      balance[i] = {by_law(i), friction(i), S(0), S(0)};
    }
  } else {
    for (int i = 0; i < 3; ++i) {
      balance[i] = force_balance<S>(p[i], law, piston[i], seals[i].deflection, S(1), S(0));
      friction(i) = balance[i].friction;
    }
    by_law = solution<S>(mass, drive - friction);
    for (int i = 0; i < 3; ++i) {
      balance[i].acceleration = by_law(i);
    }
  }
  if (seals_deviate(p[0]) || seals_deviate(p[1]) || seals_deviate(p[2])) {
    Vec3<S> deviation;
    for (int i = 0; i < 3; ++i) {
      deviation(i) = seal_deviation(p[i], piston[i], seals[i], balance[i]);
    }
    const Vec3<S> slowed = solution<S>(mass, deviation);
    for (int i = 0; i < 3; ++i) {
      balance[i].acceleration -= slowed(i);
      balance[i].friction += deviation(i);
    }
  }
  return SMS_OK;
}

}  // namespace sms
