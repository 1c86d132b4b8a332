#include "estimation/bench_loop.hpp"

#include "estimation/shooting_search.hpp"

namespace sms {
namespace estimation {

BenchLoopPlant::BenchLoopPlant(std::vector<BenchRecord> records, const BenchNoise& noise, double command_noise,
                               const ActuatorLaws& laws, const ControlLaw& law, const Params<double>& said,
                               double longest_step)
    : BenchPlant(std::move(records), noise, laws, longest_step),
      command_noise_(command_noise),
      law_(law),
      said_period_(said.control_period),
      longest_step_(longest_step) {
  for (int i = 0; i < this->records(); ++i) {
    check_loop("bench record " + std::to_string(i), control_record(i), said_period_);
    integral_.push_back(integral_along(control_record(i), law, said));
  }
}

Eigen::VectorXd BenchLoopPlant::guess(int record, int first) const {
  const Eigen::VectorXd& integral = integral_[static_cast<std::size_t>(record)];
  const int begins = control_grid(step(record), said_period_, longest_step_).begins(first, step(record));
  Eigen::VectorXd start(kStart);
  start << BenchPlant::guess(record, first), integral[std::min<Eigen::Index>(begins, integral.size() - 1)];
  return start;
}

SMS_PLANT_SIMULATES(BenchLoopPlant, double);
SMS_PLANT_SIMULATES(BenchLoopPlant, ParameterJet);
template class ShootingProblem<BenchLoopPlant>;

}  // namespace estimation
}  // namespace sms
