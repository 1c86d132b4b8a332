// The rig "tank": one charge or one discharge of a tank through a component (sms/flow_test.hpp).
//
// The test is integrated from the moment of opening with the classical Runge-Kutta method and read between the steps by
// cubic Hermite polynomials, so that the moment of opening, a parameter, shifts the curve with an exact derivative. The
// steps are chosen once, from the record: a sixtieth of the time in which the pressure made 63 % of its way, and eight
// over the opening. Once nothing changes any more, nothing is integrated any more.
//
// Residuals: the pressures in Pa, then the temperatures in K where they were measured.
#pragma once

#include "estimation/problem.hpp"
#include "sms/flow_test.hpp"

namespace sms {
namespace estimation {

struct TankRecord {
  Eigen::VectorXd time;         // s, rising
  Eigen::VectorXd pressure;     // Pa absolute, as read
  Eigen::VectorXd temperature;  // K, as read by the thermocouple; empty: not measured
  Eigen::VectorXd supply;       // Pa absolute, measured before the component; empty: params.supply_pressure
  bool charge = true;           // from the supply; otherwise a discharge to ambient
};

class TankProblem : public Problem {
 public:
  // std::invalid_argument if the arrays differ in length, hold a value that is not finite, or time does not rise.
  TankProblem(TankRecord record, FlowTestKind kind);

  int rows() const override { return static_cast<int>(record_.pressure.size() + record_.temperature.size()); }
  void evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

  double step() const { return step_; }  // s

 private:
  TankRecord record_;
  FlowTestKind kind_;
  double step_ = 0.0;
};

}  // namespace estimation
}  // namespace sms
