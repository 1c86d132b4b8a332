// The rig "bench" as a plant of shooting.hpp: one actuator, its command, extension and chamber pressures measured.
//
// A window starts with what is free: extension, velocity, both pressures, the reservoir's pressure, the deflection of the
// seals, and by how much the air in both chambers is warmer than the supplied. The spool needs none of it: it follows the
// command alone, and is run up over the 50 ms before the window; nor does the lubricant's film, which follows the motion
// that was recorded (film_at_start.hpp).
//
// The command is the record's (recorded_command.hpp), or that of a controller that is simulated with the rest
// (bench_loop.hpp).
#pragma once

#include <functional>
#include <memory>

#include "estimation/film_at_start.hpp"
#include "estimation/hidden_inputs.hpp"
#include "estimation/recorded_command.hpp"
#include "estimation/shooting.hpp"
#include "estimation/through_window.hpp"
#include "sms/plant_sensors.hpp"

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
  Hold hold = Hold::linear;                        // of the command, where that is the record's
  Eigen::VectorXd ahead = {};                      // s: of its jumps (command_jumps.hpp); empty: not known
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
  static constexpr int kStart = 8;  // x, v, p_a, p_b, p_R, z, T_a - T, T_b - T
  static constexpr int kFelt = 4;   // without droop, deflection and heat
  static constexpr int kCommands = 1;
  static constexpr int kHidden = 3;  // force, N; mass flow into the lower and into the upper chamber, kg/s

  // std::invalid_argument for arrays of different lengths or numbers that are not finite; a reading may be NaN.
  BenchPlant(std::vector<BenchRecord> records, const BenchNoise& noise, const ActuatorLaws& laws,
             const LongestSteps& longest_step);

  static double start_scale(int k) {
    constexpr double scale[kStart] = {5e-3, 0.3, 2e4, 2e4, 2e4, 1e-3, 20.0, 20.0};
    return scale[k];
  }
  int records() const { return static_cast<int>(records_.size()); }
  int samples(int record) const { return static_cast<int>(of(record).extension.size()); }
  double step(int record) const { return of(record).step; }
  int channels(int record) const { return of(record).supply_pressure.size() > 0 ? 4 : 3; }
  const Eigen::VectorXd& command(int record, int) const { return of(record).command; }
  Eigen::VectorXd& ahead(int record, int) { return records_[static_cast<std::size_t>(record)].ahead; }
  Eigen::VectorXd guess(int record, int first) const;
  // Whether reservoir, seals or temperatures begin with something of their own.
  bool feels_all(const Params<double>& params, const Window& window) const;

  // The whole state where a window begins, in the order of BenchState.
  Eigen::VectorXd state(const Params<double>& params, const Window& window, const Eigen::VectorXd& start) const;

  // residual: for each sample of the window, each channel.
  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                const Hidden<S>& hidden = {}) const;

 protected:
  const BenchRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }
  const ActuatorLaws& laws() const { return laws_; }

  // Which way the piston had gone last, by more than the noise.
  double moved_last(const Eigen::VectorXd& extension, int sample) const {
    return detail::moved_last(extension, sample, 6.0 * noise_.extension);
  }

  // Makes what drives the valve in a simulation whose shortest steps are h.
  template <typename S>
  using DriveOf = std::function<std::unique_ptr<ValveDrive<S>>(const Bench<S>& bench, const S& h)>;

  // As simulate(), in these steps.
  template <typename S>
  void simulate_driven(const Params<S>& params, const Window& window, const SampleSteps& steps,
                       const DriveOf<S>& drive_of, const S* start, S* residual, const Hidden<S>& hidden) const;

  // The state in which a window begins.
  template <typename S>
  BenchState<S> begin(const Bench<S>& bench, const Window& window, const S* start, ValveDrive<S>& drive) const;

  // Writes the whitened errors of one sample and returns where the next begin.
  template <typename S>
  S* readings(const BenchRecord& record, int sample, const Bench<S>& bench, const BenchSensors<S>& sensors,
              const BenchState<S>& state, const BenchState<S>& rate, const BenchTerms<S>& t, S* out) const;

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
  std::vector<SampleSteps> steps_;  // of each record
};

template <typename S>
S* BenchPlant::readings(const BenchRecord& record, int sample, const Bench<S>& bench, const BenchSensors<S>& sensors,
                        const BenchState<S>& state, const BenchState<S>& rate, const BenchTerms<S>& t, S* out) const {
  // In the order of signals.def.
  const Eigen::VectorXd* const measured[] = {&record.extension, &record.pressure_lower, &record.pressure_upper,
                                             &record.supply_pressure};
  const double noise[] = {noise_.extension, noise_.pressure_lower, noise_.pressure_upper, noise_.supply_pressure};
  int k = 0;
  sensors.each(bench, state, rate, t, [&](const char*, int, const Sensor<S>& sensor, const S& value, const S& slope) {
    if (measured[k]->size() > 0) {
      int late;
      const S reading = detail::logged(sensor, value, slope, record.step, &late);
      *out++ = detail::reading_error(reading, *measured[k], sample + late, noise[k]);
    }
    ++k;
  });
  return out;
}

