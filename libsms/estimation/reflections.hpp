// Q of a QR decomposition with few columns, one reflection after the other. Eigen's own product has a second way, for many
// columns at once, which no matrix here is large enough to go, and which costs a file ten seconds to compile.
#pragma once

#include <Eigen/QR>

namespace sms {
namespace estimation {
namespace detail {

template <typename Matrix, typename Dense>
void reflect(const Eigen::ColPivHouseholderQR<Matrix>& qr, Eigen::Index k, Dense* dense) {
  Eigen::VectorXd work(dense->cols());
  const Eigen::Index rows = qr.rows() - k;
  const auto essential = qr.matrixQR().col(k).tail(rows - 1);
  dense->bottomRightCorner(rows, dense->cols()).applyHouseholderOnTheLeft(essential, qr.hCoeffs()[k], work.data());
}

// dense = Q dense, and Q' dense, with the first `length` reflections.
template <typename Matrix, typename Dense>
void apply_q(const Eigen::ColPivHouseholderQR<Matrix>& qr, Eigen::Index length, Dense* dense) {
  for (Eigen::Index k = length - 1; k >= 0; --k) {
    reflect(qr, k, dense);
  }
}

template <typename Matrix, typename Dense>
void apply_q_transposed(const Eigen::ColPivHouseholderQR<Matrix>& qr, Eigen::Index length, Dense* dense) {
  for (Eigen::Index k = 0; k < length; ++k) {
    reflect(qr, k, dense);
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
