// Speed of the lubricant's film where a window begins (force_balance.hpp, friction_lag).
//
// The film remembers what the piston did before, w' = (v - w) / lag, and the record has that: the low-pass of a speed is
// how far the place is ahead of its own low-pass,
//
//   w = (x - y) / lag,    y' = (x - y) / lag
//
// so that nothing is differentiated. With the piston's speed in its place a lag of 0.1 s comes out a quarter too long.
#pragma once

#include <algorithm>
#include <cmath>

#include "estimation/recorded.hpp"
#include "sms/filter.hpp"
#include "sms/force_balance.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {

// extension: readings as they stand in the record, NaN where there is none. place, speed: of the piston at the sample
// `first`, where the window begins.
template <typename S>
S film_at_start(const Params<S>& p, const Eigen::VectorXd& extension, double step, int first, const S& place,
                const S& speed) {
  constexpr double kLags = 8.0, kSlope = 0.05;  // of the record before; s of which the first is at an even speed
  if (is_absent(p.friction_lag) || !film_is_state(p)) {
    return speed;
  }
  const SensorErrors<S> sensor = extension_sensor(p);
  const int before = std::min(first, static_cast<int>(std::ceil(kLags * value_of(p.friction_lag) / step)));
  if (before == 0) {
    return speed;
  }
  const Eigen::Vector2d begin =
      detail::beginning(extension, first - before, std::max(8, static_cast<int>(kSlope / step)), step);
  const S corner = S(1) / p.friction_lag, weight = low_pass_weight<S>(corner, S(step));
  const S late = (sensor.clock + sensor.lag) / S(step);
  S x = sensor.truth(S(begin[0]));
  S y = x - p.friction_lag * S(begin[1]) / (S(1) + sensor.gain);
  for (int k = first - before + 1; k <= first; ++k) {
    const S reading = detail::command_at<S>(extension, S(k) + late);
    const S next = k == first ? place : std::isfinite(value_of(reading)) ? sensor.truth(reading) : x;
    y = low_pass_ramp_step<S>(corner, S(step), weight, y, x, next);
    x = next;
  }
  return (place - y) / p.friction_lag;
}

}  // namespace estimation
}  // namespace sms
