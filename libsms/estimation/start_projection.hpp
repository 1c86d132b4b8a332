// The linear algebra of one window (shooting.hpp), compiled once for all plants: its numbers have no derivatives.
#pragma once

#include <Eigen/QR>

namespace sms {
namespace estimation {

// Q and R of de/dz, in units of `scale`; one direction of z may leave no trace.
class StartProjection {
 public:
  StartProjection(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& scale);

  // What of `columns` no initial state makes: (I - Q Q') columns.
  Eigen::MatrixXd off(const Eigen::MatrixXd& columns) const;

  // How the best state moves, when the errors change by `columns` at the state that was.
  Eigen::MatrixXd move(const Eigen::MatrixXd& columns) const;

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
