// The position controller of one actuator, simulated with the machine: the same one that the firmware runs
// (position_loop.hpp).
//
//   set-point, recorded ----------------------------v
//   extension -> sensor, with its errors -> filter -> controller, each T_s -> held -> command_delay -> valve
//
// Before the window the controller is fed with the record, half a second long: filters and differentiators are then
// those of the machine, and so are the commands that are still on their way. One number cannot be had from that, what an
// integral holds; it is part of the window's initial state.
//
// The record's first sample is one of the controller's, and of its period and the record's step one is a whole multiple of
// the other. The command is held over a period. A step of the integration has the mean of what arrives at the valve
// within it: a jump that a delay has put into the middle of a step keeps its size and its time to first order, and the
// simulation is smooth in the delay. Converters are left out: their steps are noise here.
//
// Where the command was recorded, the controller is fed with the record within the window as well, beside the simulation:
// given the readings, the recorded command depends on the controller alone.
//
// A controller reads its own converter, the record holds what a logger wrote, perhaps by a late clock (sensor.hpp): what the
// controller had at t stands in the record at t + clock.
#pragma once

#include "estimation/hidden_inputs.hpp"
#include "estimation/recorded_command.hpp"
#include "estimation/shooting.hpp"
#include "sms/position_loop.hpp"
#include "sms/tube.hpp"

namespace sms {
namespace estimation {

// What of a controller is no parameter.
struct ControlLaw {
  PositionControl control = PositionControl::pid;
  bool compensated = true;   // steps over the dead band
  bool electronics = false;  // anti-alias filter in front of it, filter of the pulse width behind it
};

// One controller behind its filter, sample by sample.
template <typename S>
class SampledController {
 public:
  SampledController(const Params<S>& p, const ControlLaw& law)
      : settings_(position_loop_settings(p, law.control, law.compensated)),
        filters_(law.electronics),
        corner_(angular_frequency(p.anti_alias_frequency)),
        weight_(low_pass_weight<S>(corner_, p.control_period)) {}

  // Ready at a first reading, without a jump to come; integral in V.
  void begin(const S& setpoint, const S& reading, const S& integral) {
    loop_ = position_loop_at<S>(reading);
    loop_.pid.integral = integral;
    loop_.pid.change.input = setpoint - reading;
    reading_ = filtered_ = reading;
  }
  // V
  S sample(const S& setpoint, const S& reading) {
    if (filters_) {
      filtered_ = low_pass_ramp_step<S>(corner_, settings_.pid.period, weight_, filtered_, reading_, reading);
      reading_ = reading;
    }
    return position_loop_step<S>(settings_, loop_, setpoint, filters_ ? filtered_ : reading);
  }
  const S& integral() const { return loop_.pid.integral; }

 private:
  PositionLoopSettings<S> settings_;
  bool filters_;
  S corner_, weight_;
  PositionLoop<S> loop_{};
  S reading_{0}, filtered_{0};
};

// How the controller's samples lie among the steps of the integration.
struct ControlGrid {
  int steps;  // of the integration, a sample of the record
  int every;  // such steps, a period of the controller

  // The first sample of the controller from which it is fed with the record, for a window from `first` on.
  int begins(int first, double record_step) const {
    constexpr double kRunUp = 0.5;  // s
    const int from = first * steps - static_cast<int>(kRunUp / record_step * steps);
    return std::max(0, (from + every - 1) / every);
  }
};

// longest_step: of the integration, s.
ControlGrid control_grid(double record_step, double period, double longest_step);

// What was recorded of one actuator's loop, evenly sampled. The signals have to last.
struct ControlRecord {
  double step;                       // s
  const Eigen::VectorXd& setpoint;   // m
  const Eigen::VectorXd& extension;  // as read
  const Eigen::VectorXd& command;    // V; empty: not measured
};

// What a controller had for the extension at a time counted in samples; `clock` is that of the extension's logger, s.
template <typename S>
S reading_of_controller(const ControlRecord& record, double at, const S& clock) {
  return detail::command_at<S>(record.extension, S(at) + clock / S(record.step));
}

// What the integral of a controller holds before each of its samples, fed with the record from zero on, V.
Eigen::VectorXd integral_along(const ControlRecord& record, const ControlLaw& law, const Params<double>& p);

// std::invalid_argument for a set-point of another length than the extension, with a value that is not finite, or a
// period of the controller that does not fit the record's step. name: of the record, in messages.
void check_loop(const std::string& name, const ControlRecord& record, double period);

template <typename S>
class SimulatedController final : public ValveDrive<S> {
 public:
  // integral: of the controller where it begins to be fed with the record, V. hidden: a voltage at the controller's
  // output, if any. noise: of the recorded command, V.
  // The parameters have to last.
  SimulatedController(const Params<S>& p, const ActuatorLaws& laws, const ControlRecord& record, const Window& window,
                      const ControlLaw& law, const ControlGrid& grid, const S& h, const S& integral,
                      const HiddenInputs<S>& hidden, double noise)
      : p_(p),
        laws_(laws),
        record_(record),
        window_(window),
        grid_(grid),
        h_(h),
        late_(delay_to_chamber(p) / h),
        clock_(extension_sensor(p).clock),
        hidden_(hidden),
        noise_(noise),
        begins_(grid.begins(window.first, record.step)),
        simulated_(p, law),
        fed_(p, law),
        by_record_(p.command_offset) {
    simulated_.begin(setpoint(begins_), reading(begins_), integral);
    for (int j = begins_; j * grid_.every < window.first * grid_.steps; ++j) {
      sent_.push_back(by_record_ = simulated_.sample(setpoint(j), reading(j)));
    }
    fed_ = simulated_;
  }

