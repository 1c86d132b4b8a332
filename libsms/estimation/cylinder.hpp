// The rig "cylinder": one cylinder is moved, its extension, chamber pressures and rod force are measured.
//
// The force balance (piston.hpp) is fed with the measured motion and pressures, corrected by the sensors' errors, and
// predicts what the load cell reads. Each sample stands alone, but for the laws of friction with a memory: there the
// seals' deflection is followed from sample to sample, from rest. Over one step the share that slides and the strength
// are held, and the deflection takes its exact exponential, so that a stiff seal needs no small steps.
#pragma once

#include "estimation/problem.hpp"
#include "sms/force_balance.hpp"

namespace sms {
namespace estimation {

// The samples of one record that are compared, as read (sensor errors and all). Arrays of one length.
struct CylinderRecord {
  Eigen::VectorXd extension;       // m
  Eigen::VectorXd velocity;        // m/s, derived from the extension
  Eigen::VectorXd acceleration;    // m/s^2, derived from the extension
  Eigen::VectorXd pressure_lower;  // Pa, absolute or gauge as the flag says
  Eigen::VectorXd pressure_upper;  // Pa; empty: the chamber is open to ambient
  Eigen::VectorXd rod_force;       // N
  Eigen::VectorXd time;            // s, rising; needed by laws with a memory only, otherwise it may be empty
  bool gauge_lower = false;        // the sensor reads against ambient
  bool gauge_upper = false;
};

class CylinderProblem : public Problem {
 public:
  // std::invalid_argument if the arrays of a record differ in length or hold a value that is not finite, or time is
  // missing or does not rise for a law that needs it.
  explicit CylinderProblem(std::vector<CylinderRecord> records, FrictionLaw law = FrictionLaw::acceleration_dependent);

  int rows() const override { return rows_; }
  void evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

 private:
  std::vector<CylinderRecord> records_;
  FrictionLaw law_;
  int rows_ = 0;
};

}  // namespace estimation
}  // namespace sms
