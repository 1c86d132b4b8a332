// The rig "bench" as a plant of shooting.hpp: one actuator, its command, extension and chamber pressures measured.
//
// A window starts with what is free: extension, velocity, both pressures, the reservoir's pressure, the deflection of the
// seals, and by how much the air in both chambers is warmer than the supplied. The spool needs none of it: it follows the
// command alone, and is run up over the 50 ms before the window.
//
// The command is the record's (recorded_command.hpp), or that of a controller that is simulated with the rest
// (bench_loop.hpp).
#pragma once

#include "estimation/bench_rates.hpp"
#include "estimation/recorded_command.hpp"
#include "estimation/shooting.hpp"

namespace sms {
namespace estimation {

// One record, evenly sampled. Readings as they stand in the record; arrays of one length.
struct BenchRecord {
  double step = 0.0;  // s
  Eigen::VectorXd command;
  Eigen::VectorXd extension;
  Eigen::VectorXd pressure_lower;
  Eigen::VectorXd pressure_upper;
  Eigen::VectorXd supply_pressure;                 // empty: not measured
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
  Eigen::VectorXd setpoint = {};                   // m; of a loop that is simulated
};

// Standard deviation of one sample.
struct BenchNoise {
  double extension = 1e-4;
  double pressure_lower = 1e3;
  double pressure_upper = 1e3;
  double supply_pressure = 1e3;
};

class BenchPlant {
 public:
  template <typename S>
  using Machine = Params<S>;
  static constexpr int kStart = 8;   // x, v, p_a, p_b, p_R, z, T_a - T, T_b - T
  static constexpr int kFelt = 4;    // without droop, deflection and heat
  static constexpr int kHidden = 3;  // force, N; mass flow into the lower and into the upper chamber, kg/s

  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  BenchPlant(std::vector<BenchRecord> records, const BenchNoise& noise, const ActuatorLaws& laws, double longest_step);

  static double start_scale(int k) {
    constexpr double scale[kStart] = {5e-3, 0.3, 2e4, 2e4, 2e4, 1e-3, 20.0, 20.0};
    return scale[k];
  }
  int records() const { return static_cast<int>(records_.size()); }
  int samples(int record) const { return static_cast<int>(of(record).extension.size()); }
  double step(int record) const { return of(record).step; }
  int channels(int record) const { return of(record).supply_pressure.size() > 0 ? 4 : 3; }
  Eigen::VectorXd guess(int record, int first) const;
  // Whether reservoir, seals or temperatures begin with something of their own.
  bool feels_all(const Params<double>& params, const Window& window) const;

  // Writes the whitened errors of one sample and returns where the next begin.
  template <typename S>
  S* readings(const Params<S>& p, const BenchRecord& record, int sample, const ActuatorSensors<S>& sensors,
              const BenchState<S>& state, const BenchState<S>& rate, S* out) const;

  // residual: for each sample of the window, each channel. hidden: kHidden times knots values, or nullptr.
  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden = nullptr,
                int knots = 0) const;

 protected:
  const BenchRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }
  const ActuatorLaws& laws() const { return laws_; }
  double longest_step() const { return longest_step_; }

  // Which way the piston had gone last, by more than the noise.
  double moved_last(const Eigen::VectorXd& extension, int sample) const {
    return detail::moved_last(extension, sample, 6.0 * noise_.extension);
  }

  // As simulate(), in `steps` steps a sample; drive_of(BenchRates, h) makes what drives the valve.
  template <typename S, typename DriveOf>
  void simulate_driven(const Params<S>& params, const Window& window, int steps, const DriveOf& drive_of,
                       const S* start, S* residual, const S* hidden, int knots) const;

  template <typename S>
  static Params<S> in_run(Params<S> params, const BenchRecord& record) {
    for (const auto& condition : record.conditions) {
      param(params, condition.first) += S(condition.second);
    }
    return params;
  }

 private:
  std::vector<BenchRecord> records_;
  BenchNoise noise_;
  ActuatorLaws laws_;
  double longest_step_;
};

template <typename S>
S* BenchPlant::readings(const Params<S>& p, const BenchRecord& record, int sample, const ActuatorSensors<S>& sensors,
                        const BenchState<S>& state, const BenchState<S>& rate, S* out) const {
  const auto error = [sample](const S& predicted, const Eigen::VectorXd& measured, int samples, double noise) {
    return detail::reading_error(predicted, measured, sample + samples, noise);
  };
  S rest;
  const int late = detail::whole_samples(record.step, p.clock_skew_extension, &rest);
  *out++ = error(sensors.extension_reading(p, state, rest), record.extension, late, noise_.extension);
  const int late_p = detail::whole_samples(record.step, p.clock_skew_chamber_pressure, &rest);
  *out++ = error(sensors.lower_reading(p, state, rate, rest), record.pressure_lower, late_p, noise_.pressure_lower);
  *out++ = error(sensors.upper_reading(p, state, rate, rest), record.pressure_upper, late_p, noise_.pressure_upper);
  if (record.supply_pressure.size() > 0) {
    *out++ = error(
        sensor_reading(state.actuator.supply_pressure, p.sensor_gain_supply_pressure, p.sensor_offset_supply_pressure),
        record.supply_pressure, 0, noise_.supply_pressure);
  }
  return out;
}

