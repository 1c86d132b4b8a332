// Equations fed with measured signals: what was measured is put into each equation of a plant, and what is left over is
// that equation's own error. Nothing is simulated as a whole, so an error does not wander from one equation to the next.
//
// Smoothing and differentiation are the caller's: an extension comes with its velocity and acceleration, a pressure with
// its rate. A state that no sensor sees (spool, temperature of the air, deflection of the seals, reservoir) follows by
// its own equation from the command and from what was measured, with one step a sample: it is either slow beside that, or
// so fast that it follows at once.
//
// A sensor's gain, offset, lag and clock are undone as the parameters say; mount and play (frame_compliance, backlash) are
// not.
#pragma once

#include "estimation/recorded.hpp"
#include "sms/vessel.hpp"

namespace sms {
namespace estimation {

// A signal and its derivatives in time, one a sample, SI; `rate` and `second` empty where the equations need none.
struct MeasuredSignal {
  Eigen::VectorXd value;
  Eigen::VectorXd rate;
  Eigen::VectorXd second;
};

template <typename S>
struct Truth {
  S value, rate, second;
};

// What was there at a sample, in the place of what was read then and, by a late sensor, after.
template <typename S>
Truth<S> truth_at(const MeasuredSignal& signal, int sample, double step, const SensorErrors<S>& sensor) {
  const S place = S(sample) + (sensor.clock + sensor.lag) / S(step);
  const auto read = [&place](const Eigen::VectorXd& values) {
    return values.size() > 0 ? detail::command_at<S>(values, place) : S(0);
  };
  const S truth = sensor.truth(read(signal.value));
  const S slope = sensor.slope(truth);
  return {truth, read(signal.rate) / slope, read(signal.second) / slope};
}

// The reservoir a sample later, as an equation of its own; it is the set point where there is no line (vessel.hpp).
template <typename S>
S reservoir_after(const Params<S>& p, const S& pressure, const S& drawn, double step) {
  if (!(p.supply_line_resistance > S(0))) {
    return p.supply_pressure;
  }
  const S follows = p.compression_heat_ratio * p.gas_constant * p.air_temperature /
                    (p.reservoir_volume * supply_line_slope<S>(p, p.supply_pressure - pressure));
  return pressure + S(step) * reservoir_pressure_rate(p, pressure, drawn) / (S(1) + S(step) * follows);
}

namespace detail {

// std::invalid_argument for a signal with fewer derivatives than needed, other lengths or numbers that are not finite.
inline void check_measured(const std::string& record, const char* name, const MeasuredSignal& signal, int derivatives,
                           Eigen::Index samples) {
  const std::string of = name;
  check_signal(record, name, signal.value, samples);
  if (derivatives > 0) {
    check_signal(record, ("rate of " + of).c_str(), signal.rate, samples);
  }
  if (derivatives > 1) {
    check_signal(record, ("second derivative of " + of).c_str(), signal.second, samples);
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
