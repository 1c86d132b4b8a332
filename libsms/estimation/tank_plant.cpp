#include "estimation/tank_plant.hpp"

#include "estimation/shooting_search.hpp"

namespace sms {
namespace estimation {
namespace {

void check(const TankPlantRecord& record, std::size_t number) {
  const std::string name = "tank record " + std::to_string(number);
  const Eigen::Index samples = record.command.size();
  if (!(record.step > 0.0) || samples < 20) {
    throw std::invalid_argument(name + ": a step of time above zero and 20 samples at least are needed");
  }
  detail::check_signal(name, "command", record.command, samples);
  detail::check_readings(name, "pressure", record.pressure, samples);
  if (record.temperature.size() > 0) {
    detail::check_readings(name, "temperature", record.temperature, samples);
  }
  if (record.supply_pressure.size() > 0) {
    detail::check_readings(name, "supply_pressure", record.supply_pressure, samples);
  }
}

}  // namespace

TankPlant::TankPlant(std::vector<TankPlantRecord> records, const TankNoise& noise, const ActuatorLaws& laws,
                     double longest_step)
    : records_(std::move(records)), noise_(noise), laws_(laws), longest_step_(longest_step) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
  }
}

int TankPlant::steps_of(const Window& window) const {
  constexpr double kLongerAtRest = 4.0;
  constexpr double kSettled = 1.0;  // s since the command has moved: far longer than any spool, line or converter takes
  const TankPlantRecord& record = of(window.record);
  const Eigen::Index first =
      std::max<Eigen::Index>(window.first - static_cast<Eigen::Index>(kSettled / record.step), 0);
  const auto command = record.command.segment(first, window.first + window.samples - first);
  const bool rests = !(command.maxCoeff() > command.minCoeff());
  return detail::steps_over(record.step, rests ? kLongerAtRest * longest_step_ : longest_step_);
}

Eigen::VectorXd TankPlant::guess(int record, int first) const {
  const TankPlantRecord& r = of(record);
  const int samples = std::max(8, static_cast<int>(0.05 / r.step));
  const double temperature =
      r.temperature.size() > 0 ? detail::beginning(r.temperature, first, samples, r.step)[0] : 293.0;
  Eigen::VectorXd start(kStart);
  start << detail::beginning(r.pressure, first, samples, r.step)[0], temperature,
      r.supply_pressure.size() > 0 ? r.supply_pressure[first] : 4e5, temperature;
  return start;
}

Eigen::VectorXd TankPlant::state(const Params<double>& params, const Window& window,
                                 const Eigen::VectorXd& start) const {
  const TankPlantRecord& record = of(window.record);
  const Tank<double> tank = tank_of(params, record);
  const int steps = steps_of(window);
  RecordedVoltage<double> command(record.command, record.hold, steps, delay_to_chamber(tank.params) / record.step);
  const TankState<double> state =
      begin(tank, start.data(), command.spool(tank.params, window.first, record.step / steps));
  return vector_of(state);
}

SMS_PLANT_SIMULATES(TankPlant, double);
SMS_PLANT_SIMULATES(TankPlant, ParameterJet);
template class ShootingProblem<TankPlant>;

}  // namespace estimation
}  // namespace sms
