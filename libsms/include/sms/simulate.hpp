// A plant under sampled control: one period of the controller at a time.
//
//   sensor -> anti-alias filter -> converter -> position loop -> pulse width -> dead time -> plant, for one period
//
// The command is held over a period and reaches its valve command_delay (and what its tube delays) later, which may fall
// into the middle of a period: the integration stops there, so that a jump is never inside a step. The electronics can
// be left out as a whole; then the controller sees what the position sensor says (plant_sensors.hpp) and the valve its
// command.
//
// The same loop serves one actuator on the bench and three under the platform, and, open, the tank of the flow test. It
// allocates nothing.
#pragma once

#include "sms/bench.hpp"
#include "sms/electronics.hpp"
#include "sms/integrate_adaptive.hpp"
#include "sms/integrate_stiff.hpp"
#include "sms/plant_sensors.hpp"
#include "sms/position_loop.hpp"

namespace sms {

// What of a plant changes slowly: of the platform its mechanism.
template <typename Plant>
struct SlowTermsOf {
  using Type = NoSlowTerms;
  static Type of(const typename Plant::Terms&) { return {}; }
};

template <typename S>
struct SlowTermsOf<Platform<S>> {
  using Type = MechanismAtPistons<S>;
  static const Type& of(const PlatformTerms<S>& t) { return t.at_pistons; }
};

// A plant as the integrator wants it.
template <typename Plant>
struct PlantSystem {
  using Slow = typename SlowTermsOf<Plant>::Type;
  static constexpr int switch_count = Plant::legs * actuator_switch_count();
  const Plant& plant;
  typename Plant::Input input;
  typename Plant::Terms terms;

