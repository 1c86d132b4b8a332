// The actuator under its load as a third-order system, and state feedback designed on it (dissertation, chapter 8,
// after Z. Situm).
//
// Two chambers are two springs on the mass; the valve is an integrator in front of them:
//
//   G(s) = C_0 w_s^2 / (s (s^2 + 2 zeta w_s s + w_s^2))                           (eq. 8.1, k_m = 1)
//   c = 4 kappa p A^2 / V,   w_s = sqrt(c / m),   zeta = b / (2 m w_s)            (eq. 8.2, 8.3)
//
// with the mean chamber pressure p, the bore's area A and V = A stroke. Under feedback of position, velocity and
// acceleration,
//
//   T(s) = K_p C_0 w_s^2 / (s^3 + (2 zeta w_s + K_a C_0 w_s^2) s^2 + (1 + K_v C_0) w_s^2 s + K_p C_0 w_s^2)   (8.5)
//
// of which eq. 8.4 is the case of P control. Three equal poles at w_c / 2 ("Situm") or w_c / sqrt(3) ("specification
// based"), w_c = alpha w_s, give the gains of eq. 8.8 to 8.10 and 8.13 to 8.15. Eq. 8.9 is misprinted: its poles give
// (3 alpha^2 / 4 - 1) / C_0, it says 3 (alpha^2 - 1) / (4 C_0), and the published gain carries the misprint. Both
// readings are here.
//
// The published numbers do not follow from their own tables: the mean pressure of Table D.1 is the sum of the two
// chambers', so its spring is twice too stiff, and the gains of Table E.1 belong to w_s = 26.22 rad/s and C_0 = 0.7,
// not to the 15.139 rad/s and 0.85 beside them.
#pragma once

#include "sms/piston.hpp"

namespace sms {

template <typename S>
struct SimplifiedPlant {
  S velocity_gain;      // C_0, m/s per V
  S natural_frequency;  // w_s, rad/s
  S damping_ratio;      // zeta
};

// c of eq. 8.2, N/m
template <typename S>
S air_spring(const Params<S>& p, const S& mean_pressure) {
  return S(4) * p.heat_capacity_ratio * mean_pressure * circle_area(p.bore_diameter) / p.stroke;
}

// Eq. 8.2 and 8.3; mass in kg, viscous_friction of the parameters.
template <typename S>
SimplifiedPlant<S> simplified_plant(const Params<S>& p, const S& mean_pressure, const S& mass, const S& velocity_gain) {
  using std::sqrt;
  const S natural_frequency = sqrt(air_spring(p, mean_pressure) / mass);
  return {velocity_gain, natural_frequency, p.viscous_friction / (S(2) * mass * natural_frequency)};
}

template <typename S>
struct StateFeedbackGains {
  S position;      // K_p
  S velocity;      // K_v
  S acceleration;  // K_a
};

// Three poles at -pole, exactly.
template <typename S>
StateFeedbackGains<S> gains_for_triple_pole(const SimplifiedPlant<S>& g, const S& pole) {
  const S w = g.natural_frequency, scale = S(1) / (g.velocity_gain * w * w);
  return {scale * pole * pole * pole, scale * (S(3) * pole * pole - w * w),
          scale * (S(3) * pole - S(2) * g.damping_ratio * w)};
}

// Eq. 8.8 to 8.10 with poles at alpha w_s / 2; K_v as printed or as the poles have it.
template <typename S>
StateFeedbackGains<S> gains_situm(const SimplifiedPlant<S>& g, const S& alpha, bool as_printed) {
  StateFeedbackGains<S> gains = gains_for_triple_pole<S>(g, S(0.5) * alpha * g.natural_frequency);
  if (as_printed) {
    gains.velocity = S(0.75) * (alpha * alpha - S(1)) / g.velocity_gain;
  }
  return gains;
}

// Eq. 8.13 to 8.15, poles at alpha w_s / sqrt(3).
template <typename S>
StateFeedbackGains<S> gains_specification_based(const SimplifiedPlant<S>& g, const S& alpha) {
  using std::sqrt;
  return gains_for_triple_pole<S>(g, alpha * g.natural_frequency / sqrt(S(3)));
}

// s^3 + square s^2 + linear s + constant, the denominator of eq. 8.5; `constant` is its numerator too.
template <typename S>
struct ThirdOrder {
  S square;
  S linear;
  S constant;
};

template <typename S>
ThirdOrder<S> closed_loop(const SimplifiedPlant<S>& g, const StateFeedbackGains<S>& k) {
  const S w = g.natural_frequency, drive = g.velocity_gain * w * w;
  return {S(2) * g.damping_ratio * w + k.acceleration * drive, w * w + k.velocity * drive, k.position * drive};
}

// Routh and Hurwitz
template <typename S>
bool is_stable(const ThirdOrder<S>& t) {
  return t.square > S(0) && t.constant > S(0) && t.square * t.linear > t.constant;
}

// The largest K_p of P control that is stable, V/m.
template <typename S>
S largest_stable_gain(const SimplifiedPlant<S>& g) {
  return S(2) * g.damping_ratio * g.natural_frequency / g.velocity_gain;
}

// One real pole, and two more: middle +- spread, or middle +- i spread.
template <typename S>
struct Poles {
  S real;        // rad/s
  S middle;      // rad/s
  S spread;      // rad/s
  bool is_pair;  // complex
};

// The real root by bisection and Newton's method from Cauchy's bound inwards, the others from the quadratic that
// remains.
template <typename S>
Poles<S> poles(const ThirdOrder<S>& t) {
  using std::abs;
  using std::sqrt;
  const auto value = [&t](const S& s) { return ((s + t.square) * s + t.linear) * s + t.constant; };
  S bound = abs(t.square) > abs(t.linear) ? S(abs(t.square)) : S(abs(t.linear));
  bound = S(1) + (bound > abs(t.constant) ? bound : S(abs(t.constant)));
  S low = -bound, high = bound;
  for (int i = 0; i < 40; ++i) {
    const S middle = S(0.5) * (low + high);
    (value(middle) > S(0) ? high : low) = middle;
  }
  S root = S(0.5) * (low + high);
  for (int i = 0; i < 4; ++i) {
    const S slope = (S(3) * root + S(2) * t.square) * root + t.linear;
    const S next = root - value(root) / slope;
    root = next > low && next < high ? next : root;
  }
  const S half = S(-0.5) * (root + t.square);
  const S discriminant = half * half - (root * (root + t.square) + t.linear);
  return {root, half, sqrt(abs(discriminant)), discriminant < S(0)};
}

// T(i omega): amplitude ratio and phase (rad, falling from 0 to -3 pi / 2 over a stable loop's frequencies).
template <typename S>
struct FrequencyResponse {
  S amplitude;
  S phase;
};

template <typename S>
FrequencyResponse<S> frequency_response(const ThirdOrder<S>& t, const S& omega) {
  using std::atan2;
  using std::sqrt;
  const S real = t.constant - t.square * omega * omega;
  const S imaginary = omega * (t.linear - omega * omega);
  const S angle = atan2(imaginary, real);
  return {t.constant / sqrt(real * real + imaginary * imaginary),
          angle < S(0) ? S(-6.2831853071795865) - angle : -angle};
}

}  // namespace sms
