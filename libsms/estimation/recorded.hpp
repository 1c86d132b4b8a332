// What the plants of shooting.hpp share: recorded signals read at any time, clocks that are late, hidden inputs.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sms/filter.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {
namespace detail {

// Steps of an integration over a time, each within longest_step.
inline int steps_over(double time, double longest_step) {
  return std::max(1, static_cast<int>(std::ceil(time / longest_step - 1e-9)));
}

// How many whole samples a clock is late, and what is left of it, s.
template <typename S>
int whole_samples(double step, const S& late, S* rest) {
  const int samples = static_cast<int>(std::lround(value_of(late) / step));
  *rest = late - S(samples * step);
  return samples;
}

// The command at a time counted in samples; before the first and after the last it is held.
template <typename S>
S command_at(const Eigen::VectorXd& command, const S& at) {
  const double position = value_of(at);
  const Eigen::Index last = command.size() - 1;
  if (!(position > 0.0)) {
    return S(command[0]);
  }
  if (!(position < static_cast<double>(last))) {
    return S(command[last]);
  }
  const Eigen::Index k = static_cast<Eigen::Index>(position);
  return S(command[k]) + (at - S(static_cast<double>(k))) * S(command[k + 1] - command[k]);
}

// |flow| over pressure difference, kg/(s Pa).
template <typename S>
S secant(const S& flow, const S& from, const S& to) {
  using std::abs;
  const S difference = abs(from - to);
  return abs(flow) / (difference > S(100) ? difference : S(100));
}

// A hidden input of a window at `at`, counted in samples from its first: straight lines between `knots` values.
template <typename S>
S hidden_at(const S* values, int knots, int samples, double at) {
  const double place = std::min(at / samples * (knots - 1), knots - 1.001);
  const int k = static_cast<int>(place);
  return values[k] + S(place - k) * (values[k + 1] - values[k]);
}

// A sensor that follows as a first-order lag, stepped exactly for what runs straight. One that is faster than a step, or
// without a lag, is read as it was that long ago: the limit of the same.
template <typename S>
struct FollowingSensor {
  FollowingSensor(const S& time_constant, const S& step) : lag(time_constant), h(step) {
    if (value_of(lag) > value_of(h)) {
      follows = true;
      weight = low_pass_weight<S>(S(1) / lag, h);
    }
  }
  // The reading, `rest` seconds ago besides.
  S at(const S& truth, const S& rate, const S& rest = S(0)) const {
    return follows ? late_reading<S>(reading, (truth - reading) / lag, rest) : late_reading<S>(truth, rate, rest + lag);
  }
  void step(const S& from, const S& to) {
    if (follows) {
      reading = low_pass_ramp_step<S>(S(1) / lag, h, weight, reading, from, to);
    }
  }
  // The truth a step after the last call; at the first it is taken to have been rising like this for long.
  void follow(const S& truth, const S& rate) {
    if (!follows) {
      return;
    }
    reading = begun ? low_pass_ramp_step<S>(S(1) / lag, h, weight, reading, before, truth)
                    : late_reading<S>(truth, rate, lag);
    before = truth;
    begun = true;
  }

  S lag, h, reading{0}, weight{0}, before{0};
  bool follows = false, begun = false;
};

// Predicted less measured over the noise, against the reading `late` samples later: there the late clock has this
// sample. Beyond the record: nothing.
template <typename S>
S reading_error(const S& predicted, const Eigen::VectorXd& measured, Eigen::Index sample, double noise) {
  return sample < 0 || sample >= measured.size() ? S(0) : S((predicted - S(measured[sample])) * S(1.0 / noise));
}

// Which way a signal had gone last at a sample, by more than `least`: 1 up, -1 down, 0 if it never did.
inline double moved_last(const Eigen::VectorXd& signal, int sample, double least) {
  for (int k = sample - 1; k >= 0; --k) {
    const double gone = signal[sample] - signal[k];
    if (std::abs(gone) > least) {
      return gone > 0.0 ? 1.0 : -1.0;
    }
  }
  return 0.0;
}

// Value at the first of some samples, by a parabola through them; its slope per second behind it.
inline Eigen::Vector2d beginning(const Eigen::VectorXd& signal, int first, int samples, double step) {
  const int count = std::min<int>(samples, static_cast<int>(signal.size()) - first);
  Eigen::MatrixX3d powers(count, 3);
  for (int k = 0; k < count; ++k) {
    const double t = k * step;
    powers.row(k) << 1.0, t, t * t;
  }
  const Eigen::Vector3d fitted = powers.colPivHouseholderQr().solve(signal.segment(first, count));
  return fitted.head<2>();
}

// std::invalid_argument for a signal of another length than the command, or with a value that is not finite.
inline void check_signal(const std::string& record, const char* name, const Eigen::VectorXd& signal,
                         Eigen::Index samples) {
  if (signal.size() != samples) {
    throw std::invalid_argument(record + ": " + name + " has " + std::to_string(signal.size()) +
                                " samples, command has " + std::to_string(samples));
  }
  if (!signal.allFinite()) {
    throw std::invalid_argument(record + ": " + name + " holds a value that is not a finite number");
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
