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
#include <memory>
#include <utility>
#include <vector>

#include "estimation/leg_drives.hpp"
#include "estimation/recorded_command.hpp"
#include "estimation/shooting.hpp"

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
  static constexpr int kHidden = 9;  // three each of force, N; mass flow into lower and into upper chamber, kg/s

  // std::invalid_argument for arrays of different lengths, numbers that are not finite, extensions that are no pose.
  PlatformPlant(std::vector<PlatformRecord> records, const PlatformNoise& noise, const ActuatorLaws& laws,
                MassModel masses, double longest_step);

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
  Eigen::VectorXd guess(int record, int first) const;
  // Whether reservoirs or seals begin with something of their own.
  bool feels_all(const LegParams<double>& params, const Window& window) const;

  // residual: for each sample of the window, each channel. hidden: kHidden times knots values, or nullptr.
  template <typename S>
  void simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                const S* hidden = nullptr, int knots = 0) const;

 protected:
  const PlatformRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }
  const ActuatorLaws& laws() const { return laws_; }
  double longest_step() const { return longest_step_; }

  // As simulate(), in `steps` steps a sample; drives_of(LegMachines, h) makes what drives the valves (LegDrives).
  template <typename S, typename DrivesOf>
  void simulate_driven(const LegParams<S>& params, const Window& window, int steps, const DrivesOf& drives_of,
                       const S* start, S* residual, const S* hidden, int knots) const;

 private:
  // What the position sensors would have read in the window were they good, by what the parameters say of them.
  MeasuredMotion motion(const Params<double> (&leg)[3], const Window& window) const;

  template <typename S>
  S* readings(const LegMachines<S>& machines, const PlatformRecord& record, int sample,
              const PlatformSensors<S>& sensors, const PathPoint<S>& place, const Pistons<S>& state,
              const Pistons<S>& rate, S* out) const;

  std::vector<PlatformRecord> records_;
  std::vector<MeasuredMotion> measured_;  // one a record, smoothed
  std::vector<int> first_of_;             // samples of the records before
  std::shared_ptr<KnownPaths> paths_ = std::make_shared<KnownPaths>();
  PlatformNoise noise_;
  ActuatorLaws laws_;
  MassModel masses_;
  double longest_step_;
};

template <typename S>
S* PlatformPlant::readings(const LegMachines<S>& machines, const PlatformRecord& record, int sample,
                           const PlatformSensors<S>& sensors, const PathPoint<S>& place, const Pistons<S>& state,
                           const Pistons<S>& rate, S* out) const {
  const auto error = [sample](const S& predicted, const auto& measured, int samples, double noise) {
    return detail::reading_error(predicted, measured, sample + samples, noise);
  };
  S rest;
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    const int late = detail::whole_samples(record.step, p.clock_skew_extension, &rest);
    *out++ = error(sensors.leg[i].extension_reading(p, state.leg[i], rest),
                   record.extension[static_cast<std::size_t>(i)], late, noise_.extension(i));
  }
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    const int late = detail::whole_samples(record.step, p.clock_skew_chamber_pressure, &rest);
    *out++ = error(sensors.leg[i].lower_reading(p, state.leg[i], rate.leg[i], rest),
                   record.pressure_lower[static_cast<std::size_t>(i)], late, noise_.pressure_lower(i));
  }
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    const int late = detail::whole_samples(record.step, p.clock_skew_chamber_pressure, &rest);
    *out++ = error(sensors.leg[i].upper_reading(p, state.leg[i], rate.leg[i], rest),
                   record.pressure_upper[static_cast<std::size_t>(i)], late, noise_.pressure_upper(i));
  }
  const Params<S>& p = machines.common;
  if (record.supply_pressure.size() > 0) {
    *out++ = error(sensor_reading(state.leg[0].actuator.supply_pressure, p.sensor_gain_supply_pressure,
                                  p.sensor_offset_supply_pressure),
                   record.supply_pressure, 0, noise_.supply_pressure);
  }
  if (record.roll.size() > 0) {
    const PoseSeen<S> q = pose_seen(place, state);
    const int late = detail::whole_samples(record.step, p.clock_skew_attitude, &rest);
    const S roll = sensors.roll.at(q.pose(0), q.rate(0), rest), pitch = sensors.pitch.at(q.pose(1), q.rate(1), rest);
    *out++ =
        error(sensor_reading(roll, p.sensor_gain_roll, p.sensor_offset_roll), record.roll, late, noise_.attitude(0));
    *out++ = error(sensor_reading(pitch, p.sensor_gain_pitch, p.sensor_offset_pitch), record.pitch, late,
                   noise_.attitude(1));
  }
  return out;
}

template <typename S>
void PlatformPlant::simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                             const S* hidden, int knots) const {
  const PlatformRecord& record = of(window.record);
  const int steps = detail::steps_over(record.step, longest_step_);
  const auto recorded = [&](const LegMachines<S>& machines, const S& h) {
    const auto of_leg = [&](int i) {
      return RecordedCommand<S>(machines.leg[i], record.command[static_cast<std::size_t>(i)], record.step, window.first,
                                steps, h);
    };
    return LegDrives<S, RecordedCommand<S>>{{of_leg(0), of_leg(1), of_leg(2)}};
  };
  simulate_driven(params, window, steps, recorded, start, residual, hidden, knots);
}

