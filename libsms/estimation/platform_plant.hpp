// The rig "platform" as a plant of shooting.hpp: three actuators under one mechanism, the commands, extensions and
// chamber pressures of each measured, the supply and the attitude where there are sensors for them.
//
// The pistons carry the simulation: each is what it is on the bench, and the mechanism couples their accelerations along
// the path on which they were measured (measured_path.hpp). A window starts with what is free: extension, velocity, both
// pressures, the reservoir's pressure and the deflection of the seals, of each actuator.
//
// A parameter may belong to all three legs or to one (leg_params.hpp). The mechanism has no legs: it is made of the
// common parameters.
//
// The commands are the record's, or those of controllers that are simulated with the rest (platform_loop.hpp).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "estimation/film_at_start.hpp"
#include "estimation/hidden_inputs.hpp"
#include "estimation/leg_drives.hpp"
#include "estimation/recorded_command.hpp"
#include "estimation/shooting.hpp"
#include "estimation/through_window.hpp"

namespace sms {
namespace estimation {

// A signal of each leg.
using LegSignals = std::array<Eigen::VectorXd, 3>;

// One record, evenly sampled. Readings as they stand in the record; arrays of one length.
struct PlatformRecord {
  double step = 0.0;  // s
  LegSignals command;
  LegSignals extension;
  LegSignals pressure_lower;
  LegSignals pressure_upper;
  Eigen::VectorXd supply_pressure;  // of the first actuator's reservoir; empty: not measured
  Eigen::VectorXd roll;             // rad; roll and pitch empty: not measured
  Eigen::VectorXd pitch;
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
  LegSignals setpoint = {};                        // m; of a loop that is simulated
  Hold hold = Hold::linear;                        // of the commands, where those are the record's
  LegSignals ahead = {};                           // s: of their jumps (command_jumps.hpp); empty: not known
};

// Standard deviation of one sample.
struct PlatformNoise {
  Vec3<double> extension;
  Vec3<double> pressure_lower;
  Vec3<double> pressure_upper;
  double supply_pressure;
  Eigen::Vector2d attitude;
};

class PlatformPlant {
 public:
  template <typename S>
  using Machine = LegParams<S>;
  static constexpr int kStart = 18;  // three each of x, v, p_a, p_b, p_R, z
  static constexpr int kFelt = 12;   // without droop and deflection
  static constexpr int kCommands = 3;
  static constexpr int kHidden = 9;  // three each of force, N; mass flow into lower and into upper chamber, kg/s

  // std::invalid_argument for arrays of different lengths, numbers that are not finite (a pressure, roll or pitch may be
  // NaN), extensions that are no pose.
  PlatformPlant(std::vector<PlatformRecord> records, const PlatformNoise& noise, const ActuatorLaws& laws,
                MassModel masses, const LongestSteps& longest_step);

  static double start_scale(int k) {
    constexpr double scale[kStart / 3] = {5e-3, 0.3, 2e4, 2e4, 2e4, 1e-3};
    return scale[k / 3];
  }
  int records() const { return static_cast<int>(records_.size()); }
  int samples(int record) const { return static_cast<int>(of(record).extension[0].size()); }
  double step(int record) const { return of(record).step; }
  int channels(int record) const {
    return 9 + (of(record).supply_pressure.size() > 0 ? 1 : 0) + (of(record).roll.size() > 0 ? 2 : 0);
  }
  const Eigen::VectorXd& command(int record, int leg) const {
    return of(record).command[static_cast<std::size_t>(leg)];
  }
  Eigen::VectorXd& ahead(int record, int leg) {
    return records_[static_cast<std::size_t>(record)].ahead[static_cast<std::size_t>(leg)];
  }
  Eigen::VectorXd guess(int record, int first) const;
  // Whether reservoirs or seals begin with something of their own.
  bool feels_all(const LegParams<double>& params, const Window& window) const;

  // residual: for each sample of the window, each channel.
  template <typename S>
  void simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                const Hidden<S>& hidden = {}) const;

 protected:
  const PlatformRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }
  const ActuatorLaws& laws() const { return laws_; }

  // Makes what drives the valves in a simulation whose shortest steps are h.
  template <typename S>
  using DrivesOf = std::function<LegDrives<S>(const LegMachines<S>& machines, const S& h)>;

  // As simulate(), in these steps.
  template <typename S>
  void simulate_driven(const LegParams<S>& params, const Window& window, const SampleSteps& steps,
                       const DrivesOf<S>& drives_of, const S* start, S* residual, const Hidden<S>& hidden) const;

 private:
  // What the position sensors would have read in the window were they good, by what the parameters say of them.
  MeasuredMotion motion(const Params<double> (&leg)[3], const Window& window) const;