template <typename S>
void BenchPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden,
                          int knots) const {
  const BenchRecord& record = of(window.record);
  const int steps = detail::steps_over(record.step, longest_step_);
  const auto recorded = [&](const BenchRates<S>& rates, const S& h) {
    return RecordedCommand<S>(rates.params(), record.command, record.step, window.first, steps, h);
  };
  simulate_driven(params, window, steps, recorded, start, residual, hidden, knots);
}

template <typename S, typename DriveOf>
void BenchPlant::simulate_driven(const Params<S>& params, const Window& window, int steps, const DriveOf& drive_of,
                                 const S* start, S* residual, const S* hidden, int knots) const {
  const BenchRecord& record = of(window.record);
  const BenchRates<S> rate_of(in_run(params, record), laws_);
  const Params<S>& p = rate_of.params();
  const bool droops = p.supply_line_resistance > S(0);
  const S h(record.step / steps);
  auto drive = drive_of(rate_of, h);

  BenchState<S> state = bench_at_rest(rate_of.bench(), start[0], S(0), S(2e5));
  state.velocity = start[1];
  const bool warm = rate_of.is_warm();
  state.actuator.lower = {start[2], warm ? S(p.air_temperature + start[6]) : p.air_temperature};
  state.actuator.upper = {start[3], warm ? S(p.air_temperature + start[7]) : p.air_temperature};
  state.actuator.supply_pressure = droops ? start[4] : p.supply_pressure;
  state.actuator.deflection = start[5];
  drive.begin(state.actuator);

  BenchTerms<S> t;
  BenchState<S> k1, k2, moved;
  // Hidden inputs at `at`, counted in samples from the window's first.
  const auto push = [&](double at, BenchState<S>& rate) {
    if (hidden == nullptr) {
      return;
    }
    const auto value = [&](int input) { return detail::hidden_at(hidden + input * knots, knots, window.samples, at); };
    rate.velocity += value(0) / p.moving_mass;
    rate.actuator.lower.pressure += value(1) * p.gas_constant * p.air_temperature / t.actuator.lower.volume;
    rate.actuator.upper.pressure += value(2) * p.gas_constant * p.air_temperature / t.actuator.upper.volume;
  };
  const auto rates = [&](double at, const BenchState<S>& y, const S& film, BenchState<S>& rate) {
    rate_of(y, drive.at(at), film, t, rate);
    push(at, rate);
  };
  const bool film_is_late = !is_absent(p.friction_lag);
  S film = state.velocity;
  const auto film_at = [&](const S& speed) {
    return film_is_late ? detail::lagging(film, state.velocity, speed, p.friction_lag, h) : speed;
  };
  ActuatorSensors<S> sensors(p, h, is_absent(p.backlash) ? 0.0 : moved_last(record.extension, window.first));
  const S g = S(detail::kStiffShare) * h;
  const auto x = vector_of(state);
  for (int k = 0;; ++k) {
    rates(k, state, film, k1);
    sensors.follow(p, state, k1, t.actuator.force - t.balance.friction);
    drive.step_begins(k, 0, state, sensors, k1);
    residual = readings<S>(p, record, window.first + k, sensors, state, k1, residual);
    residual = drive.readings(window.first + k, residual);
    if (k == window.samples - 1) {
      return;
    }
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        rates(k + double(i) / steps, state, film, k1);
        sensors.follow(p, state, k1, t.actuator.force - t.balance.friction);
        drive.step_begins(k, i, state, sensors, k1);
      }
      const detail::ActuatorStiffness<S> stiff =
          detail::actuator_stiffness(p, laws_.friction, p.moving_mass, t.actuator);
      detail::solve_stiff(stiff, g, k1);
      vector_of(moved) = x + h * vector_of(k1);
      rates(k + double(i + 1) / steps, moved, film_at(moved.velocity), k2);
      vector_of(k2) -= S(2) * vector_of(k1);
      detail::solve_stiff(stiff, g, k2);
      const S speed = state.velocity + (S(0.5) * h) * (S(3) * k1.velocity + k2.velocity);
      film = film_at(speed);
      vector_of(state) += (S(0.5) * h) * (S(3) * vector_of(k1) + vector_of(k2));
    }
  }
}

}  // namespace estimation
}  // namespace sms
