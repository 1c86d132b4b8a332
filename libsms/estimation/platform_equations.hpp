// The equations of the rig "platform", each fed with measured signals (measured.hpp). Of legs 1 to 3 in turn
//
//   force, N                m (e'' - e'' measured), with the mass m that the mechanism puts on the pistons
//   lower chamber, kg/s     V_a / (R T) (p_a' - p_a' measured), as a flow into it
//   upper chamber, kg/s     the same
//
// and of the whole, where there are sensors, the supply, Pa, the reservoir of the first actuator against its reading, and
// roll and pitch, rad, of the measured extensions against their readings.
//
// An error is what the model has too much; with the other sign it is the term that is missing. The units are those of the
// hidden inputs of platform_plant.hpp.
#pragma once

#include <array>

#include "estimation/measured_actuator.hpp"
#include "estimation/platform_rates.hpp"
#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

struct PlatformSignals {
  double step = 0.0;  // s
  std::array<ActuatorSignals, 3> leg;
  MeasuredSignal supply_pressure;                  // empty: not measured
  MeasuredSignal roll;                             // rad; roll and pitch empty: not measured
  MeasuredSignal pitch;                            // rad
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
};

// For each sample, each equation.
class PlatformEquations : public ProblemOf<LegParams<double>> {
 public:
  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  PlatformEquations(PlatformSignals signals, const ActuatorLaws& laws, MassModel masses);

  int samples() const { return static_cast<int>(signals_.leg[0].command.size()); }
  bool reads_supply() const { return signals_.supply_pressure.value.size() > 0; }
  bool reads_attitude() const { return signals_.roll.value.size() > 0; }
  int rows() const override { return (9 + (reads_supply() ? 1 : 0) + (reads_attitude() ? 2 : 0)) * samples(); }
  void evaluate(const LegParams<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

 private:
  template <typename S>
  void errors(const LegParams<S>& params, S* out) const;

  PlatformSignals signals_;
  ActuatorLaws laws_;
  MassModel masses_;
};

}  // namespace estimation
}  // namespace sms
