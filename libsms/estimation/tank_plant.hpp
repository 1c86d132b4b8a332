// The rig "tank" as a plant of shooting.hpp: a vessel behind one port of the valve (tank.hpp), its command and pressure
// measured, its temperature and the supply's pressure where there are sensors.
//
// A window starts with what is free: pressure and temperature of the air, the reservoir's pressure and the thermocouple.
// Without heat the temperature is that of the supplied air, and the thermometer sees that. The spool follows the command
// alone and is run up over the 50 ms before the window.
//
// Where the command rests a step goes over several samples (sample_steps.hpp).
#pragma once

#include "estimation/hidden_inputs.hpp"
#include "estimation/recorded.hpp"
#include "estimation/shooting.hpp"
#include "estimation/through_window.hpp"
#include "sms/plant_sensors.hpp"

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
  Hold hold = Hold::linear;                        // of the command
  ValveLaw valve = ValveLaw::iso_0_4_mpa;          // measured at another supply, a tank follows another table
  Eigen::VectorXd ahead = {};                      // s: of the command's jumps (command_jumps.hpp); empty: not known
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
  static constexpr int kCommands = 1;
  static constexpr int kHidden = 2;  // mass flow into the tank, kg/s; pressure at the head of the supply line, Pa

  // std::invalid_argument for arrays of different lengths or numbers that are not finite; a reading may be NaN.
  TankPlant(std::vector<TankPlantRecord> records, const TankNoise& noise, const ActuatorLaws& laws,
            const LongestSteps& longest_step);

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
  const Eigen::VectorXd& command(int record, int) const { return of(record).command; }
  Eigen::VectorXd& ahead(int record, int) { return records_[static_cast<std::size_t>(record)].ahead; }
  Eigen::VectorXd guess(int record, int first) const;
  static bool feels_all(const Params<double>&, const Window&) { return true; }

  // The whole state where a window begins, in the order of TankState.
  Eigen::VectorXd state(const Params<double>& params, const Window& window, const Eigen::VectorXd& start) const;

  // residual: for each sample of the window, each channel.
  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                const Hidden<S>& hidden = {}) const;

 private:
  const TankPlantRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }

  // Tank and state where a window begins.
  template <typename S>
  Tank<S> tank_of(const Params<S>& params, const TankPlantRecord& record) const;
  template <typename S>
  TankState<S> begin(const Tank<S>& tank, const S* start, const Lag<S>& spool) const;

  // Writes the whitened errors of one sample and returns where the next begin.
  template <typename S>
  S* readings(const TankPlantRecord& record, int sample, const Tank<S>& tank, const TankSensors<S>& sensors,
              const TankState<S>& state, const TankState<S>& rate, const TankTerms<S>& t, S* out) const;

  std::vector<TankPlantRecord> records_;
  TankNoise noise_;
  ActuatorLaws laws_;
  std::vector<SampleSteps> steps_;  // of each record
};

template <typename S>
S* TankPlant::readings(const TankPlantRecord& record, int sample, const Tank<S>& tank, const TankSensors<S>& sensors,
                       const TankState<S>& state, const TankState<S>& rate, const TankTerms<S>& t, S* out) const {
  // In the order of TankSensors.
  const Eigen::VectorXd* const measured[] = {&record.pressure, &record.temperature, &record.supply_pressure};
  const double noise[] = {noise_.pressure, noise_.temperature, noise_.supply_pressure};
  int k = 0;
  sensors.each(tank, state, rate, t, [&](const char*, int, const Sensor<S>& sensor, const S& value, const S& slope) {
    if (measured[k]->size() > 0) {
      int late;
      const S reading = detail::logged(sensor, value, slope, record.step, &late);
      *out++ = detail::reading_error<S>(reading, *measured[k], sample + late, noise[k]);
    }
    ++k;
  });
  return out;
}

template <typename S>
Tank<S> TankPlant::tank_of(const Params<S>& params, const TankPlantRecord& record) const {
  Tank<S> tank{params, laws_};
  tank.laws.valve = record.valve;
  for (const auto& condition : record.conditions) {
    param(tank.params, condition.first) += S(condition.second);
  }
  return tank;
}

template <typename S>
TankState<S> TankPlant::begin(const Tank<S>& tank, const S* start, const Lag<S>& spool) const {
  const Params<S>& p = tank.params;
  TankState<S> state = tank_at_rest<S>(p, start[0]);
  state.gas.temperature = temperature_is_state(p, laws_.chamber) ? start[1] : p.air_temperature;
  state.supply_pressure = p.supply_line_resistance > S(0) ? start[2] : p.supply_pressure;
  state.spool = spool;
  return state;
}

template <typename S>
void TankPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                         const Hidden<S>& hidden) const {
  const TankPlantRecord& record = of(window.record);
  Tank<S> tank = tank_of(params, record);
  const Params<S>& p = tank.params;
  const S head = p.supply_pressure;
  const bool droops = p.supply_line_resistance > S(0);
  const SampleSteps& steps = steps_[static_cast<std::size_t>(window.record)];
  const S shortest(record.step / steps.most());
  const HiddenInputs<S> pushes(hidden, window.samples);
  RecordedVoltage<S> command(record.command, record.hold, delay_to_chamber(p) / S(record.step),
                             {record.command, record.ahead, window.first, window.samples, record.step, hidden.further},
                             staircase_lag(p, record.step));
  TankState<S> state = begin(tank, start, command.spool(p, window.first, steps.most(), shortest));

  TankTerms<S> t{};
  // `at` is counted in samples from the window's first.
  const auto rates = [&](double at, TankState<S>& y, TankState<S>& rate) {
    if (pushes) {
      tank.params.supply_pressure = head + pushes.at(1, at);
      y.supply_pressure = droops ? y.supply_pressure : tank.params.supply_pressure;
    }
    derivative(tank, y, {command.at(window.first + at)}, t, rate);
    if (pushes) {
      rate.gas.pressure += pushes.at(0, at) * p.gas_constant * p.air_temperature / t.space.volume;
    }
  };
  TankSensors<S> sensors(tank, shortest);
  sensors.begin(temperature_is_state(p, laws_.chamber) ? start[3] : p.air_temperature);

  through_window<S>(
      steps, window.first, window.samples, record.step, state,
      [&](const Step& step, TankState<S>& y, TankState<S>& rate) {
        command.begin_step(window.first + step.begins(), step.pace);
        rates(step.begins(), y, rate);
      },
      [&](int, double, const TankState<S>& y, const TankState<S>& rate) { sensors.follow(tank, y, rate, t); },
      [](const Step&, const TankState<S>&, TankState<S>&) {},
      [&](int k, const TankState<S>& y, const TankState<S>& rate) {
        residual = readings<S>(record, window.first + k, tank, sensors, y, rate, t, residual);
      },
      [&](const Step& step, const S& h, TankState<S>& rate, TankState<S>& y) {
        const S g = stiff_share<S>() * h;
        const auto slopes = stiffness(tank, y, t);
        const auto end_rate = [&](TankState<S> moved, TankState<S>& there) {
          rates(step.ends(), moved, there);
          return SMS_OK;
        };
        stiff_step(
            end_rate, [&](TankState<S>& k1) { solve_stiff(slopes, g, k1); }, h, rate, y);
      },
      [&](const S& time) { sensors.look_every(time); });
}

// Compiled in tank_plant.cpp.
extern SMS_PLANT_SIMULATES(TankPlant, double);
extern SMS_PLANT_SIMULATES(TankPlant, ParameterJet);
extern template class ShootingProblem<TankPlant>;

}  // namespace estimation
}  // namespace sms
