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
                     const LongestSteps& longest_step)
    : records_(std::move(records)), noise_(noise), laws_(laws) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
    steps_.push_back(steps_by_command(records_[i].command, records_[i].step, longest_step));
  }
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
  const int parts = steps_[static_cast<std::size_t>(window.record)].most();
  RecordedVoltage<double> command(record.command, record.hold, delay_to_chamber(tank.params) / record.step,
                                  {record.command, record.ahead, window.first, window.samples, record.step, nullptr},
                                  staircase_lag(tank.params, record.step));
  const TankState<double> state =
      begin(tank, start.data(), command.spool(tank.params, window.first, parts, record.step / parts));
  return vector_of(state);
}

SMS_PLANT_SIMULATES(TankPlant, double);
SMS_PLANT_SIMULATES(TankPlant, ParameterJet);
template class ShootingProblem<TankPlant>;

}  // namespace estimation
}  // namespace sms
