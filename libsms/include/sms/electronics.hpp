// Between the controller and the machine: converter, filters, pulse width, dead time (dissertation, section 7.3.3).
//
//   extension -> potentiometer -> anti-alias filter, first order -> converter, 12 bit          -> controller
//   controller -> pulse width, 50 kHz, 1500 steps of 10 V -> filter, second order, 98 Hz -> valve
//
// The potentiometer spans more than the stroke (0.45 m over 0.4 m), so that its ends, where the amplifier saturates,
// are not used. The pulses themselves are 500 times faster than their filter and leave a ripple below 1e-5 of the
// range; what is kept of them is the resolution. The filters run on the desk in exact steps (filter.hpp): behind the
// pulse width the input is held, so that step has no error; the input of the anti-alias filter moves during a step, and
// has to be sampled well above its corner.
#pragma once

#include <cmath>

#include "sms/controller.hpp"
#include "sms/filter.hpp"

namespace sms {

// ---- in ----

// Steps of a converter; to be computed once.
template <typename S>
struct Converter {
  S step;     // value of one count
  S largest;  // highest count
};

template <typename S>
Converter<S> position_converter(const Params<S>& p) {
  using std::floor;
  using std::pow;
  const S counts = floor(pow(S(2), p.adc_bits) + S(0.5));
  return {p.potentiometer_range / counts, counts - S(1)};
}

// The nearest count from 0 to the largest.
template <typename S>
S to_counts(const Converter<S>& c, const S& value) {
  using std::floor;
  return limited<S>(floor(value / c.step + S(0.5)), S(0), c.largest);
}

// What the controller takes for the extension, m.
template <typename S>
S sampled_extension(const Params<S>& p, const Converter<S>& c, const S& extension) {
  return c.step * to_counts<S>(c, extension + p.potentiometer_margin) - p.potentiometer_margin;
}

// ---- out ----

template <typename S>
Converter<S> command_converter(const Params<S>& p) {
  return {S(2) * command_limit<S>() / p.pwm_steps, p.pwm_steps};
}

// The mean of the pulses for a command, V.
template <typename S>
S pulse_width_voltage(const Converter<S>& c, const S& command) {
  return c.step * to_counts(c, command);
}

template <typename S>
LagStep<S> dac_filter(const Params<S>& p, const S& dt) {
  return make_lag_step(angular_frequency(p.dac_filter_frequency), p.dac_filter_damping_ratio, dt);
}

// ---- dead time ----

// The last N samples; all zero, or filled by delay_line_at.
template <typename S, int N>
struct DelayLine {
  S sample[N];
  int newest;
};

template <int N, typename S>
DelayLine<S, N> delay_line_at(const S& value) {
  DelayLine<S, N> line;
  for (S& sample : line.sample) {
    sample = value;
  }
  line.newest = 0;
  return line;
}

// Takes a sample and gives the one of `delay` steps ago; delay from 0 (the sample itself) to N - 1, beyond it N - 1.
template <typename S, int N>
S delay_line_step(DelayLine<S, N>& line, const S& sample, int delay) {
  line.newest = line.newest + 1 < N ? line.newest + 1 : 0;
  line.sample[line.newest] = sample;
  const int steps = delay < 0 ? 0 : (delay < N ? delay : N - 1);
  return line.sample[line.newest >= steps ? line.newest - steps : line.newest - steps + N];
}

// Whole steps of dt in a dead time.
template <typename S>
int delay_steps(const S& delay, const S& dt) {
  return static_cast<int>(delay / dt + S(0.5));
}

}  // namespace sms
