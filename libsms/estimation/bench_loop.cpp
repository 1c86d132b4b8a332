#include "estimation/bench_loop.hpp"

namespace sms {
namespace estimation {
namespace {

void check(const BenchRecord& record, double period, std::size_t number) {
  const std::string name = "bench record " + std::to_string(number);
  detail::check_signal(name, "setpoint", record.setpoint, record.extension.size());
  const double longer = std::max(period, record.step), shorter = std::min(period, record.step);
  if (std::abs(longer / shorter - std::round(longer / shorter)) > 1e-3) {
    throw std::invalid_argument(name + ": of the controller's period, " + std::to_string(period) +
                                " s, and the record's step, " + std::to_string(record.step) +
                                " s, one has to be a whole multiple of the other");
  }
}

// What the declared controller's integral holds before each of its samples, fed with the record from zero on, V.
Eigen::VectorXd integral_along(const BenchRecord& record, const ControlLaw& law, const Params<double>& said) {
  const double ratio = said.control_period / record.step;
  const Eigen::Index last = record.extension.size() - 1;
  Eigen::VectorXd integral(static_cast<Eigen::Index>(static_cast<double>(last) / ratio + 1e-6) + 1);
  SampledController<double> controller(said, law);
  controller.begin(record.setpoint[0], record.extension[0], 0.0);
  for (Eigen::Index j = 0; j < integral.size(); ++j) {
    const double at = static_cast<double>(j) * ratio;
    integral[j] = controller.integral();
    controller.sample(detail::command_at(record.setpoint, at), detail::command_at(record.extension, at));
  }
  return integral;
}

}  // namespace

BenchLoopPlant::BenchLoopPlant(std::vector<BenchRecord> records, const BenchNoise& noise, double command_noise,
                               const ActuatorLaws& laws, const ControlLaw& law, const Params<double>& said,
                               double longest_step)
    : BenchPlant(std::move(records), noise, laws, longest_step),
      command_noise_(command_noise),
      law_(law),
      said_period_(said.control_period) {
  for (int i = 0; i < this->records(); ++i) {
    check(of(i), said_period_, static_cast<std::size_t>(i));
    integral_.push_back(integral_along(of(i), law, said));
  }
}

ControlGrid BenchLoopPlant::grid_of(double step, double period) const {
  if (period > step) {
    const int steps = steps_over(step);
    return {steps, static_cast<int>(std::lround(period / step)) * steps};
  }
  const int every = steps_over(period);
  return {static_cast<int>(std::lround(step / period)) * every, every};
}

Eigen::VectorXd BenchLoopPlant::guess(int record, int first) const {
  const Eigen::VectorXd& integral = integral_[static_cast<std::size_t>(record)];
  const int begins = grid_of(of(record).step, said_period_).begins(first, of(record).step);
  Eigen::VectorXd start(kStart);
  start << BenchPlant::guess(record, first), integral[std::min<Eigen::Index>(begins, integral.size() - 1)];
  return start;
}

}  // namespace estimation
}  // namespace sms