  // Spool and drive where the window begins: they follow the command alone, and are run up over the 50 ms before, in
  // stiff steps.
  void begin(ActuatorState<S>& a) override {
    const int first = window_.first * grid_.steps;
    const int run_up = std::min(first, static_cast<int>(0.05 / value_of(h_)) + 1);
    const DriveStiffness<S> slopes = drive_stiffness(p_, laws_.drive);
    const S g = stiff_share<S>() * h_;
    const auto solve = [&](ActuatorState<S>& rate) { solve_drive(slopes, g, rate); };
    const auto rates = [&](const ActuatorState<S>& at, ActuatorState<S>& rate) {
      rate = ActuatorState<S>{};
      drive_rates(p_, laws_, at, mean_, rate);
      return SMS_OK;
    };
    mean_ = run_up > 0 ? arriving(first - run_up) : p_.command_offset;
    a.spool = a.drive = {mean_, S(0)};
    for (int q = first - run_up; q < first; ++q) {
      mean_ = arriving(q);
      ActuatorState<S> rate;
      rates(a, rate);
      stiff_step(rates, solve, h_, rate, a);
    }
  }

  // V at the valve in the present step.
  S at(double) const override { return mean_; }

  // A step of the grid begins at state y: the controller takes its sample if it is time.
  void step_begins(const Step& step, const BenchState<S>& y, const ActuatorSensors<S>& sensors,
                   BenchState<S>& rate) override {
    const int q = (window_.first + step.sample) * grid_.steps + step.part;
    if (hidden_) {
      pushed_ = hidden_.at(0, step.begins());
    }
    if (q % grid_.every == 0) {
      const int j = q / grid_.every;
      sent_.push_back(simulated_.sample(setpoint(j), sensors.extension_reading(y.velocity)));
      by_record_ = fed_.sample(setpoint(j), reading(j));
    }
    mean_ = arriving(q) + pushed_;
    drive_rates(p_, laws_, y.actuator, mean_, rate.actuator);
  }

  // What the controller makes of the recorded readings against the recorded command, over its noise. Where its reading is
  // beyond the record: nothing.
  S* readings(int sample, S* out) const override {
    if (record_.command.size() > 0) {
      const double read_at = sample + value_of(clock_) / record_.step;
      const bool is_read = !(read_at < 0.0) && !(read_at > static_cast<double>(record_.extension.size() - 1));
      *out++ = is_read ? detail::reading_error<S>(by_record_ + pushed_, record_.command, sample, noise_) : S(0);
    }
    return out;
  }

 private:
  // Of sample j of the controller, counted in samples of the record.
  double time_of(int j) const { return double(j) * grid_.every / grid_.steps; }
  S setpoint(int j) const { return S(detail::command_at<double>(record_.setpoint, time_of(j))); }
  S reading(int j) const { return reading_of_controller(record_, time_of(j), clock_); }

  // Of sample j; before the record, and before the controller is fed: the command at rest.
  S sent(int j) const { return j < begins_ ? p_.command_offset : sent_[static_cast<std::size_t>(j - begins_)]; }

  // Mean over the step q of the integration, counted from the record's first, of what arrives at the valve: on the way
  // are late_ steps. A jump at the very beginning of a step belongs to the step before, so that the slope against a
  // delay of zero is that towards a longer one.
  S arriving(int q) const {
    using std::ceil;
    const S from = S(q) - late_;
    const int j = static_cast<int>(ceil(value_of(from) / grid_.every)) - 1;
    const S before = S((j + 1) * grid_.every) - from;  // steps until the next command arrives
    return before < S(1) ? before * sent(j) + (S(1) - before) * sent(j + 1) : sent(j);
  }

  const Params<S>& p_;
  ActuatorLaws laws_;
  ControlRecord record_;
  const Window& window_;
  ControlGrid grid_;
  S h_, late_, clock_;
  HiddenInputs<S> hidden_;
  double noise_;
  int begins_;
  SampledController<S> simulated_, fed_;
  S by_record_;          // V: the fed controller's output
  S pushed_{0};          // V: hidden
  S mean_{0};            // V at the valve in the present step
  std::vector<S> sent_;  // V: the simulated controller's output from sample begins_ on
};

}  // namespace estimation
}  // namespace sms
