#include "estimation/actuator_controller.hpp"

namespace sms {
namespace estimation {

ControlGrid control_grid(double record_step, double period, double longest_step) {
  if (period > record_step) {
    const int steps = steps_over(record_step, longest_step);
    return {steps, static_cast<int>(std::lround(period / record_step)) * steps};
  }
  const int every = steps_over(period, longest_step);
  return {static_cast<int>(std::lround(record_step / period)) * every, every};
}

Eigen::VectorXd integral_along(const ControlRecord& record, const ControlLaw& law, const Params<double>& p) {
  const double ratio = p.control_period / record.step;
  const Eigen::Index last = record.extension.size() - 1;
  Eigen::VectorXd integral(static_cast<Eigen::Index>(static_cast<double>(last) / ratio + 1e-6) + 1);
  const double clock = extension_sensor(p).clock;
  SampledController<double> controller(p, law);
  controller.begin(record.setpoint[0], reading_of_controller(record, 0.0, clock), 0.0);
  for (Eigen::Index j = 0; j < integral.size(); ++j) {
    const double at = static_cast<double>(j) * ratio;
    integral[j] = controller.integral();
    controller.sample(detail::command_at(record.setpoint, at), reading_of_controller(record, at, clock));
  }
  return integral;
}

void check_loop(const std::string& name, const ControlRecord& record, double period) {
  detail::check_signal(name, "setpoint", record.setpoint, record.extension.size());
  const double longer = std::max(period, record.step), shorter = std::min(period, record.step);
  if (std::abs(longer / shorter - std::round(longer / shorter)) > 1e-3) {
    throw std::invalid_argument(name + ": of the controller's period, " + std::to_string(period) +
                                " s, and the record's step, " + std::to_string(record.step) +
                                " s, one has to be a whole multiple of the other");
  }
}

}  // namespace estimation
}  // namespace sms
