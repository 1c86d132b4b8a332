#include "estimation/platform_equations.hpp"

#include <utility>

#include "estimation/jets.hpp"

namespace sms {
namespace estimation {
namespace {

template <typename S>
using LegTruths = std::array<ActuatorTruth<S>, 3>;

template <typename S>
LegTruths<S> truths_at(const LegMachines<S>& machines, const PlatformSignals& signals, int sample) {
  return {actuator_truth(machines.leg[0], signals.leg[0], sample, signals.step),
          actuator_truth(machines.leg[1], signals.leg[1], sample, signals.step),
          actuator_truth(machines.leg[2], signals.leg[2], sample, signals.step)};
}

// Where the pistons were, in plain numbers.
template <typename S>
MeasuredMotion motion_of(const std::vector<LegTruths<S>>& truths) {
  MeasuredMotion motion;
  for (const LegTruths<S>& t : truths) {
    motion.extension.emplace_back(value_of(t[0].extension.value), value_of(t[1].extension.value),
                                  value_of(t[2].extension.value));
    motion.rate.emplace_back(value_of(t[0].extension.rate), value_of(t[1].extension.rate),
                             value_of(t[2].extension.rate));
  }
  return motion;
}

}  // namespace

PlatformEquations::PlatformEquations(PlatformSignals signals, const ActuatorLaws& laws, MassModel masses)
    : signals_(std::move(signals)), laws_(laws), masses_(masses) {
  const std::string name = "signals of a platform";
  detail::check_step(name, signals_.step, samples());
  for (const ActuatorSignals& leg : signals_.leg) {
    detail::check_actuator(name, leg, samples());
  }
  if (reads_supply()) {
    detail::check_measured(name, "supply_pressure", signals_.supply_pressure, 0, samples());
  }
  if (reads_attitude() || signals_.pitch.value.size() > 0) {
    detail::check_measured(name, "roll", signals_.roll, 0, samples());
    detail::check_measured(name, "pitch", signals_.pitch, 0, samples());
  }
}

template <typename S>
void PlatformEquations::errors(const LegParams<S>& params, S* out) const {
  const LegMachines<S> machines = machines_of(params, signals_.conditions);
  const Params<S>& common = machines.common;
  const double step = signals_.step;
  std::vector<LegTruths<S>> truths;
  truths.reserve(static_cast<std::size_t>(samples()));
  for (int k = 0; k < samples(); ++k) {
    truths.push_back(truths_at(machines, signals_, k));
  }
  const MeasuredMotion motion = motion_of(truths);
  const MeasuredPath<double> here = measured_path(plain_params(common), masses_, motion);
  const MeasuredPath<S>& path = path_with_slopes(here, common, masses_, motion);
  Pistons<S> state, rate{};
  PistonTerms<S> t{};
  t.friction.setZero();
  t.along.setZero();
  Vec3<S> reservoir;
  for (int i = 0; i < 3; ++i) {
    state.leg[i] = measured_begin(machines.leg[i], truths[0][static_cast<std::size_t>(i)]);
    reservoir(i) = machines.leg[i].supply_pressure;
  }
  for (int k = 0;; ++k) {
    const LegTruths<S>& now = truths[static_cast<std::size_t>(k)];
    const PathPoint<S>& place = path.points[static_cast<std::size_t>(k)];
    const S read = reads_supply() ? supply_truth(common, signals_.supply_pressure, k, step).value : reservoir(0);
    const S beside = read - reservoir(0);  // what the first reservoir's reading says of all
    Vec3<S> command, measured, aside;
    for (int i = 0; i < 3; ++i) {
      const Params<S>& p = machines.leg[i];
      const ActuatorTruth<S>& truth = now[static_cast<std::size_t>(i)];
      const Eigen::VectorXd& volts = signals_.leg[static_cast<std::size_t>(i)].command;
      hold_to(truth, state.leg[i]);
      state.leg[i].actuator.supply_pressure = reservoir(i) + beside;
      state.leg[i].actuator.spool = spool_at_sample(p, volts, k, step);
      command(i) = detail::command_at<S>(volts, S(k) - delay_to_chamber(p) / S(step));
      measured(i) = truth.extension.second;
      aside(i) = truth.extension.value - place.extension(i);
    }
    piston_rates<S>(machines, laws_, place, path.leaning, state, command, nullptr, t, rate);

    const Vec3<S> force =
        place.mass * (Vec3<S>(rate.leg[0].velocity, rate.leg[1].velocity, rate.leg[2].velocity) - measured);
    for (int i = 0; i < 3; ++i) {
      *out++ = force(i);
    }
    for (int i = 0; i < 3; ++i) {
      const S& rises = now[static_cast<std::size_t>(i)].lower.rate;
      *out++ = as_flow<S>(machines.leg[i], t.actuator[i].lower, rate.leg[i].actuator.lower.pressure - rises);
    }
    for (int i = 0; i < 3; ++i) {
      const S& rises = now[static_cast<std::size_t>(i)].upper.rate;
      *out++ = as_flow<S>(machines.leg[i], t.actuator[i].upper, rate.leg[i].actuator.upper.pressure - rises);
    }
    if (reads_supply()) {
      *out++ = -beside;
    }
    if (reads_attitude()) {
      const Vec3<S> q = place.q + place.to_pose * aside;
      *out++ = q(0) - truth_at(signals_.roll, k, step, roll_sensor(common)).value;
      *out++ = q(1) - truth_at(signals_.pitch, k, step, pitch_sensor(common)).value;
    }
    if (k == samples() - 1) {
      return;
    }
    for (int i = 0; i < 3; ++i) {
      const Params<S>& p = machines.leg[i];
      const std::size_t leg = static_cast<std::size_t>(i);
      follow_film(p, now[leg], truths[static_cast<std::size_t>(k + 1)][leg], step, state.leg[i].actuator);
      reservoir(i) = reservoir_after<S>(p, reservoir(i), t.actuator[i].flow.drawn, step);
      follow<S>(p, laws_, S(place.mass(i, i)), step, t.actuator[i], rate.leg[i], state.leg[i].actuator);
    }
  }
}

void PlatformEquations::evaluate(const LegParams<double>& params, const std::vector<int>& free,
                                 Eigen::VectorXd* residual, RowMatrix* jacobian) const {
  evaluate_with_jets<8>([this](const auto& p, auto* out) { errors(p, out); }, rows(), params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
