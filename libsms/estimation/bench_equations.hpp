// The equations of the rig "bench", each fed with measured signals (measured.hpp):
//
//   force, N                M (a - a measured), the acceleration of the force balance against the measured one
//   lower chamber, kg/s     V_a / (R T) (p_a' - p_a' measured), as a flow into it
//   upper chamber, kg/s     the same
//   supply, Pa              the reservoir against its reading, where there is one
//
// An error is what the model has too much; with the other sign it is the term that is missing. The units are those of the
// hidden inputs of bench_plant.hpp: the force is what accelerates the mass, less what a friction that grows with the
// acceleration takes of it.
#pragma once

#include "estimation/measured_actuator.hpp"
#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

struct BenchSignals {
  double step = 0.0;  // s
  ActuatorSignals actuator;
  MeasuredSignal supply_pressure;                  // empty: not measured
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
};

// For each sample, each equation.
class BenchEquations : public Problem {
 public:
  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  BenchEquations(BenchSignals signals, const ActuatorLaws& laws);

  int samples() const { return static_cast<int>(signals_.actuator.command.size()); }
  bool reads_supply() const { return signals_.supply_pressure.value.size() > 0; }
  int rows() const override { return (reads_supply() ? 4 : 3) * samples(); }
  void evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

 private:
  template <typename S>
  void errors(Params<S> params, S* out) const;

  BenchSignals signals_;
  ActuatorLaws laws_;
};

}  // namespace estimation
}  // namespace sms
