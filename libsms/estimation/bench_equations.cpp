#include "estimation/bench_equations.hpp"

#include <utility>

#include "estimation/jets.hpp"

namespace sms {
namespace estimation {

BenchEquations::BenchEquations(BenchSignals signals, const ActuatorLaws& laws)
    : signals_(std::move(signals)), laws_(laws) {
  const std::string name = "signals of a bench";
  detail::check_step(name, signals_.step, samples());
  detail::check_actuator(name, signals_.actuator, samples());
  if (reads_supply()) {
    detail::check_measured(name, "supply_pressure", signals_.supply_pressure, 0, samples());
  }
}

template <typename S>
void BenchEquations::errors(Params<S> params, S* out) const {
  for (const auto& condition : signals_.conditions) {
    param(params, condition.first) += S(condition.second);
  }
  const Bench<S> bench = make_bench(params, laws_);
  const Params<S>& p = bench.params;
  const ActuatorSignals& signals = signals_.actuator;
  const double step = signals_.step;
  const S late = delay_to_chamber(p) / S(step);

  ActuatorTruth<S> now = actuator_truth(p, signals, 0, step);
  BenchState<S> state = measured_begin(p, now), rate{};
  BenchTerms<S> t{};
  S reservoir = reads_supply() ? supply_truth(p, signals_.supply_pressure, 0, step).value : p.supply_pressure;
  for (int k = 0;; ++k) {
    hold_to(now, state);
    const S supply = reads_supply() ? supply_truth(p, signals_.supply_pressure, k, step).value : reservoir;
    state.actuator.supply_pressure = supply;
    state.actuator.spool = spool_at_sample(p, signals.command, k, step);
    derivative<S>(bench, state, {detail::command_at<S>(signals.command, S(k) - late), S(0)}, t, rate);
    *out++ = p.moving_mass * (rate.velocity - now.extension.second);
    *out++ = as_flow<S>(p, t.actuator.lower, rate.actuator.lower.pressure - now.lower.rate);
    *out++ = as_flow<S>(p, t.actuator.upper, rate.actuator.upper.pressure - now.upper.rate);
    reservoir = p.supply_line_resistance > S(0) ? reservoir : p.supply_pressure;
    if (reads_supply()) {
      *out++ = reservoir - supply;
    }
    if (k == samples() - 1) {
      return;
    }
    const ActuatorTruth<S> next = actuator_truth(p, signals, k + 1, step);
    follow_film(p, now, next, step, state.actuator);
    reservoir = reservoir_after<S>(p, reservoir, t.actuator.flow.drawn, step);
    follow<S>(p, laws_, p.moving_mass, step, t.actuator, rate, state.actuator);
    now = next;
  }
}

void BenchEquations::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                              RowMatrix* jacobian) const {
  evaluate_with_jets<8>([this](const auto& p, auto* out) { errors(p, out); }, rows(), params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
