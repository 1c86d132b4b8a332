// Linear lags of first and second order: the spool of a valve, the filters of the electronics.
//
//   first    y' = omega (u - y)
//   second   y'' = omega^2 (u - y) - 2 zeta omega y'
//
// Twice: as rates, for an integrator that carries y as a state, and as the exact step over dt for an input that is
// held, as a converter holds its output, or runs straight. The exact step has no error of its own and is stable for any
// dt, so that a filter far faster than the sampling costs nothing. A Butterworth filter of second order has zeta = 1/sqrt(2); only
// then is omega also its -3 dB frequency.
#pragma once

#include <cmath>

#include "sms/params.hpp"

namespace sms {

// rad/s from Hz
template <typename S>
S angular_frequency(const S& frequency) {
  return S(6.2831853071795865) * frequency;
}

// ---- first order ----

template <typename S>
S low_pass_rate(const S& omega, const S& value, const S& input) {
  return omega * (input - value);
}

// Weight of the input after dt: 1 - exp(-omega dt). To be computed once for a fixed dt.
template <typename S>
S low_pass_weight(const S& omega, const S& dt) {
  using std::exp;
  return S(1) - exp(-omega * dt);
}

template <typename S>
S low_pass_step(const S& weight, const S& value, const S& input) {
  return value + weight * (input - value);
}

// Input that runs straight from `from` to `to` during dt: the exact step for it, with weight as above.
template <typename S>
S low_pass_ramp_step(const S& omega, const S& dt, const S& weight, const S& value, const S& from, const S& to) {
  return value + weight * (from - value) + (to - from) * (S(1) - weight / (omega * dt));
}

// ---- second order ----

template <typename S>
struct Lag {
  using Scalar = S;
  S value;
  S rate;  // per second
};

template <typename S>
Lag<S> lag_rate(const S& omega, const S& damping_ratio, const Lag<S>& lag, const S& input) {
  return {lag.rate, omega * (omega * (input - lag.value) - S(2) * damping_ratio * lag.rate)};
}

// k with (I - g A) k = rate, where A is the lag's own matrix: its part in the step of a stiff integrator.
template <typename S>
void solve_lag(const S& omega, const S& damping_ratio, const S& g, Lag<S>& rate) {
  const S turn = g * omega;
  rate.rate = (rate.rate - turn * omega * rate.value) / (S(1) + turn * (S(2) * damping_ratio + turn));
  rate.value += g * rate.rate;
}

// The exact step over a fixed dt: (value - input, rate) is multiplied by a constant matrix.
template <typename S>
struct LagStep {
  S value_value;
  S value_rate;
  S rate_value;
  S rate_rate;
};

// For damping_ratio < 1.
template <typename S>
LagStep<S> make_lag_step(const S& omega, const S& damping_ratio, const S& dt) {
  using std::cos;
  using std::exp;
  using std::sin;
  using std::sqrt;
  const S decay = damping_ratio * omega;
  const S ringing = omega * sqrt(S(1) - damping_ratio * damping_ratio);
  const S envelope = exp(-decay * dt);
  const S c = envelope * cos(ringing * dt);
  const S s = envelope * sin(ringing * dt) / ringing;
  return {c + decay * s, s, -omega * omega * s, c - decay * s};
}

template <typename S>
Lag<S> lag_step(const LagStep<S>& step, const Lag<S>& lag, const S& input) {
  const S off = lag.value - input;
  return {input + step.value_value * off + step.value_rate * lag.rate,
          step.rate_value * off + step.rate_rate * lag.rate};
}

}  // namespace sms