  template <typename S>
  S* readings(const PlatformRecord& record, int sample, const PathSensors<S>& sensors, const PathPoint<S>& place,
              const Pistons<S>& state, const Pistons<S>& rate, S* out) const;

  std::vector<PlatformRecord> records_;
  std::vector<MeasuredMotion> measured_;  // one a record, smoothed
  std::vector<int> first_of_;             // samples of the records before
  std::shared_ptr<KnownPaths> paths_ = std::make_shared<KnownPaths>();
  PlatformNoise noise_;
  ActuatorLaws laws_;
  MassModel masses_;
  std::vector<SampleSteps> steps_;  // of each record
};

template <typename S>
S* PlatformPlant::readings(const PlatformRecord& record, int sample, const PathSensors<S>& sensors,
                           const PathPoint<S>& place, const Pistons<S>& state, const Pistons<S>& rate, S* out) const {
  const auto error = [&](const Sensor<S>& sensor, const S& value, const S& slope, const auto& measured, double noise) {
    int late;
    const S reading = detail::logged(sensor, value, slope, record.step, &late);
    return detail::reading_error(reading, measured, sample + late, noise);
  };
  // Signal by signal, in the order of signals.def; of each leg by leg.
  const LegSignals* const measured[] = {&record.extension, &record.pressure_lower, &record.pressure_upper};
  const Vec3<double>* const noise[] = {&noise_.extension, &noise_.pressure_lower, &noise_.pressure_upper};
  for (int i = 0; i < 3; ++i) {
    int k = 0;
    sensors.leg[i].each(seen(state, rate, i), i,
                        [&](const char*, int, const Sensor<S>& sensor, const S& value, const S& slope) {
                          const Eigen::VectorXd& of_leg = (*measured[k])[static_cast<std::size_t>(i)];
                          out[3 * k + i] = error(sensor, value, slope, of_leg, (*noise[k])(i));
                          ++k;
                        });
  }
  out += 9;
  if (record.supply_pressure.size() > 0) {
    const S& pressure = state.leg[0].actuator.supply_pressure;
    *out++ = error(sensors.supply, pressure, rate.leg[0].actuator.supply_pressure, record.supply_pressure,
                   noise_.supply_pressure);
  }
  if (record.roll.size() > 0) {
    const PoseSeen<S> q = pose_seen(place, state);
    *out++ = error(sensors.roll, q.pose(0), q.rate(0), record.roll, noise_.attitude(0));
    *out++ = error(sensors.pitch, q.pose(1), q.rate(1), record.pitch, noise_.attitude(1));
  }
  return out;
}

template <typename S>
void PlatformPlant::simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                             const Hidden<S>& hidden) const {
  const PlatformRecord& record = of(window.record);
  const SampleSteps& steps = steps_[static_cast<std::size_t>(window.record)];
  const DrivesOf<S> recorded = [&](const LegMachines<S>& machines, const S& h) {
    const auto of_leg = [&](int i) {
      return std::make_unique<RecordedCommand<S>>(machines.leg[i], laws_, record.command[static_cast<std::size_t>(i)],
                                                  record.ahead[static_cast<std::size_t>(i)], record.hold, record.step,
                                                  window, steps.most(), h,
                                                  hidden.further == nullptr ? nullptr : hidden.further + i * kJumps);
    };
    return LegDrives<S>{{of_leg(0), of_leg(1), of_leg(2)}};
  };
  simulate_driven(params, window, steps, recorded, start, residual, hidden);
}

// From the numbers of a window's initial state (kStart).
template <typename S>
Pistons<S> pistons_at_start(const LegMachines<S>& machines, const PlatformRecord& record, int first, const S* start) {
  Pistons<S> state;
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    BenchState<S>& leg = state.leg[i];
    leg = {start[i], start[3 + i], actuator_at_rest<S>(p, start[6 + i], start[9 + i])};
    if (p.supply_line_resistance > S(0)) {
      leg.actuator.supply_pressure = start[12 + i];
    }
    leg.actuator.deflection = start[15 + i];
    leg.actuator.film = film_at_start(p, record.extension[static_cast<std::size_t>(i)], record.step, first,
                                      leg.extension, leg.velocity);
  }
  return state;
}

// Which way each leg went last, for a sensor with play.
template <typename S>
Vec3<double> went_before(const LegMachines<S>& machines, const PlatformRecord& record, int first,
                         const PlatformNoise& noise) {
  Vec3<double> went = Vec3<double>::Zero();
  for (int i = 0; i < 3; ++i) {
    if (!is_absent(machines.leg[i].backlash)) {
      went(i) = detail::moved_last(record.extension[static_cast<std::size_t>(i)], first, 6.0 * noise.extension(i));
    }
  }
  return went;
}

// Of three pistons, each by itself.
template <typename S>
struct PistonStiffness {
  ActuatorStiffness<S> leg[3];

