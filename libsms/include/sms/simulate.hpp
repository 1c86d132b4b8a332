// A plant under sampled control: one period of the controller at a time.
//
//   extension -> anti-alias filter -> converter -> position loop -> pulse width -> dead time -> plant, for one period
//
// The command is held over a period and reaches the valve command_delay (and what the tube delays) later, which may fall
// into the middle of a period: the integration stops there, so that a jump is never inside a step. The electronics can
// be left out as a whole; then the controller sees the extension and the valve its command.
//
// The same loop serves one actuator on the bench and three under the platform, and, open, the tank of the flow test. It
// allocates nothing.
#pragma once

#include "sms/bench.hpp"
#include "sms/electronics.hpp"
#include "sms/integrate_adaptive.hpp"
#include "sms/platform.hpp"
#include "sms/position_loop.hpp"
#include "sms/tank.hpp"

namespace sms {

// A plant as the integrator wants it.
template <typename Plant>
struct PlantSystem {
  static constexpr int switch_count = Plant::legs * actuator_switch_count();
  const Plant& plant;
  typename Plant::Input input;
  typename Plant::Terms terms;

  sms_status operator()(const typename Plant::State& state, typename Plant::State& rate) {
    return derivative(plant, state, input, terms, rate);
  }
  void switches(const typename Plant::State& state, typename Plant::Scalar (&value)[switch_count]) const {
    sms::switches(plant, state, terms, value);
  }
};

// Between one extension and its controller.
template <typename S>
struct ExtensionSensor {
  S extension;  // of the last sample, m
  S filtered;   // behind the anti-alias filter, m
};

template <typename S>
struct Electronics {
  bool present;
  Converter<S> position;
  Converter<S> command;
  S corner;  // of the anti-alias filter, rad/s
  S weight;  // of its input over one period
};

template <typename S>
Electronics<S> make_electronics(const Params<S>& p, bool present) {
  const S corner = angular_frequency(p.anti_alias_frequency);
  return {present, position_converter(p), command_converter(p), corner, low_pass_weight(corner, p.control_period)};
}

constexpr int longest_delay() { return 256; }  // periods

template <typename Plant>
struct Simulation {
  using S = typename Plant::Scalar;
  using State = typename Plant::State;
  static constexpr int legs = Plant::legs;

  explicit Simulation(const Plant& of) : plant(of), system{plant, {}, {}} {}
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Plant plant;
  PlantSystem<Plant> system;
  StepControl<State> control;
  Run<State> run;
  S period;
  S fixed_step;  // 0: adaptive
  PositionLoopSettings<S> settings[legs];
  Electronics<S> electronics;
  int delay_periods;
  S delay_rest;  // s, less than a period

