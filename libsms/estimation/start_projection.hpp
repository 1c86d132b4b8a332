// The linear algebra of one window (shooting.hpp), compiled once for all plants: its numbers have no derivatives.
#pragma once

#include <Eigen/QR>

#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

// Q and R of de/dz, in units of `scale`; one direction of z may leave no trace.
class StartProjection {
 public:
  StartProjection(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& scale);

  // What of the first `width` columns no initial state makes, (I - Q Q') columns; written to `out` from a row and a column
  // of it on.
  void off(const Eigen::MatrixXd& columns, Eigen::Index width, Eigen::Index row, Eigen::Index column,
           RowMatrix* out) const;

  // How the best state moves, when the errors change by these columns at the state that was; likewise.
  void move(const Eigen::MatrixXd& columns, Eigen::Index width, Eigen::Index column, Eigen::MatrixXd* out) const;

 private:
  Eigen::VectorXd scale_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> scaled_;
  Eigen::MatrixXd basis_;  // Q
};

// A step of Levenberg and Marquardt from a state, and how much of chi-square it promises to take.
struct StartStep {
  Eigen::VectorXd move;
  double promised;
};

// The damping is relative to the size of each number, so that one without a trace stays where it is.
StartStep start_step(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& residual, const Eigen::VectorXd& scale,
                     double damping);

}  // namespace estimation
}  // namespace sms