template <typename S, typename DrivesOf>
void PlatformPlant::simulate_driven(const LegParams<S>& params, const Window& window, int steps,
                                    const DrivesOf& drives_of, const S* start, S* residual, const S* hidden,
                                    int knots) const {
  const PlatformRecord& record = of(window.record);
  const LegMachines<S> machines = machines_of(params, record.conditions);
  const Params<double> plain[3] = {plain_params(machines.leg[0]), plain_params(machines.leg[1]),
                                   plain_params(machines.leg[2])};
  const MeasuredMotion measured = motion(plain, window);
  const auto known = paths_->of(first_of_[static_cast<std::size_t>(window.record)] + window.first,
                                plain_params(machines.common), masses_, measured);
  const MeasuredPath<S>& path = path_with_slopes(*known, machines.common, masses_, measured);
  const S h(record.step / steps);
  const S g = S(detail::kStiffShare) * h;

  Pistons<S> state;
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    BenchState<S>& leg = state.leg[i];
    leg = {start[i], start[3 + i], actuator_at_rest<S>(p, start[6 + i], start[9 + i])};
    if (p.supply_line_resistance > S(0)) {
      leg.actuator.supply_pressure = start[12 + i];
    }
    leg.actuator.deflection = start[15 + i];
  }
  auto drives = drives_of(machines, h);
  drives.begin(state);

  PistonTerms<S> t;
  t.along.setZero();
  Pistons<S> k1, k2, moved;
  Vec3<S> film = speeds_of(state);
  // The lubricant's films when the pistons have come to `then`, a step after `state`.
  const auto films_at = [&](const Vec3<S>& then) {
    Vec3<S> late_films = then;
    for (int i = 0; i < 3; ++i) {
      const S& lag = machines.leg[i].friction_lag;
      if (!is_absent(lag)) {
        late_films(i) = detail::lagging<S>(film(i), state.leg[i].velocity, then(i), lag, h);
      }
    }
    return late_films;
  };
  const auto rates_at = [&](int sample, double part, const Pistons<S>& y, const Vec3<S>& films, Pistons<S>& rate) {
    S push[kHidden];
    if (hidden != nullptr) {
      for (int input = 0; input < kHidden; ++input) {
        push[input] = detail::hidden_at(hidden + input * knots, knots, window.samples, sample + part);
      }
    }
    piston_rates<S>(machines, laws_, place_between<S>(path.points, sample, part), path.leaning, y,
                    drives.at(sample + part), films, hidden != nullptr ? push : nullptr, t, rate);
  };
  Vec3<double> went = Vec3<double>::Zero();
  for (int i = 0; i < 3; ++i) {
    if (!is_absent(machines.leg[i].backlash)) {
      went(i) =
          detail::moved_last(record.extension[static_cast<std::size_t>(i)], window.first, 6.0 * noise_.extension(i));
    }
  }
  PlatformSensors<S> sensors(machines, h, went);
  const auto x = vector_of(state);
  for (int k = 0;; ++k) {
    rates_at(k, 0.0, state, film, k1);
    const PathPoint<S>& place = path.points[static_cast<std::size_t>(k)];
    sensors.follow(machines, place, state, k1, t);
    drives.step_begins(k, 0, state, sensors, k1);
    residual = readings<S>(machines, record, window.first + k, sensors, place, state, k1, residual);
    residual = drives.readings(window.first + k, residual);
    if (k == window.samples - 1) {
      return;
    }
    for (int step = 0; step < steps; ++step) {
      const double begin = double(step) / steps;
      if (step > 0) {
        rates_at(k, begin, state, film, k1);
        sensors.follow(machines, place_between<S>(path.points, k, begin), state, k1, t);
        drives.step_begins(k, step, state, sensors, k1);
      }
      detail::ActuatorStiffness<S> stiff[3];
      for (int i = 0; i < 3; ++i) {
        stiff[i] = detail::actuator_stiffness<S>(machines.leg[i], laws_.friction, S(place.mass(i, i)), t.actuator[i]);
        detail::solve_stiff(stiff[i], g, k1.leg[i]);
      }
      vector_of(moved) = x + h * vector_of(k1);
      const bool last = step + 1 == steps;
      rates_at(last ? k + 1 : k, last ? 0.0 : double(step + 1) / steps, moved, films_at(speeds_of(moved)), k2);
      vector_of(k2) -= S(2) * vector_of(k1);
      for (int i = 0; i < 3; ++i) {
        detail::solve_stiff(stiff[i], g, k2.leg[i]);
      }
      vector_of(moved) = x + (S(0.5) * h) * (S(3) * vector_of(k1) + vector_of(k2));
      film = films_at(speeds_of(moved));
      state = moved;
    }
  }
}

}  // namespace estimation
}  // namespace sms
