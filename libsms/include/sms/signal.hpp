// Signals: excitations, and the filter that turns measured samples into values and rates (dissertation, sections 5.3.1,
// 6.3 and 7.3.5).
//
// The excitations of the tests, with frequencies in Hz:
//
//   sine    A sin(2 pi f t) + offset
//   chirp   A sin(2 pi ((f_2 - f_1) t / (2 T) + f_1) t),   whose frequency is f_1 + (f_2 - f_1) t / T at t    (eq. 7.3)
//
// (the source calls half of that growth the frequency offset). Beyond T the chirp goes on rising.
//
// The alpha-beta filter follows a signal x and its rate v as if v were constant between samples:
//
//   x^ = x + v dt,   r = y - x^,   x = x^ + alpha r,   v = v + beta r / dt
//
// Stable for 0 < alpha < 1, 0 < beta < 4 - 2 alpha. A constant rate is followed without lag; a steady acceleration a
// leaves an error a dt^2 (1 - alpha) / beta in x. The source uses 0.25 and 0.02 on pressures at 100 Hz, 0.1 and 0.005
// on positions at 1 kHz.
#pragma once

#include <cmath>

namespace sms {

template <typename S>
S sine(const S& time, const S& amplitude, const S& frequency, const S& offset) {
  using std::sin;
  return amplitude * sin(S(6.2831853071795865) * frequency * time) + offset;
}

template <typename S>
struct Chirp {
  S amplitude;
  S first;     // f_1, Hz
  S last;      // f_2, Hz
  S duration;  // T, s
};

template <typename S>
S chirp(const Chirp<S>& c, const S& time) {
  using std::sin;
  const S turns = ((c.last - c.first) / (S(2) * c.duration) * time + c.first) * time;
  return c.amplitude * sin(S(6.2831853071795865) * turns);
}

// Hz
template <typename S>
S chirp_frequency(const Chirp<S>& c, const S& time) {
  return c.first + (c.last - c.first) * time / c.duration;
}

template <typename S>
struct AlphaBeta {
  S value;
  S rate;  // per second
};

template <typename S>
AlphaBeta<S> alpha_beta_step(const S& alpha, const S& beta, const S& dt, const AlphaBeta<S>& state, const S& measured) {
  const S predicted = state.value + state.rate * dt;
  const S residual = measured - predicted;
  return {predicted + alpha * residual, state.rate + beta * residual / dt};
}

}  // namespace sms
