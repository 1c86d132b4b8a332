// The spool of the valve with its position measured: what it does with a command (sms/valve.hpp).
//
//   command, late -> second-order lag -> static law (eq. 4.1 or 4.2) -> stops at spool_limit -> position
//
// The command runs straight between its samples. A record begins at rest; its first tenth of a second runs up what
// follows the command and is not compared. The lag is integrated by the classical Runge-Kutta method in steps of no more
// than 0.25 ms.
//
// Residuals: predicted less measured position, m, record after record.
#pragma once

#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

enum class SpoolLaw : int {
  cubic,  // eq. 4.1
  linear  // eq. 4.2
};

// Evenly sampled; arrays of one length.
struct SpoolRecord {
  double step = 0.0;         // s
  Eigen::VectorXd command;   // V
  Eigen::VectorXd position;  // m
};

class SpoolProblem : public Problem {
 public:
  // std::invalid_argument for arrays of different lengths, fewer than 20 samples, or numbers that are not finite.
  SpoolProblem(std::vector<SpoolRecord> records, SpoolLaw law);

  int rows() const override { return rows_; }
  void evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

  // First sample of a record that is compared.
  static int first_compared(const SpoolRecord& record);

 private:
  std::vector<SpoolRecord> records_;
  SpoolLaw law_;
  int rows_ = 0;
};

}  // namespace estimation
}  // namespace sms