  PositionLoop<S> loop[legs];
  ExtensionSensor<S> sensor[legs];
  DelayLine<S, longest_delay()> line[legs];
  unsigned long sample;
  S measured[legs];  // by the controller, m
  S command[legs];   // of the controller, V
};

// Ready at a state; everything around it at rest. params: of the controller and its electronics.
template <typename Plant>
sms_status begin_simulation(const typename Plant::State& state, const typename Plant::Input& input,
                            const Params<typename Plant::Scalar>& params, PositionControl kind, bool compensated,
                            bool electronics, const typename Plant::Scalar& tolerance, Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  s.system.input = input;
  prepare(s.plant, s.system.terms);
  s.control = step_control(state_scale(s.plant), tolerance);
  s.period = params.control_period;
  s.fixed_step = S(0);
  s.electronics = make_electronics(params, electronics);
  const S delay = params.command_delay + tube_delay(params);
  s.delay_periods = static_cast<int>(delay / s.period);
  s.delay_rest = delay - S(s.delay_periods) * s.period;
  s.sample = 0;
  const sms_status status = begin_run(s.system, S(0), state, s.run);
  if (status != SMS_OK || s.delay_periods >= longest_delay()) {
    return status == SMS_OK ? SMS_OUT_OF_RANGE : status;
  }
  for (int i = 0; i < Plant::legs; ++i) {
    const S extension = extension_of(state, s.system.terms, i);
    s.settings[i] = position_loop_settings(params, kind, compensated);
    s.loop[i] = position_loop_at(extension);
    s.sensor[i] = {extension, extension};
    s.line[i] = delay_line_at<longest_delay()>(params.command_offset);
    s.measured[i] = extension;
    s.command[i] = params.command_offset;
    set_command(s.system.input, i, params.command_offset);
  }
  return SMS_OK;
}

// What the controller takes for the extension of one leg, m; noise in m, before the converter.
template <typename Plant>
typename Plant::Scalar measure(Simulation<Plant>& s, const Params<typename Plant::Scalar>& params, int leg,
                               const typename Plant::Scalar& noise) {
  using S = typename Plant::Scalar;
  const S extension = extension_of(s.run.state, s.system.terms, leg);
  if (!s.electronics.present) {
    return extension + noise;
  }
  ExtensionSensor<S>& sensor = s.sensor[leg];
  sensor.filtered = low_pass_ramp_step(s.electronics.corner, s.period, s.electronics.weight, sensor.filtered,
                                       sensor.extension, extension);
  sensor.extension = extension;
  return sampled_extension<S>(params, s.electronics.position, sensor.filtered + noise);
}

// To `end` with the present input.
template <typename Plant>
sms_status integrate_to(const typename Plant::Scalar& end, Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  using std::ceil;
  if (!(end > s.run.time)) {
    return SMS_OK;
  }
  renew_command(s.plant, s.run.state, s.system.input, s.run.rate);
  sms_status status = SMS_OK;
  if (s.fixed_step > S(0)) {
    const int steps = static_cast<int>(ceil((end - s.run.time) / s.fixed_step * (S(1) - S(1e-6))));
    const S h = (end - s.run.time) / S(steps);
    const auto f = [&s](const S&, const typename Plant::State& state, typename Plant::State& rate) {
      return s.system(state, rate);
    };
    for (int i = 0; i < steps && status == SMS_OK; ++i) {
      status = runge_kutta_step(f, s.run.time, h, s.run.state);
    }
    s.run.evaluations += 4ul * static_cast<unsigned long>(steps) + 1;
    s.run.time = status == SMS_OK ? end : s.run.time;
    return status == SMS_OK ? s.system(s.run.state, s.run.rate) : status;
  }
  while (status == SMS_OK && s.run.time < end) {
    status = adaptive_step(s.system, s.control, end, s.run);
  }
  return status;
}

// The controller takes its sample. setpoint: one a leg, m or, in an open loop, V; noise of the measurement likewise, m.
template <typename Plant>
sms_status take_sample(const Params<typename Plant::Scalar>& params, const typename Plant::Scalar* setpoint,
                       const typename Plant::Scalar* noise, Simulation<Plant>& s) {
  for (int i = 0; i < Plant::legs; ++i) {
    if (!is_finite(setpoint[i]) || !is_finite(noise[i])) {
      return SMS_NOT_A_NUMBER;
    }
  }
  for (int i = 0; i < Plant::legs; ++i) {
    s.measured[i] = measure(s, params, i, noise[i]);
    s.command[i] = position_loop_step(s.settings[i], s.loop[i], setpoint[i], s.measured[i]);
  }
  return SMS_OK;
}

// The plant runs to the next sample; after take_sample(). On any but SMS_OK it stands where it could still be computed.
template <typename Plant>
sms_status run_period(Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  S next[Plant::legs];
  for (int i = 0; i < Plant::legs; ++i) {
    const S sent = s.electronics.present ? pulse_width_voltage(s.electronics.command, s.command[i]) : s.command[i];
    next[i] = delay_line_step(s.line[i], sent, s.delay_periods);
  }
  const S begin = S(s.sample) * s.period;
  sms_status status = s.delay_rest > S(0) ? integrate_to<Plant>(begin + s.delay_rest, s) : SMS_OK;
  for (int i = 0; i < Plant::legs; ++i) {
    set_command(s.system.input, i, next[i]);
  }
  status = status == SMS_OK ? integrate_to<Plant>(S(s.sample + 1) * s.period, s) : status;
  s.sample += status == SMS_OK ? 1ul : 0ul;
  return status;
}

}  // namespace sms
