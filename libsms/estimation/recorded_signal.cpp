#include "estimation/recorded_signal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/reflections.hpp"

namespace sms {
namespace estimation {
namespace detail {
namespace {

// The value nearest to a sample that is a number.
double nearest(const Eigen::VectorXd& signal, int sample) {
  const int size = static_cast<int>(signal.size());
  for (int away = 0; away < size; ++away) {
    for (const int k : {sample - away, sample + away}) {
      if (k >= 0 && k < size && std::isfinite(signal[k])) {
        return signal[k];
      }
    }
  }
  return 0.0;
}

void check_length(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples) {
  if (signal.size() != samples) {
    throw std::invalid_argument(record + ": " + name + " has " + std::to_string(signal.size()) +
                                " samples, command has " + std::to_string(samples));
  }
}

}  // namespace

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
  const int end = std::min<int>(first + samples, static_cast<int>(signal.size()));
  Eigen::MatrixX3d powers(end - first, 3);
  Eigen::VectorXd fitted(end - first);
  int count = 0;
  for (int k = first; k < end; ++k) {
    if (std::isfinite(signal[k])) {
      const double t = (k - first) * step;
      powers.row(count) << 1.0, t, t * t;
      fitted[count++] = signal[k];
    }
  }
  if (count < std::min(3, end - first)) {
    return {nearest(signal, first), 0.0};
  }
  powers.conservativeResize(count, 3);
  fitted.conservativeResize(count);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(powers);
  const Eigen::Index rank = qr.nonzeroPivots();
  apply_q_transposed(qr, rank, &fitted);
  qr.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(fitted.topRows(rank));
  Eigen::Vector3d powers_of_time = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < rank; ++k) {
    powers_of_time[qr.colsPermutation().indices()[k]] = fitted[k];
  }
  return powers_of_time.head<2>();
}

void check_signal(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples) {
  check_length(record, name, signal, samples);
  if (!signal.allFinite()) {
    throw std::invalid_argument(record + ": " + name + " holds a value that is not a finite number");
  }
}

void check_readings(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples) {
  check_length(record, name, signal, samples);
  if (signal.array().isInf().any()) {
    throw std::invalid_argument(record + ": " + name + " holds a value that is not a finite number");
  }
  if (samples > 0 && signal.array().isNaN().all()) {
    throw std::invalid_argument(record + ": " + name + " is nowhere within the range of its sensor");
  }
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