template <typename S>
void BenchPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                          const Hidden<S>& hidden) const {
  const BenchRecord& record = of(window.record);
  const SampleSteps& steps = steps_[static_cast<std::size_t>(window.record)];
  const DriveOf<S> recorded = [&](const Bench<S>& bench, const S& h) {
    return std::make_unique<RecordedCommand<S>>(bench.params, bench.laws, record.command, record.ahead, record.hold,
                                                record.step, window, steps.most(), h, hidden.further);
  };
  simulate_driven(params, window, steps, recorded, start, residual, hidden);
}

template <typename S>
BenchState<S> BenchPlant::begin(const Bench<S>& bench, const Window& window, const S* start,
                                ValveDrive<S>& drive) const {
  const Params<S>& p = bench.params;
  const BenchRecord& record = of(window.record);
  const bool warm = temperature_is_state(p, laws_.chamber);
  BenchState<S> state = bench_at_rest(bench, start[0], S(0), S(2e5));
  state.velocity = start[1];
  state.actuator.lower = {start[2], warm ? S(p.air_temperature + start[6]) : p.air_temperature};
  state.actuator.upper = {start[3], warm ? S(p.air_temperature + start[7]) : p.air_temperature};
  state.actuator.supply_pressure = p.supply_line_resistance > S(0) ? start[4] : p.supply_pressure;
  state.actuator.deflection = start[5];
  state.actuator.film = film_at_start(p, record.extension, record.step, window.first, state.extension, state.velocity);
  drive.begin(state.actuator);
  return state;
}

template <typename S>
void BenchPlant::simulate_driven(const Params<S>& params, const Window& window, const SampleSteps& steps,
                                 const DriveOf<S>& drive_of, const S* start, S* residual,
                                 const Hidden<S>& hidden) const {
  const BenchRecord& record = of(window.record);
  const Bench<S> bench = make_bench(in_run(params, record), laws_);
  const Params<S>& p = bench.params;
  const HiddenInputs<S> pushes(hidden, window.samples);
  const S shortest(record.step / steps.most());
  const std::unique_ptr<ValveDrive<S>> driven_by = drive_of(bench, shortest);
  ValveDrive<S>& drive = *driven_by;
  BenchState<S> state = begin(bench, window, start, drive);

  BenchTerms<S> t{};
  const auto rates = [&](double at, const BenchState<S>& y, BenchState<S>& rate) {
    if (derivative<S>(bench, y, {drive.at(at), S(0)}, t, rate) != SMS_OK) {
      rate = BenchState<S>{};  // where it cannot go on it stands still: a search then turns back
    } else if (pushes) {
      rate.velocity += pushes.at(0, at) / p.moving_mass;
      rate.actuator.lower.pressure += pushes.at(1, at) * p.gas_constant * p.air_temperature / t.actuator.lower.volume;
      rate.actuator.upper.pressure += pushes.at(2, at) * p.gas_constant * p.air_temperature / t.actuator.upper.volume;
    }
  };
  BenchSensors<S> sensors(bench, shortest, is_absent(p.backlash) ? 0.0 : moved_last(record.extension, window.first));
  through_window<S>(
      steps, window.first, window.samples, record.step, state,
      [&](const Step& step, const BenchState<S>& y, BenchState<S>& rate) { rates(step.begins(), y, rate); },
      [&](int, double, const BenchState<S>& y, const BenchState<S>& rate) { sensors.follow(bench, y, rate, t); },
      [&](const Step& step, const BenchState<S>& y, BenchState<S>& rate) {
        drive.step_begins(step, y, sensors.leg(), rate);
      },
      [&](int k, const BenchState<S>& y, const BenchState<S>& rate) {
        residual = readings<S>(record, window.first + k, bench, sensors, y, rate, t, residual);
        residual = drive.readings(window.first + k, residual);
      },
      [&](const Step& step, const S& h, BenchState<S>& rate, BenchState<S>& y) {
        const S g = stiff_share<S>() * h;
        const auto slopes = stiffness(bench, y, t);
        const auto end_rate = [&](const BenchState<S>& moved, BenchState<S>& there) {
          rates(step.ends(), moved, there);
          return SMS_OK;
        };
        stiff_step(
            end_rate, [&](BenchState<S>& k1) { solve_stiff(slopes, g, k1); }, h, rate, y);
      },
      [&](const S& time) { sensors.look_every(time); });
}

// Compiled in bench_plant.cpp. What drives the valve is the same code at each scalar, here and in bench_loop.cpp.
#define SMS_BENCH_IS_DRIVEN(S)                                                                                         \
  template void BenchPlant::simulate_driven<S>(const Params<S>&, const Window&, const SampleSteps&, const DriveOf<S>&, \
                                               const S*, S*, const Hidden<S>&) const
extern SMS_BENCH_IS_DRIVEN(double);
extern SMS_BENCH_IS_DRIVEN(ParameterJet);
extern SMS_PLANT_SIMULATES(BenchPlant, double);
extern SMS_PLANT_SIMULATES(BenchPlant, ParameterJet);
extern template class ShootingProblem<BenchPlant>;

}  // namespace estimation
}  // namespace sms