  template <typename Mass>
  PistonStiffness(const LegMachines<S>& machines, const ActuatorLaws& laws, const Mass& mass, const PistonTerms<S>& t) {
    for (int i = 0; i < 3; ++i) {
      leg[i] = actuator_stiffness<S>(machines.leg[i], laws, S(mass(i, i)), t.actuator[i]);
    }
  }

  void solve(const S& g, Pistons<S>& y) const {
    for (int i = 0; i < 3; ++i) {
      solve_stiff(leg[i], g, y.leg[i]);
    }
  }
};

template <typename S>
void PlatformPlant::simulate_driven(const LegParams<S>& params, const Window& window, const SampleSteps& steps,
                                    const DrivesOf<S>& drives_of, const S* start, S* residual,
                                    const Hidden<S>& hidden) const {
  const PlatformRecord& record = of(window.record);
  const LegMachines<S> machines = machines_of(params, record.conditions);
  const Params<double> plain[3] = {plain_params(machines.leg[0]), plain_params(machines.leg[1]),
                                   plain_params(machines.leg[2])};
  const MeasuredMotion measured = motion(plain, window);
  const auto known = paths_->of(first_of_[static_cast<std::size_t>(window.record)] + window.first,
                                plain_params(machines.common), masses_, measured);
  const MeasuredPath<S>& path = path_with_slopes(*known, machines.common, masses_, measured);
  const S shortest(record.step / steps.most());
  const HiddenInputs<S> pushes(hidden, window.samples);

  Pistons<S> state = pistons_at_start(machines, record, window.first, start);
  auto drives = drives_of(machines, shortest);
  drives.begin(state);

  PistonTerms<S> t{};
  t.along.setZero();
  t.friction.setZero();
  const auto rates_at = [&](int sample, double part, const Pistons<S>& y, Pistons<S>& rate) {
    S push[kHidden];
    for (int input = 0; pushes && input < kHidden; ++input) {
      push[input] = pushes.at(input, sample + part);
    }
    piston_rates<S>(machines, laws_, place_between<S>(path.points, sample, part), path.leaning, y,
                    drives.at(sample + part), pushes ? push : nullptr, t, rate);
  };
  PathSensors<S> sensors(machines, shortest, went_before(machines, record, window.first, noise_));
  through_window<S>(
      steps, window.first, window.samples, record.step, state,
      [&](const Step& step, const Pistons<S>& y, Pistons<S>& rate) {
        rates_at(step.sample, double(step.part) / step.pace.parts, y, rate);
      },
      [&](int sample, double part, const Pistons<S>& y, const Pistons<S>& rate) {
        sensors.follow(machines, place_between<S>(path.points, sample, part), y, rate, t);
      },
      [&](const Step& step, const Pistons<S>& y, Pistons<S>& rate) { drives.step_begins(step, y, sensors, rate); },
      [&](int k, const Pistons<S>& y, const Pistons<S>& rate) {
        const PathPoint<S> place = place_between<S>(path.points, k, 0.0);
        residual = readings<S>(record, window.first + k, sensors, place, y, rate, residual);
        residual = drives.readings(window.first + k, residual);
      },
      [&](const Step& step, const S& h, Pistons<S>& rate, Pistons<S>& y) {
        const S g = stiff_share<S>() * h;
        const auto& mass = path.points[static_cast<std::size_t>(step.sample)].mass;
        const PistonStiffness<S> slopes(machines, laws_, mass, t);
        const auto solve = [&](Pistons<S>& k1) { slopes.solve(g, k1); };
        const auto end_rate = [&](const Pistons<S>& moved, Pistons<S>& there) {
          const bool last = step.part + 1 == step.pace.parts;
          rates_at(last ? step.sample + step.pace.samples : step.sample,
                   last ? 0.0 : double(step.part + 1) / step.pace.parts, moved, there);
          return SMS_OK;
        };
        stiff_step(end_rate, solve, h, rate, y);
      },
      [&](const S& time) { sensors.look_every(time); });
}

// Compiled in platform_plant.cpp. What drives the valves is the same code at each scalar, here and in platform_loop.cpp.
#define SMS_PLATFORM_IS_DRIVEN(S)                                                                         \
  template void PlatformPlant::simulate_driven<S>(const LegParams<S>&, const Window&, const SampleSteps&, \
                                                  const DrivesOf<S>&, const S*, S*, const Hidden<S>&) const
extern SMS_PLATFORM_IS_DRIVEN(double);
extern SMS_PLATFORM_IS_DRIVEN(ParameterJet);
extern SMS_PLANT_SIMULATES(PlatformPlant, double);
extern SMS_PLANT_SIMULATES(PlatformPlant, ParameterJet);
extern template class ShootingProblem<PlatformPlant>;

}  // namespace estimation
}  // namespace sms
