#include "estimation/bench_plant.hpp"

#include "estimation/shooting_search.hpp"

namespace sms {
namespace estimation {
namespace {

void check(const BenchRecord& record, std::size_t number) {
  const std::string name = "bench record " + std::to_string(number);
  const bool commanded = record.command.size() > 0 || record.setpoint.size() == 0;  // else a set-point is in its place
  const Eigen::Index samples = commanded ? record.command.size() : record.setpoint.size();
  if (!(record.step > 0.0) || samples < 20) {
    throw std::invalid_argument(name + ": a step of time above zero and 20 samples at least are needed");
  }
  if (commanded) {
    detail::check_signal(name, "command", record.command, samples);
  }
  detail::check_signal(name, "extension", record.extension, samples);
  detail::check_readings(name, "pressure_lower", record.pressure_lower, samples);
  detail::check_readings(name, "pressure_upper", record.pressure_upper, samples);
  if (record.supply_pressure.size() > 0) {
    detail::check_readings(name, "supply_pressure", record.supply_pressure, samples);
  }
}

}  // namespace

BenchPlant::BenchPlant(std::vector<BenchRecord> records, const BenchNoise& noise, const ActuatorLaws& laws,
                       const LongestSteps& longest_step)
    : records_(std::move(records)), noise_(noise), laws_(laws) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
    steps_.push_back(steps_by_motion({&records_[i].extension}, records_[i].step, longest_step));
  }
}

Eigen::VectorXd BenchPlant::guess(int record, int first) const {
  const BenchRecord& r = of(record);
  const int samples = std::max(8, static_cast<int>(0.05 / r.step));
  const Eigen::Vector2d motion = detail::beginning(r.extension, first, samples, r.step);
  Eigen::VectorXd start(kStart);
  start << motion[0], motion[1], detail::beginning(r.pressure_lower, first, samples, r.step)[0],
      detail::beginning(r.pressure_upper, first, samples, r.step)[0],
      r.supply_pressure.size() > 0 ? r.supply_pressure[first] : 0.0, 0.0, 0.0, 0.0;
  if (r.supply_pressure.size() == 0) {
    start[4] = 4e5;
  }
  return start;
}

Eigen::VectorXd BenchPlant::state(const Params<double>& params, const Window& window,
                                  const Eigen::VectorXd& start) const {
  const BenchRecord& record = of(window.record);
  const Bench<double> bench = make_bench(in_run(params, record), laws_);
  const int parts = steps_[static_cast<std::size_t>(window.record)].most();
  RecordedCommand<double> drive(bench.params, laws_, record.command, record.ahead, record.hold, record.step, window,
                                parts, record.step / parts);
  const BenchState<double> state = begin(bench, window, start.data(), drive);
  return vector_of(state);
}

bool BenchPlant::feels_all(const Params<double>& params, const Window& window) const {
  const Params<double> p = in_run(params, of(window.record));
  return p.supply_line_resistance > 0.0 || seals_deform(p, laws_.friction) || temperature_is_state(p, laws_.chamber);
}

SMS_BENCH_IS_DRIVEN(double);
SMS_BENCH_IS_DRIVEN(ParameterJet);
SMS_PLANT_SIMULATES(BenchPlant, double);
SMS_PLANT_SIMULATES(BenchPlant, ParameterJet);
template class ShootingProblem<BenchPlant>;

}  // namespace estimation
}  // namespace sms