  sms_status operator()(const typename Plant::State& state, typename Plant::State& rate) {
    return derivative(plant, state, input, terms, rate);
  }
  sms_status operator()(const typename Plant::State& state, Slow& slow, typename Plant::State& rate) {
    const sms_status status = (*this)(state, rate);
    slow = SlowTermsOf<Plant>::of(terms);
    return status;
  }
  sms_status near(const typename Plant::State& state, const Slow& slow, typename Plant::State& rate) {
    return derivative_near(plant, state, input, slow, terms, rate);
  }
  void switches(const typename Plant::State& state, typename Plant::Scalar (&value)[switch_count]) const {
    sms::switches(plant, state, terms, value);
  }
};

// Between a position sensor and its controller.
template <typename S>
struct AntiAlias {
  S reading;   // of the last sample, m
  S filtered;  // m
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

// Parameters of one of its actuators, or of the tank.
template <typename Plant>
const Params<typename Plant::Scalar>& params_of(const Plant& plant, int) {
  return plant.params;
}

template <typename S>
const Params<S>& params_of(const Platform<S>& platform, int leg) {
  return platform.params[leg];
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
  Run<State, typename PlantSystem<Plant>::Slow> run;
  S period;
  S fixed_step;  // 0: adaptive
  bool stiff;    // fixed steps are those of integrate_stiff.hpp, not of Runge and Kutta
  PositionLoopSettings<S> settings[legs];
  Electronics<S> electronics;
  int delay_periods[legs];  // of each command on its way to the valve
  S delay_rest[legs];       // s, less than a period

  typename SensorsOf<Plant>::Type sensors;
  PositionLoop<S> loop[legs];
  AntiAlias<S> filter[legs];
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
  s.stiff = false;
  s.sensors = typename SensorsOf<Plant>::Type(s.plant, s.period);
  s.electronics = make_electronics(params, electronics);
  s.sample = 0;
  sms_status status = begin_run(s.system, S(0), state, s.run);
  for (int i = 0; i < Plant::legs; ++i) {
    const Params<S>& of_leg = params_of(s.plant, i);
    const S delay = delay_to_chamber(of_leg);
    s.delay_periods[i] = static_cast<int>(delay / s.period);
    s.delay_rest[i] = delay - S(s.delay_periods[i]) * s.period;
    status = status == SMS_OK && s.delay_periods[i] >= longest_delay() ? SMS_OUT_OF_RANGE : status;
  }
  if (status != SMS_OK) {
    return status;
  }
  typename SensorsOf<Plant>::Type first = s.sensors;  // the first sample looks for itself
  first.follow(s.plant, s.run.state, s.run.rate, s.system.terms);
  for (int i = 0; i < Plant::legs; ++i) {
    const S reading = first.extension_reading(state, s.system.terms, i);
    s.settings[i] = position_loop_settings(params, kind, compensated);
    s.loop[i] = position_loop_at(reading);
    s.filter[i] = {reading, reading};
    s.line[i] = delay_line_at<longest_delay()>(params.command_offset);
    s.measured[i] = reading;
    s.command[i] = params.command_offset;
    set_command(s.system.input, i, params.command_offset);
  }
  return SMS_OK;
}

// The sensors look at the plant, once a period, before anything is measured.
template <typename Plant>
void look(Simulation<Plant>& s) {
  s.sensors.follow(s.plant, s.run.state, s.run.rate, s.system.terms);
}

// What the controller takes for the extension of one leg, m; noise in m, before the converter. After look().
template <typename Plant>
typename Plant::Scalar measure(Simulation<Plant>& s, const Params<typename Plant::Scalar>& params, int leg,
                               const typename Plant::Scalar& noise) {
  using S = typename Plant::Scalar;
  const S reading = s.sensors.extension_reading(s.run.state, s.system.terms, leg);
  if (!s.electronics.present) {
    return reading + noise;
  }
  AntiAlias<S>& filter = s.filter[leg];
  filter.filtered = low_pass_ramp_step(s.electronics.corner, s.period, s.electronics.weight, filter.filtered,
                                       filter.reading, reading);
  filter.reading = reading;
  return sampled_extension<S>(params, s.electronics.position, filter.filtered + noise);
}

// So many stiff steps of size h. The run's rate is that at its state, before and after.
template <typename Plant>
sms_status stiff_steps(int steps, const typename Plant::Scalar& h, Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  using State = typename Plant::State;
  const S g = stiff_share<S>() * h;
  for (int i = 0; i < steps; ++i) {
    const auto slopes = stiffness(s.plant, s.run.state, s.system.terms);
    const auto solve = [&slopes, &g](State& rate) { solve_stiff(slopes, g, rate); };
    const auto end_rate = [&s](const State& state, State& rate) { return s.system(state, rate); };
    sms_status status = stiff_step(end_rate, solve, h, s.run.rate, s.run.state);
    if (status == SMS_OK) {
      status = s.system(s.run.state, s.run.rate);
    }
    if (status != SMS_OK) {
      return status;
    }
  }
  s.run.evaluations += 2ul * static_cast<unsigned long>(steps);
  return SMS_OK;
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
    if (s.stiff) {
      status = stiff_steps(steps, h, s);
      s.run.time = status == SMS_OK ? end : s.run.time;
      return status;
    }
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
  look(s);
  for (int i = 0; i < Plant::legs; ++i) {
    s.measured[i] = measure(s, params, i, noise[i]);
    s.command[i] = position_loop_step(s.settings[i], s.loop[i], setpoint[i], s.measured[i]);
  }
  return SMS_OK;
}

// The plant runs until `end`, s, which is not later than the next sample; after take_sample(), once a period. On any but
// SMS_OK it stands where it could still be computed.
template <typename Plant>
sms_status run_until(const typename Plant::Scalar& end, Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  S next[Plant::legs];
  for (int i = 0; i < Plant::legs; ++i) {
    const S sent = s.electronics.present ? pulse_width_voltage(s.electronics.command, s.command[i]) : s.command[i];
    next[i] = delay_line_step(s.line[i], sent, s.delay_periods[i]);
  }
  const S begin = S(s.sample) * s.period;
  sms_status status = SMS_OK;
  // Each command when it arrives.
  for (S arrived = S(-1), at = S(0); status == SMS_OK && at < s.period && begin + at < end; arrived = at) {
    at = s.period;
    for (const S& rest : s.delay_rest) {
      at = rest > arrived && rest < at ? rest : at;
    }
    const bool within = at < s.period && at > S(0);
    status = within ? integrate_to<Plant>(begin + at < end ? S(begin + at) : end, s) : status;
    for (int i = 0; i < Plant::legs; ++i) {
      if (s.delay_rest[i] > arrived && !(s.delay_rest[i] > at)) {
        set_command(s.system.input, i, next[i]);
      }
    }
  }
  return status == SMS_OK ? integrate_to<Plant>(end, s) : status;
}

// The plant runs to the next sample; after take_sample().
template <typename Plant>
sms_status run_period(Simulation<Plant>& s) {
  using S = typename Plant::Scalar;
  const sms_status status = run_until<Plant>(S(s.sample + 1) * s.period, s);
  s.sample += status == SMS_OK ? 1ul : 0ul;
  return status;
}

}  // namespace sms
