#include "estimation/bench_plant.hpp"

#include <string>

namespace sms {
namespace estimation {
namespace {

void check(const BenchRecord& record, std::size_t number) {
  const auto refuse = [number](const std::string& what) {
    throw std::invalid_argument("bench record " + std::to_string(number) + ": " + what);
  };
  const auto check_one = [&](const Eigen::VectorXd& signal, const char* name) {
    if (signal.size() != record.command.size()) {
      refuse(std::string(name) + " has " + std::to_string(signal.size()) + " samples, command has " +
             std::to_string(record.command.size()));
    }
    if (!signal.allFinite()) {
      refuse(std::string(name) + " holds a value that is not a finite number");
    }
  };
  if (!(record.step > 0.0) || record.command.size() < 20) {
    refuse("a step of time above zero and 20 samples at least are needed");
  }
  check_one(record.command, "command");
  check_one(record.extension, "extension");
  check_one(record.pressure_lower, "pressure_lower");
  check_one(record.pressure_upper, "pressure_upper");
  if (record.supply_pressure.size() > 0) {
    check_one(record.supply_pressure, "supply_pressure");
  }
}

// Value and slope at the first of some samples, by a parabola through them.
Eigen::Vector2d beginning(const Eigen::VectorXd& signal, int first, int samples, double step) {
  const int count = std::min<int>(samples, static_cast<int>(signal.size()) - first);
  Eigen::MatrixX3d powers(count, 3);
  for (int k = 0; k < count; ++k) {
    const double t = k * step;
    powers.row(k) << 1.0, t, t * t;
  }
  const Eigen::Vector3d fitted = powers.colPivHouseholderQr().solve(signal.segment(first, count));
  return fitted.head<2>();
}

}  // namespace

BenchPlant::BenchPlant(std::vector<BenchRecord> records, const BenchNoise& noise, const ActuatorLaws& laws,
                       double longest_step)
    : records_(std::move(records)), noise_(noise), laws_(laws), longest_step_(longest_step) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
  }
}

Eigen::VectorXd BenchPlant::guess(int record, int first) const {
  const BenchRecord& r = of(record);
  const int samples = std::max(8, static_cast<int>(0.05 / r.step));
  const Eigen::Vector2d motion = beginning(r.extension, first, samples, r.step);
  Eigen::VectorXd start(kStart);
  start << motion[0], motion[1], beginning(r.pressure_lower, first, samples, r.step)[0],
      beginning(r.pressure_upper, first, samples, r.step)[0],
      r.supply_pressure.size() > 0 ? r.supply_pressure[first] : 0.0, 0.0;
  if (r.supply_pressure.size() == 0) {
    start[4] = 4e5;
  }
  return start;
}

}  // namespace estimation
}  // namespace sms
