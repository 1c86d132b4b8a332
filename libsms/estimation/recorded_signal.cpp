#include "estimation/recorded_signal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/reflections.hpp"

namespace sms {
namespace estimation {
namespace detail {

double moved_last(const Eigen::VectorXd& signal, int sample, double least) {
  for (int k = sample - 1; k >= 0; --k) {
    const double gone = signal[sample] - signal[k];
    if (std::abs(gone) > least) {
      return gone > 0.0 ? 1.0 : -1.0;
    }
  }
  return 0.0;
}

Eigen::Vector2d beginning(const Eigen::VectorXd& signal, int first, int samples, double step) {
  const int count = std::min<int>(samples, static_cast<int>(signal.size()) - first);
  Eigen::MatrixX3d powers(count, 3);
  for (int k = 0; k < count; ++k) {
    const double t = k * step;
    powers.row(k) << 1.0, t, t * t;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(powers);
  const Eigen::Index rank = qr.nonzeroPivots();
  Eigen::VectorXd fitted = signal.segment(first, count);
  apply_q_transposed(qr, rank, &fitted);
  qr.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(fitted.topRows(rank));
  Eigen::Vector3d powers_of_time = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < rank; ++k) {
    powers_of_time[qr.colsPermutation().indices()[k]] = fitted[k];
  }
  return powers_of_time.head<2>();
}

void check_signal(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples) {
  if (signal.size() != samples) {
    throw std::invalid_argument(record + ": " + name + " has " + std::to_string(signal.size()) +
                                " samples, command has " + std::to_string(samples));
  }
  if (!signal.allFinite()) {
    throw std::invalid_argument(record + ": " + name + " holds a value that is not a finite number");
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
