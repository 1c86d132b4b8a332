#include "estimation/platform_plant.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "estimation/shooting_search.hpp"

namespace sms {
namespace estimation {
namespace {

void check(const PlatformRecord& record, std::size_t number) {
  const std::string name = "platform record " + std::to_string(number);
  const bool commanded = record.command[0].size() > 0 || record.setpoint[0].size() == 0;
  const Eigen::Index samples = commanded ? record.command[0].size() : record.setpoint[0].size();
  if (!(record.step > 0.0) || samples < 20) {
    throw std::invalid_argument(name + ": a step of time above zero and 20 samples at least are needed");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (commanded) {
      detail::check_signal(name, "command", record.command[i], samples);
    }
    detail::check_signal(name, "extension", record.extension[i], samples);
    detail::check_readings(name, "pressure_lower", record.pressure_lower[i], samples);
    detail::check_readings(name, "pressure_upper", record.pressure_upper[i], samples);
  }
  if (record.supply_pressure.size() > 0) {
    detail::check_readings(name, "supply_pressure", record.supply_pressure, samples);
  }
  if (record.roll.size() > 0 || record.pitch.size() > 0) {
    detail::check_readings(name, "roll", record.roll, samples);
    detail::check_readings(name, "pitch", record.pitch, samples);
  }
}

}  // namespace

PlatformPlant::PlatformPlant(std::vector<PlatformRecord> records, const PlatformNoise& noise, const ActuatorLaws& laws,
                             MassModel masses, const LongestSteps& longest_step)
    : records_(std::move(records)), noise_(noise), laws_(laws), masses_(masses) {
  int samples_before = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
    measured_.push_back(detail::smoothed(records_[i].extension, records_[i].step));
    first_of_.push_back(samples_before);
    samples_before += samples(static_cast<int>(i));
    const LegSignals& x = records_[i].extension;
    steps_.push_back(steps_by_motion({&x[0], &x[1], &x[2]}, records_[i].step, longest_step));
  }
}

Eigen::VectorXd PlatformPlant::guess(int record, int first) const {
  const PlatformRecord& r = of(record);
  const int samples = std::max(8, static_cast<int>(0.05 / r.step));
  Eigen::VectorXd start = Eigen::VectorXd::Zero(kStart);
  for (int i = 0; i < 3; ++i) {
    const std::size_t leg = static_cast<std::size_t>(i);
    const Eigen::Vector2d motion = detail::beginning(r.extension[leg], first, samples, r.step);
    start[i] = motion[0];
    start[3 + i] = motion[1];
    start[6 + i] = detail::beginning(r.pressure_lower[leg], first, samples, r.step)[0];
    start[9 + i] = detail::beginning(r.pressure_upper[leg], first, samples, r.step)[0];
    start[12 + i] = r.supply_pressure.size() > 0 ? r.supply_pressure[first] : 4e5;
  }
  return start;
}

bool PlatformPlant::feels_all(const LegParams<double>& params, const Window& window) const {
  const LegMachines<double> machines = machines_of(params, of(window.record).conditions);
  bool all = false;
  for (const Params<double>& p : machines.leg) {
    all = all || p.supply_line_resistance > 0.0 || seals_deform(p, laws_.friction);
  }
  return all;
}

MeasuredMotion PlatformPlant::motion(const Params<double> (&leg)[3], const Window& window) const {
  const MeasuredMotion& all = measured_[static_cast<std::size_t>(window.record)];
  const int last = static_cast<int>(all.extension.size()) - 1;
  MeasuredMotion out;
  out.extension.resize(static_cast<std::size_t>(window.samples));
  out.rate.resize(out.extension.size());
  for (int i = 0; i < 3; ++i) {
    const Params<double>& p = leg[i];
    const SensorErrors<double> sensor = extension_sensor(p);
    const int late = static_cast<int>(std::lround((sensor.clock + sensor.lag) / step(window.record)));
    for (int k = 0; k < window.samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(std::min(std::max(window.first + k + late, 0), last));
      out.extension[static_cast<std::size_t>(k)](i) = sensor.truth(all.extension[at](i));
      out.rate[static_cast<std::size_t>(k)](i) = all.rate[at](i) / (1.0 + sensor.gain);
    }
  }
  return out;
}

SMS_PLATFORM_IS_DRIVEN(double);
SMS_PLATFORM_IS_DRIVEN(ParameterJet);
SMS_PLANT_SIMULATES(PlatformPlant, double);
SMS_PLANT_SIMULATES(PlatformPlant, ParameterJet);
template class ShootingProblem<PlatformPlant>;

}  // namespace estimation
}  // namespace sms
