// What the plants of shooting.hpp share: recorded signals read at any time, readings that are held against them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimation/command_jumps.hpp"
#include "estimation/recorded_signal.hpp"
#include "estimation/sample_steps.hpp"
#include "sms/integrate_stiff.hpp"
#include "sms/sensor.hpp"
#include "sms/valve.hpp"

namespace sms {
namespace estimation {

// What the valve had between two samples of a recorded command.
enum class Hold : int {
  linear,    // straight from one to the next: a signal that was sampled
  previous,  // the last one: what a digital controller holds
  stepped    // straight, and held where it jumps: a controller that is faster than its logger
};

namespace detail {

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

// A reading of a sensor at its truth, as its logger has it at a sample: late by what is left beside whole samples of its
// clock; *late are those.
template <typename S>
S logged(const Sensor<S>& sensor, const S& value, const S& rate, double step, int* late) {
  S rest;
  *late = whole_samples(step, sensor.errors().clock, &rest);
  return sensor.reading(value, rate, rest);
}

// Predicted less measured over the noise, against the reading `late` samples later: there the late clock has this
// sample. Beyond the record, and where the reading is NaN: nothing.
template <typename S>
S reading_error(const S& predicted, const Eigen::VectorXd& measured, Eigen::Index sample, double noise) {
  const bool is_read = sample >= 0 && sample < measured.size() && !std::isnan(measured[sample]);
  return is_read ? S((predicted - S(measured[sample])) * S(1.0 / noise)) : S(0);
}

}  // namespace detail

// In samples, by how much the command of a digital controller lags, in its mean, behind the line through what it
// computes: half of the period for which it holds each value.
template <typename S>
S staircase_lag(const Params<S>& p, double record_step) {
  const S held = p.control_period / S(record_step);
  return S(0.5) * (held < S(1) ? held : S(1));
}

// A recorded command on its way to the valve, `late` samples behind. Times are counted in samples from the record's first.
//
// Where the previous value is held, a step of the integration has the mean of what arrives within it: a jump that a delay
// has put into the middle of a step keeps its size and its time to first order, and the simulation is smooth in the delay.
// So has a step over several samples, whichever way the command goes from one to the next.
//
// A stepped command has its jump where the sample that shows it was taken: a controller acts on the set-point of its own
// time, and what it computed is what is logged then. Straight from the sample before, the valve would move ahead of its
// command by half a sampling period. Where it moved ahead all the same, its jumps say by how much (command_jumps.hpp).
// Between jumps it is a staircase too fine for its logger, whose mean lags behind the line through its samples.
template <typename S>
class RecordedVoltage {
 public:
  // lag: of a stepped command, in samples (staircase_lag). The command has to last.
  RecordedVoltage(const Eigen::VectorXd& command, Hold hold, const S& late, const CommandJumps<S>& jumps = {},
                  const S& lag = S(0))
      : command_(command),
        hold_(hold),
        late_(late),
        jumps_(hold == Hold::linear ? CommandJumps<S>{} : jumps),
        lag_(hold == Hold::stepped ? lag : S(0)) {}

  bool is_held() const { return hold_ == Hold::previous; }

  // A step of the integration begins. Whether the voltage at its beginning is another from now on.
  bool begin_step(double at, const Pace& pace) {
    const bool averaged = averages_;
    const S from = S(at) - late_;
    const bool jumps = hold_ == Hold::stepped && jumps_within(from, pace);
    averages_ = is_held() || jumps || pace.samples > 1;
    if (averages_) {
      mean_ = is_held() && !jumps_.known() ? mean_from(from, pace)
              : is_held() || jumps         ? mean_of_stepped(from, pace)
                                           : mean_of_straight(from, pace.samples);
      if (jumps_.further()) {
        mean_ += jumps_.mean(value_of(from), length_of(pace));
      }
    }
    return averages_ || averaged;
  }
  // V, within that step.
  S at(double at) const { return averages_ ? mean_ : straight(S(at) - late_); }

