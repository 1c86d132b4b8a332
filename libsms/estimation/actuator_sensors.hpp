// What the three sensors of one actuator see: extension and both chamber pressures, each as a first-order lag.
//
// Where a lag lasts longer than a step of the simulation the reading is a state that follows, x' = (truth - x) / lag; a
// delay by the same time differs from it by half its square times the acceleration. That is how a slow sensor and a late
// clock are told apart. Play between rod and sensor is carried along; a window begins with the sensor pushed the way that
// it moved last.
#pragma once

#include "estimation/bench_rates.hpp"
#include "estimation/recorded.hpp"

namespace sms {
namespace estimation {

template <typename S>
struct ActuatorSensors {
  // step: of the simulation, s. moved: 1 if the extension's reading rose last, -1 if it fell, 0 if that is not known.
  ActuatorSensors(const Params<S>& p, const S& step, double moved = 0.0)
      : extension(p.sensor_lag_extension, step),
        lower(p.sensor_lag_chamber_pressure_lower, step),
        upper(p.sensor_lag_chamber_pressure_upper, step),
        pushed(moved) {}

  // The state a step after the last call, its rates, and the force that bends the mount and takes up the play, N.
  void follow(const Params<S>& p, const BenchState<S>& y, const BenchState<S>& rate, const S& force) {
    const S eye = yielded_extension<S>(p, y.extension, force);
    if (begun && !is_absent(p.backlash)) {
      truth = played<S>(truth, eye, p.backlash);
    } else {
      truth = eye - S(0.5 * pushed) * p.backlash;
    }
    begun = true;
    extension.follow(truth, y.velocity);
    lower.follow(y.actuator.lower.pressure, rate.actuator.lower.pressure);
    upper.follow(y.actuator.upper.pressure, rate.actuator.upper.pressure);
  }

  // Readings as the logger has them, `rest` seconds late besides.
  S extension_reading(const Params<S>& p, const BenchState<S>& y, const S& rest) const {
    return sensor_reading<S>(extension.at(truth, y.velocity, rest), p.sensor_gain_extension, p.sensor_offset_extension);
  }
  S lower_reading(const Params<S>& p, const BenchState<S>& y, const BenchState<S>& rate, const S& rest) const {
    return sensor_reading<S>(lower.at(y.actuator.lower.pressure, rate.actuator.lower.pressure, rest),
                             p.sensor_gain_chamber_pressure_lower, p.sensor_offset_chamber_pressure_lower);
  }
  S upper_reading(const Params<S>& p, const BenchState<S>& y, const BenchState<S>& rate, const S& rest) const {
    return sensor_reading<S>(upper.at(y.actuator.upper.pressure, rate.actuator.upper.pressure, rest),
                             p.sensor_gain_chamber_pressure_upper, p.sensor_offset_chamber_pressure_upper);
  }

  detail::FollowingSensor<S> extension, lower, upper;
  double pushed;
  S truth{0};  // what the extension's sensor would read without a lag
  bool begun = false;
};

}  // namespace estimation
}  // namespace sms
