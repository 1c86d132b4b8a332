// One actuator whose extension and chamber pressures were measured (measured.hpp), on the bench as under the platform.
#pragma once

#include <string>

#include "estimation/measured.hpp"
#include "sms/integrate_stiff.hpp"

namespace sms {
namespace estimation {

struct ActuatorSignals {
  Eigen::VectorXd command;
  MeasuredSignal extension;       // with both derivatives
  MeasuredSignal pressure_lower;  // with its rate
  MeasuredSignal pressure_upper;  // with its rate
};

template <typename S>
struct ActuatorTruth {
  Truth<S> extension, lower, upper;
};

template <typename S>
ActuatorTruth<S> actuator_truth(const Params<S>& p, const ActuatorSignals& signals, int sample, double step) {
  return {truth_at(signals.extension, sample, step, extension_sensor(p)),
          truth_at(signals.pressure_lower, sample, step, chamber_pressure_lower_sensor(p)),
          truth_at(signals.pressure_upper, sample, step, chamber_pressure_upper_sensor(p))};
}

template <typename S>
Truth<S> supply_truth(const Params<S>& p, const MeasuredSignal& signal, int sample, double step) {
  return truth_at(signal, sample, step, supply_pressure_sensor(p));
}

// What was measured, put in its place.
template <typename S>
void hold_to(const ActuatorTruth<S>& truth, BenchState<S>& state) {
  state.extension = truth.extension.value;
  state.velocity = truth.extension.rate;
  state.actuator.lower.pressure = truth.lower.value;
  state.actuator.upper.pressure = truth.upper.value;
}

// Where nothing is known of what no sensor sees: the film has the speed of the piston.
template <typename S>
BenchState<S> measured_begin(const Params<S>& p, const ActuatorTruth<S>& truth) {
  BenchState<S> state{S(0), S(0), actuator_at_rest<S>(p, S(0), S(0))};
  hold_to(truth, state);
  state.actuator.film = state.velocity;
  return state;
}

// The spool at a sample: it follows the command alone.
template <typename S>
Lag<S> spool_at_sample(const Params<S>& p, const Eigen::VectorXd& command, int sample, double step) {
  constexpr double kLongest = 1e-3;  // s
  const int parts = std::max(1, static_cast<int>(std::ceil(step / kLongest - 1e-9)));
  return RecordedVoltage<S>(command, Hold::linear, delay_to_chamber(p) / S(step))
      .spool(p, sample, parts, S(step / parts));
}

// What no sensor sees but spool, film and reservoir, a sample later. `rate` is used up.
template <typename S>
void follow(const Params<S>& p, const ActuatorLaws& laws, const S& mass, double step, const ActuatorTerms<S>& t,
            BenchState<S>& rate, ActuatorState<S>& state) {
  solve_stiff<S>(actuator_stiffness<S>(p, laws, mass, t), S(step), rate);
  state.deflection += S(step) * rate.actuator.deflection;
  state.lower.temperature += S(step) * rate.actuator.lower.temperature;
  state.upper.temperature += S(step) * rate.actuator.upper.temperature;
}

// The lubricant's film a sample later, exactly for a speed that runs straight.
template <typename S>
void follow_film(const Params<S>& p, const ActuatorTruth<S>& now, const ActuatorTruth<S>& next, double step,
                 ActuatorState<S>& state) {
  if (!is_absent(p.friction_lag) && film_is_state(p)) {
    const S corner = S(1) / p.friction_lag;
    state.film = low_pass_ramp_step<S>(corner, S(step), low_pass_weight<S>(corner, S(step)), state.film,
                                       now.extension.rate, next.extension.rate);
  }
}

// kg/s into a chamber that would make up for a rate of its pressure.
template <typename S>
S as_flow(const Params<S>& p, const ChamberSpace<S>& space, const S& pressure_rate) {
  return space.volume / (p.gas_constant * p.air_temperature) * pressure_rate;
}

namespace detail {

inline void check_actuator(const std::string& name, const ActuatorSignals& signals, Eigen::Index samples) {
  check_signal(name, "command", signals.command, samples);
  check_measured(name, "extension", signals.extension, 2, samples);
  check_measured(name, "pressure_lower", signals.pressure_lower, 1, samples);
  check_measured(name, "pressure_upper", signals.pressure_upper, 1, samples);
}

// std::invalid_argument for a record that is none.
inline void check_step(const std::string& name, double step, Eigen::Index samples) {
  if (!(step > 0.0) || samples < 2) {
    throw std::invalid_argument(name + ": a step of time above zero and two samples at least are needed");
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
