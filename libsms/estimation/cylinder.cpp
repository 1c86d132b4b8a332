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
S chamber_pressure(double reading, bool gauge, const SensorErrors<S>& sensor, const S& ambient) {
  const S truth = sensor.truth(S(reading));
  return gauge ? S(truth + ambient) : truth;
}

// The true state of the piston at one sample, from its readings.
template <typename S>
Piston<S> piston_at(const Params<S>& p, const CylinderRecord& record, Eigen::Index i) {
  const SensorErrors<S> sensor = extension_sensor(p);
  Piston<S> piston;
  piston.extension = sensor.truth(S(record.extension[i]));
  const S scale = S(1) / sensor.slope(piston.extension);
  piston.velocity = record.velocity[i] * scale;
  piston.acceleration = record.acceleration[i] * scale;
  piston.pressure_lower = chamber_pressure(record.pressure_lower[i], record.gauge_lower,
                                           chamber_pressure_lower_sensor(p), p.ambient_pressure);
  piston.pressure_upper = p.ambient_pressure;
  if (record.pressure_upper.size() > 0) {
    piston.pressure_upper = chamber_pressure(record.pressure_upper[i], record.gauge_upper,
                                             chamber_pressure_upper_sensor(p), p.ambient_pressure);
  }
  return piston;
}

bool has_memory(FrictionLaw law) { return law == FrictionLaw::dahl || law == FrictionLaw::lugre; }

template <typename S>
BristleFriction<S> bristle_friction(const Params<S>& p, FrictionLaw law, const Piston<S>& piston, const S& deflection) {
  return law == FrictionLaw::dahl ? dahl_friction(p, piston, deflection) : lugre_friction(p, piston, deflection);
}

// z after dt of z' = v - k z, k and v held; k is read off the rate, which is linear in z once lambda is held.
template <typename S>
S deflected(const Params<S>& p, FrictionLaw law, const Piston<S>& piston, const S& z, double dt) {
  using std::abs;
  using std::exp;
  const S lost = piston.velocity - bristle_friction(p, law, piston, z).deflection_rate;  // k z
  if (!(abs(lost) * dt > 1e-9 * abs(z))) {
    return z + piston.velocity * dt;
  }
  const S k = lost / z;
  const S settled = piston.velocity / k;
  return settled + (z - settled) * exp(-k * dt);
}

template <typename S>
S friction_at(const Params<S>& p, FrictionLaw law, const Piston<S>& piston, const S& deflection) {
  switch (law) {
    case FrictionLaw::acceleration_dependent:
      return friction(p, piston);
    case FrictionLaw::two_branch:
      return friction_two_branch(p, piston);
    case FrictionLaw::stribeck:
      return friction_stribeck(p, piston.velocity);
    default:
      return bristle_friction(p, law, piston, deflection).force;
  }
}

// Predicted minus measured readings of the load cell, of one record.
template <typename S>
void residuals_of(const Params<S>& p, const CylinderRecord& record, FrictionLaw law, S* out) {
  constexpr int kParts = 4;  // of a step between samples
  S deflection(0);
  for (Eigen::Index i = 0; i < record.rod_force.size(); ++i) {
    const Piston<S> piston = piston_at(p, record, i);
    if (has_memory(law) && i > 0) {
      const double dt = (record.time[i] - record.time[i - 1]) / kParts;
      for (int part = 0; part < kParts; ++part) {
        deflection = deflected(p, law, piston, deflection, dt);
      }
    }
    const S rod =
        pressure_force(p, piston) - friction_at(p, law, piston, deflection) - p.moving_mass * piston.acceleration;
    out[i] = rod_force_sensor(p).reading(rod) - record.rod_force[i];
  }
}

void check(const CylinderRecord& record, std::size_t number, bool needs_time) {
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
  if (needs_time || record.time.size() > 0) {
    check_one(record.time, "time");
    if (n > 1 && !((record.time.tail(n - 1) - record.time.head(n - 1)).array() > 0.0).all()) {
      refuse("time does not rise from sample to sample");
    }
  }
}

}  // namespace

CylinderProblem::CylinderProblem(std::vector<CylinderRecord> records, FrictionLaw law)
    : records_(std::move(records)), law_(law) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i, has_memory(law));
    rows_ += static_cast<int>(records_[i].rod_force.size());
  }
}

void CylinderProblem::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                               RowMatrix* jacobian) const {
  const auto model = [this](const auto& p, auto* out) {
    for (const CylinderRecord& record : records_) {
      residuals_of(p, record, law_, out);
      out += record.rod_force.size();
    }
  };
  evaluate_with_jets(model, rows_, params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
