#include "estimation/tank_equations.hpp"

#include <utility>

#include "estimation/jets.hpp"
#include "estimation/measured_actuator.hpp"
#include "estimation/tank_plant.hpp"

namespace sms {
namespace estimation {
namespace {

// What the thermometer's reading says of the air; it measures against its cold junction.
template <typename S>
S thermometer_truth(const Params<S>& p, const MeasuredSignal& signal, int sample, double step) {
  const S reading = truth_at<S>(signal, sample, step, {S(0), S(0), p.clock_skew_tank}).value;
  return p.air_temperature +
         sensor_truth<S>(reading - p.air_temperature, p.sensor_gain_tank_temperature, p.sensor_offset_tank_temperature);
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
  const S late = p.command_delay / S(step);
  const SensorErrors<S> gauge{p.sensor_gain_tank_pressure, p.sensor_offset_tank_pressure,
                              p.clock_skew_tank + p.sensor_lag_tank_pressure};

  TankState<S> state = tank_at_rest<S>(p, S(0)), rate;
  TankTerms<S> t;
  detail::FollowingSensor<S> couple(p.thermocouple_time_constant, S(step));
  const bool warm = laws_.chamber == ChamberLaw::energy || is_partly_warm(tank);
  couple.reading = reads_temperature() ? thermometer_truth(p, signals_.temperature, 0, step) : p.air_temperature;
  state.gas.temperature = warm ? couple.reading : p.air_temperature;
  S reservoir = reads_supply() ? supply_truth(p, signals_.supply_pressure, 0, step).value : p.supply_pressure;
  for (int k = 0;; ++k) {
    const Truth<S> now = truth_at(signals_.pressure, k, step, gauge);
    state.gas.pressure = now.value;
    state.supply_pressure = reads_supply() ? supply_truth(p, signals_.supply_pressure, k, step).value : reservoir;
    state.spool = spool_at_sample(p, signals_.command, k, step);
    derivative(tank, state, {detail::command_at<S>(signals_.command, S(k) - late)}, t, rate);
    *out++ = as_flow<S>(p, t.space, rate.gas.pressure - now.rate);
    const S seen = tank_air(tank, state.gas).temperature;
    if (reads_temperature()) {
      *out++ = couple.at(seen, rate.gas.temperature) - thermometer_truth(p, signals_.temperature, k, step);
    }
    reservoir = p.supply_line_resistance > S(0) ? reservoir : p.supply_pressure;
    if (reads_supply()) {
      *out++ = reservoir - state.supply_pressure;
    }
    if (k == samples() - 1) {
      return;
    }
    reservoir = reservoir_after<S>(p, reservoir, t.feed, step);
    const detail::TankStiffness<S> stiff = detail::tank_stiffness(p, state, t);
    state.gas.temperature += S(step) * rate.gas.temperature / (S(1) - S(step) * stiff.temperature);
    couple.step(seen, tank_air(tank, state.gas).temperature);
  }
}

void TankEquations::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                             RowMatrix* jacobian) const {
  evaluate_with_jets<8>([this](const auto& p, auto* out) { errors(p, out); }, rows(), params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
