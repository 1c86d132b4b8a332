// The equations of the rig "tank", each fed with measured signals (measured.hpp):
//
//   flow, kg/s          V / (R T) (p' - p' measured), as a flow into the tank
//   temperature, K      the thermometer against its reading, where there is one: the air's temperature follows the
//                       measured pressure, and the thermometer that
//   supply, Pa          the reservoir against its reading, where there is one
//
// An error is what the model has too much; with the other sign it is the term that is missing.
#pragma once

#include "estimation/measured.hpp"
#include "estimation/problem.hpp"
#include "sms/tank.hpp"

namespace sms {
namespace estimation {

struct TankSignals {
  double step = 0.0;  // s
  Eigen::VectorXd command;
  MeasuredSignal pressure;                         // with its rate
  MeasuredSignal temperature;                      // empty: not measured
  MeasuredSignal supply_pressure;                  // empty: not measured
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
};

// For each sample, each equation.
class TankEquations : public Problem {
 public:
  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  TankEquations(TankSignals signals, const ActuatorLaws& laws);

  int samples() const { return static_cast<int>(signals_.command.size()); }
  bool reads_temperature() const { return signals_.temperature.value.size() > 0; }
  bool reads_supply() const { return signals_.supply_pressure.value.size() > 0; }
  int rows() const override { return (1 + (reads_temperature() ? 1 : 0) + (reads_supply() ? 1 : 0)) * samples(); }
  void evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

 private:
  template <typename S>
  void errors(Params<S> params, S* out) const;

  TankSignals signals_;
  ActuatorLaws laws_;
};

}  // namespace estimation
}  // namespace sms
