#include "estimation/tank_equations.hpp"

#include <utility>

#include "estimation/jets.hpp"
#include "estimation/measured_actuator.hpp"
#include "estimation/tank_plant.hpp"

namespace sms {
namespace estimation {
namespace {

// What the thermometer's reading says of its own temperature.
template <typename S>
S thermometer_truth(const Params<S>& p, const MeasuredSignal& signal, int sample, double step) {
  SensorErrors<S> without_lag = tank_temperature_sensor(p);
  without_lag.lag = S(0);
  return truth_at<S>(signal, sample, step, without_lag).value;
}

}  // namespace

TankEquations::TankEquations(TankSignals signals, const ActuatorLaws& laws)
    : signals_(std::move(signals)), laws_(laws) {
  const std::string name = "signals of a tank";
  detail::check_step(name, signals_.step, samples());
  detail::check_signal(name, "command", signals_.command, samples());
  detail::check_measured(name, "pressure", signals_.pressure, 1, samples());
  if (reads_temperature()) {
    detail::check_measured(name, "temperature", signals_.temperature, 0, samples());
  }
  if (reads_supply()) {
    detail::check_measured(name, "supply_pressure", signals_.supply_pressure, 0, samples());
  }
}

template <typename S>
void TankEquations::errors(Params<S> params, S* out) const {
  for (const auto& condition : signals_.conditions) {
    param(params, condition.first) += S(condition.second);
  }
  const Tank<S> tank{params, laws_};
  const Params<S>& p = tank.params;
  const double step = signals_.step;
  const S late = delay_to_chamber(p) / S(step);
  const SensorErrors<S> gauge = tank_pressure_sensor(p);

  TankState<S> state = tank_at_rest<S>(p, S(0)), rate;
  TankTerms<S> t{};
  const SensorErrors<S> by_lag_alone{S(0), S(0), p.thermocouple_time_constant, S(0), S(0)};
  Sensor<S> thermometer(by_lag_alone, S(step));
  const S first = reads_temperature() ? thermometer_truth(p, signals_.temperature, 0, step) : p.air_temperature;
  thermometer.begin(first);
  state.gas.temperature = temperature_is_state(p, laws_.chamber) ? first : p.air_temperature;
  S reservoir = reads_supply() ? supply_truth(p, signals_.supply_pressure, 0, step).value : p.supply_pressure;
  for (int k = 0;; ++k) {
    const Truth<S> now = truth_at(signals_.pressure, k, step, gauge);
    state.gas.pressure = now.value;
    state.supply_pressure = reads_supply() ? supply_truth(p, signals_.supply_pressure, k, step).value : reservoir;
    state.spool = spool_at_sample(p, signals_.command, k, step);
    derivative(tank, state, {detail::command_at<S>(signals_.command, S(k) - late)}, t, rate);
    *out++ = as_flow<S>(p, t.space, rate.gas.pressure - now.rate);
    const S seen = t.air.temperature, warms = seen_temperature_rate(p, laws_.chamber, rate.gas.temperature);
    thermometer.follow(seen, warms);
    if (reads_temperature()) {
      *out++ = thermometer.reading(seen, warms) - thermometer_truth(p, signals_.temperature, k, step);
    }
    reservoir = p.supply_line_resistance > S(0) ? reservoir : p.supply_pressure;
    if (reads_supply()) {
      *out++ = reservoir - state.supply_pressure;
    }
    if (k == samples() - 1) {
      return;
    }
    reservoir = reservoir_after<S>(p, reservoir, t.feed, step);
    const TankStiffness<S> stiff = stiffness(tank, state, t);
    state.gas.temperature += S(step) * rate.gas.temperature / (S(1) - S(step) * stiff.temperature);
  }
}

void TankEquations::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                             RowMatrix* jacobian) const {
  evaluate_with_jets<8>([this](const auto& p, auto* out) { errors(p, out); }, rows(), params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
