#include "estimation/platform_loop.hpp"

#include "estimation/shooting_search.hpp"

namespace sms {
namespace estimation {

PlatformLoopPlant::PlatformLoopPlant(std::vector<PlatformRecord> records, const PlatformNoise& noise,
                                     const Vec3<double>& command_noise, const ActuatorLaws& laws, const ControlLaw& law,
                                     const LegParams<double>& said, MassModel masses, double longest_step)
    : PlatformPlant(std::move(records), noise, laws, masses, longest_step),
      command_noise_(command_noise),
      law_(law),
      said_period_(said.control_period),
      longest_step_(longest_step) {
  for (int record = 0; record < this->records(); ++record) {
    LegSignals integral;
    for (int i = 0; i < 3; ++i) {
      const ControlRecord loop = control_record(record, i);
      check_loop("platform record " + std::to_string(record), loop, said_period_);
      integral[static_cast<std::size_t>(i)] = integral_along(loop, law, params_of_leg(said, i));
    }
    integral_.push_back(std::move(integral));
  }
}

Eigen::VectorXd PlatformLoopPlant::guess(int record, int first) const {
  const Eigen::Index begins = control_grid(step(record), said_period_, longest_step_).begins(first, step(record));
  Eigen::VectorXd start(kStart);
  start.head<PlatformPlant::kStart>() = PlatformPlant::guess(record, first);
  for (int i = 0; i < 3; ++i) {
    const Eigen::VectorXd& integral = integral_[static_cast<std::size_t>(record)][static_cast<std::size_t>(i)];
    start[PlatformPlant::kStart + i] = integral[std::min(begins, integral.size() - 1)];
  }
  return start;
}

SMS_PLANT_SIMULATES(PlatformLoopPlant, double);
SMS_PLANT_SIMULATES(PlatformLoopPlant, ParameterJet);
template class ShootingProblem<PlatformLoopPlant>;

}  // namespace estimation
}  // namespace sms
