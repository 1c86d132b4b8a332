// The rig "tank" as a plant of shooting.hpp: a vessel behind one port of the valve (tank.hpp), its command and pressure
// measured, its temperature and the supply's pressure where there are sensors.
//
// A window starts with what is free: pressure and temperature of the air, the reservoir's pressure and the thermocouple.
// Without heat the temperature is that of the supplied air, and the thermometer sees that. The spool follows the command
// alone and is run up over the 50 ms before the window.
//
// The step is that of actuator_step.hpp (ROS2), with the flow over its pressure difference as the slope of each pressure
// and the exchange of its air as that of the temperature: a small tank behind an open valve is stiff, and so is a
// reservoir behind a short line.
#pragma once

#include "estimation/actuator_step.hpp"
#include "estimation/recorded.hpp"
#include "estimation/shooting.hpp"
#include "sms/integrate.hpp"
#include "sms/sensor.hpp"
#include "sms/tank.hpp"

namespace sms {
namespace estimation {

// One record, evenly sampled. Readings as they stand in the record; arrays of one length.
struct TankPlantRecord {
  double step = 0.0;  // s
  Eigen::VectorXd command;
  Eigen::VectorXd pressure;
  Eigen::VectorXd temperature;                     // empty: not measured
  Eigen::VectorXd supply_pressure;                 // empty: not measured
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
};

// Standard deviation of one sample.
struct TankNoise {
  double pressure = 1e3;
  double temperature = 0.1;
  double supply_pressure = 1e3;
};

class TankPlant {
 public:
  template <typename S>
  using Machine = Params<S>;
  static constexpr int kStart = 4;  // p, T, p_R, T_tc
  static constexpr int kFelt = kStart;
  static constexpr int kHidden = 2;  // mass flow into the tank, kg/s; pressure at the head of the supply line, Pa

  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  TankPlant(std::vector<TankPlantRecord> records, const TankNoise& noise, const ActuatorLaws& laws,
            double longest_step);

  static double start_scale(int k) {
    constexpr double scale[kStart] = {2e4, 20.0, 2e4, 20.0};
    return scale[k];
  }
  int records() const { return static_cast<int>(records_.size()); }
  int samples(int record) const { return static_cast<int>(of(record).command.size()); }
  double step(int record) const { return of(record).step; }
  int channels(int record) const {
    return 1 + (of(record).temperature.size() > 0 ? 1 : 0) + (of(record).supply_pressure.size() > 0 ? 1 : 0);
  }
  Eigen::VectorXd guess(int record, int first) const;
  bool feels_all(const Params<double>&, const Window&) const { return true; }

  // residual: for each sample of the window, each channel. hidden: kHidden times knots values, or nullptr.
  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden = nullptr,
                int knots = 0) const;

 private:
  const TankPlantRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }

  // Writes the whitened errors of one sample, as the sensors have it, and returns where the next begin.
  template <typename S>
  S* readings(const Params<S>& p, const TankPlantRecord& record, int sample, const TankState<S>& state,
              const TankState<S>& rate, const S& pressure, const S& temperature, S* out) const;

  std::vector<TankPlantRecord> records_;
  TankNoise noise_;
  ActuatorLaws laws_;
  double longest_step_;
};

namespace detail {

// A of the step.
template <typename S>
struct TankStiffness {
  S pressure;     // d p'/d p
  S temperature;  // d T'/d T
  S reservoir;    // d p_R'/d p_R
};

template <typename S>
TankStiffness<S> tank_stiffness(const Params<S>& p, const TankState<S>& state, const TankTerms<S>& t) {
  const S of_air = p.gas_constant * p.air_temperature, stiff_air = p.heat_capacity_ratio * of_air;
  const S feed = secant<S>(t.feed, state.supply_pressure, t.air.pressure);
  const S vent = secant<S>(t.vent, t.air.pressure, p.ambient_pressure);
  const S thin = t.air.pressure > S(1e3) ? t.air.pressure : S(1e3);  // a bad guess may have emptied the tank
  TankStiffness<S> s;
  s.pressure = -(stiff_air / t.space.volume * (feed + vent));
  s.temperature = -(of_air * (t.flow.in + t.flow.out) / (thin * t.space.volume));
  s.reservoir = p.supply_line_resistance > S(0)
                    ? S(-(stiff_air / p.reservoir_volume * (S(1) / p.supply_line_resistance + feed)))
                    : S(0);
  return s;
}

// k with (I - g A) k = rate
template <typename S>
void solve_stiff(const TankStiffness<S>& s, const S& g, TankState<S>& rate) {
  rate.gas.pressure /= S(1) - g * s.pressure;
  rate.gas.temperature /= S(1) - g * s.temperature;
  rate.supply_pressure /= S(1) - g * s.reservoir;
}

}  // namespace detail

