#include "estimation/cylinder.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/jets.hpp"
#include "sms/piston.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {
namespace {

// Absolute pressure in a chamber from its sensor's reading.
template <typename S>
S chamber_pressure(double reading, bool gauge, const S& gain, const S& offset, const S& ambient) {
  const S truth = sensor_truth(S(reading), gain, offset);
  return gauge ? S(truth + ambient) : truth;
}

// Predicted minus measured reading of the load cell, for one sample.
template <typename S>
S residual_at(const Params<S>& p, const CylinderRecord& record, Eigen::Index i) {
  const S scale = S(1) / (S(1) + p.sensor_gain_extension);
  Piston<S> piston;
  piston.extension = sensor_truth(S(record.extension[i]), p.sensor_gain_extension, p.sensor_offset_extension);
  piston.velocity = record.velocity[i] * scale;
  piston.acceleration = record.acceleration[i] * scale;
  piston.pressure_lower =
      chamber_pressure(record.pressure_lower[i], record.gauge_lower, p.sensor_gain_chamber_pressure_lower,
                       p.sensor_offset_chamber_pressure_lower, p.ambient_pressure);
  piston.pressure_upper = p.ambient_pressure;
  if (record.pressure_upper.size() > 0) {
    piston.pressure_upper =
        chamber_pressure(record.pressure_upper[i], record.gauge_upper, p.sensor_gain_chamber_pressure_upper,
                         p.sensor_offset_chamber_pressure_upper, p.ambient_pressure);
  }
  return sensor_reading(rod_force(p, piston), p.sensor_gain_rod_force, p.sensor_offset_rod_force) - record.rod_force[i];
}

void check(const CylinderRecord& record, std::size_t number) {
  const Eigen::Index n = record.rod_force.size();
  const auto refuse = [number](const std::string& what) {
    throw std::invalid_argument("cylinder record " + std::to_string(number) + ": " + what);
  };
  const auto check_one = [&](const Eigen::VectorXd& signal, const char* name) {
    if (signal.size() != n) {
      refuse(std::string(name) + " has " + std::to_string(signal.size()) + " samples, rod_force has " +
             std::to_string(n));
    }
    if (!signal.allFinite()) {
      refuse(std::string(name) + " holds a value that is not a finite number");
    }
  };
  check_one(record.extension, "extension");
  check_one(record.velocity, "velocity");
  check_one(record.acceleration, "acceleration");
  check_one(record.pressure_lower, "pressure_lower");
  if (record.pressure_upper.size() > 0) {
    check_one(record.pressure_upper, "pressure_upper");
  }
  check_one(record.rod_force, "rod_force");
}

}  // namespace

CylinderProblem::CylinderProblem(std::vector<CylinderRecord> records) : records_(std::move(records)) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
    rows_ += static_cast<int>(records_[i].rod_force.size());
  }
}

void CylinderProblem::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                               RowMatrix* jacobian) const {
  const auto model = [this](const auto& p, auto* out) {
    for (const CylinderRecord& record : records_) {
      for (Eigen::Index i = 0; i < record.rod_force.size(); ++i) {
        *out++ = residual_at(p, record, i);
      }
    }
  };
  evaluate_with_jets(model, rows_, params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