  // The spool at `first`: it follows the command alone, and is run up over the 50 ms before, in stiff steps of h,
  // `parts` a sample.
  Lag<S> spool(const Params<S>& p, double first, int parts, const S& h) {
    const int run_up = static_cast<int>(0.05 / value_of(h)) + 1;
    const S omega = angular_frequency(p.valve_frequency), g = stiff_share<S>() * h;
    const auto solve = [&](Lag<S>& k) { solve_lag<S>(omega, p.valve_damping_ratio, g, k); };
    const Pace pace{parts, 1};
    begin_step(first - double(run_up) / parts, pace);
    Lag<S> spool{at(first - double(run_up) / parts), S(0)};
    for (int i = -run_up; i < 0; ++i) {
      const double now = first + double(i) / parts;
      begin_step(now, pace);
      const auto end_rate = [&](const Lag<S>& moved, Lag<S>& rate) {
        rate = spool_rate(p, moved, at(now + 1.0 / parts));
        return SMS_OK;
      };
      Lag<S> rate = spool_rate(p, spool, at(now));
      stiff_step(end_rate, solve, h, rate, spool);
    }
    return spool;
  }

 private:
  S held(int sample) const {
    const Eigen::Index last = command_.size() - 1;
    return S(command_[std::min<Eigen::Index>(std::max(sample, 0), last)]);
  }
  // In samples, of a step.
  static double length_of(const Pace& pace) { return double(pace.samples) / pace.parts; }

  // Mean over the step that begins at `from`. A jump at its very beginning belongs to the step before, so that the slope
  // against a delay of zero is that towards a longer one.
  S mean_from(const S& from, const Pace& pace) const {
    const int sample = sample_before(from);
    const S before = (S(sample + 1) - from) * S(pace.parts);  // steps, or samples, until the next one arrives
    if (!(value_of(before) < pace.samples)) {
      return held(sample);
    }
    S sum = before * held(sample) + (S(1) - before) * held(sample + pace.samples);
    for (int k = 1; k < pace.samples; ++k) {
      sum += held(sample + k);
    }
    return pace.samples > 1 ? S(sum * S(1.0 / pace.samples)) : sum;
  }

  // Where it goes straight. From a sample that shows a jump on, the lag does not reach back beyond it.
  S straight(const S& at) const {
    const int sample = static_cast<int>(std::floor(value_of(at)));
    const bool is_new = value_of(at) < sample + value_of(lag_) && detail::jumps(command_, sample - 1);
    return is_new ? held(sample) : detail::command_at<S>(command_, at - lag_);
  }

  // The same over some samples where it goes straight, by the trapezoidal rule.
  S mean_of_straight(const S& from, int samples) const {
    S sum = S(0.5) * (straight(from) + straight(from + S(samples)));
    for (int k = 1; k < samples; ++k) {
      sum += straight(from + S(k));
    }
    return sum * S(1.0 / samples);
  }

  // The sample before which no jump matters to a step from here: one at its very beginning belongs to the step before.
  static int sample_before(const S& from) { return static_cast<int>(std::ceil(value_of(from) - 1e-9)) - 1; }

  bool jumps_within(const S& from, const Pace& pace) const {
    const double end = value_of(from) + length_of(pace);
    for (int k = sample_before(from); k < end - 1e-9; ++k) {
      if (detail::jumps(command_, k)) {
        return true;
      }
    }
    return false;
  }

  // Within one sampling period, that after sample k, where the command is held until it jumps.
  S mean_of_held(int k, const S& begins, const S& ends) const {
    const double ahead = jumps_.ahead(k + 1);
    const S jumps_at(k + 1.0 - ahead);
    if (!(ahead > 0.0) || !(value_of(jumps_at) < value_of(ends))) {
      return held(k);
    }
    if (!(value_of(begins) < value_of(jumps_at))) {
      return held(k + 1);
    }
    return ((jumps_at - begins) * held(k) + (ends - jumps_at) * held(k + 1)) / (ends - begins);
  }

  // The same where it is held, or goes straight and is held between samples that it jumps between.
  S mean_of_stepped(const S& from, const Pace& pace) const {
    const double length = length_of(pace);
    const S end = from + S(length);
    S sum(0), begins = from;
    for (int k = sample_before(from); value_of(begins) < value_of(end); ++k) {
      const S ends = k + 1 < value_of(end) ? S(k + 1) : end;
      const S middle = S(0.5) * (begins + ends);
      const bool is_straight = !is_held() && !detail::jumps(command_, k);
      sum += (ends - begins) * (is_straight ? straight(middle) : mean_of_held(k, begins, ends));
      begins = ends;
    }
    return sum * S(1.0 / length);
  }

  const Eigen::VectorXd& command_;
  Hold hold_;
  S late_;
  CommandJumps<S> jumps_;
  S lag_;
  S mean_{0};
  bool averages_ = false;
};

}  // namespace estimation
}  // namespace sms