template <typename S>
S* TankPlant::readings(const Params<S>& p, const TankPlantRecord& record, int sample, const TankState<S>& state,
                       const TankState<S>& rate, const S& pressure, const S& temperature, S* out) const {
  S rest;
  const int late = detail::whole_samples(record.step, p.clock_skew_tank, &rest);
  const S then = late_reading<S>(pressure, rate.gas.pressure, rest);
  *out++ = detail::reading_error<S>(sensor_reading(then, p.sensor_gain_tank_pressure, p.sensor_offset_tank_pressure),
                                    record.pressure, sample + late, noise_.pressure);
  if (record.temperature.size() > 0) {
    const S warmer = temperature - p.air_temperature;  // a thermocouple measures against its cold junction
    const S reading =
        p.air_temperature + sensor_reading<S>(warmer, p.sensor_gain_tank_temperature, p.sensor_offset_tank_temperature);
    *out++ = detail::reading_error<S>(reading, record.temperature, sample + late, noise_.temperature);
  }
  if (record.supply_pressure.size() > 0) {
    *out++ = detail::reading_error<S>(
        sensor_reading(state.supply_pressure, p.sensor_gain_supply_pressure, p.sensor_offset_supply_pressure),
        record.supply_pressure, sample, noise_.supply_pressure);
  }
  return out;
}

template <typename S>
void TankPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden,
                         int knots) const {
  const TankPlantRecord& record = of(window.record);
  Tank<S> tank{params, laws_};
  for (const auto& condition : record.conditions) {
    param(tank.params, condition.first) += S(condition.second);
  }
  const Params<S>& p = tank.params;
  const S head = p.supply_pressure;
  const bool droops = p.supply_line_resistance > S(0);
  const bool warm = laws_.chamber == ChamberLaw::energy || !is_absent(p.heat_share);
  const double sample = record.step;
  const int steps = std::max(1, static_cast<int>(std::ceil(sample / longest_step_ - 1e-9)));
  const S h(sample / steps);
  const S late = p.command_delay / S(sample);

  TankState<S> state = tank_at_rest<S>(p, start[0]);
  state.gas.temperature = warm ? start[1] : p.air_temperature;
  state.supply_pressure = droops ? start[2] : head;
  state.spool = detail::spool_at<S>(p, record.command, window.first, steps, h, late);

  TankTerms<S> t;
  TankState<S> k1, k2, moved;
  const auto rates = [&](double at, TankState<S>& y, TankState<S>& rate) {
    if (hidden != nullptr) {
      tank.params.supply_pressure = head + detail::hidden_at(hidden + knots, knots, window.samples, at);
      y.supply_pressure = droops ? y.supply_pressure : tank.params.supply_pressure;
    }
    derivative(tank, y, {detail::command_at<S>(record.command, S(window.first + at) - late)}, t, rate);
    if (hidden != nullptr) {
      rate.gas.pressure +=
          detail::hidden_at(hidden, knots, window.samples, at) * p.gas_constant * p.air_temperature / t.space.volume;
    }
  };
  detail::FollowingSensor<S> gauge(p.sensor_lag_tank_pressure, h), couple(p.thermocouple_time_constant, h);
  couple.reading = warm ? start[3] : p.air_temperature;

  const S g = S(detail::kStiffShare) * h;
  for (int k = 0;; ++k) {
    rates(k, state, k1);
    if (k == 0) {
      gauge.reading = late_reading<S>(state.gas.pressure, k1.gas.pressure, p.sensor_lag_tank_pressure);
    }
    residual = readings<S>(p, record, window.first + k, state, k1, gauge.at(state.gas.pressure, k1.gas.pressure),
                           couple.at(tank_air(tank, state.gas).temperature, k1.gas.temperature), residual);
    if (k == window.samples - 1) {
      return;
    }
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        rates(k + double(i) / steps, state, k1);
      }
      const auto stiffness = detail::tank_stiffness<S>(p, state, t);
      detail::solve_stiff<S>(stiffness, g, k1);
      const Gas<S> before = tank_air(tank, state.gas);
      vector_of(moved) = vector_of(state) + h * vector_of(k1);
      rates(k + double(i + 1) / steps, moved, k2);
      vector_of(k2) -= S(2) * vector_of(k1);
      detail::solve_stiff<S>(stiffness, g, k2);
      vector_of(state) += (S(0.5) * h) * (S(3) * vector_of(k1) + vector_of(k2));
      const Gas<S> after = tank_air(tank, state.gas);
      gauge.step(before.pressure, after.pressure);
      couple.step(before.temperature, after.temperature);
    }
  }
}

}  // namespace estimation
}  // namespace sms
