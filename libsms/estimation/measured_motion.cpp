#include "estimation/measured_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sms {
namespace estimation {
namespace detail {
namespace {

constexpr double kSmooth = 0.025;  // s either way

}  // namespace

MeasuredMotion smoothed(const std::array<Eigen::VectorXd, 3>& extension, double step) {
  const int samples = static_cast<int>(extension[0].size());
  const int half = std::max(2, static_cast<int>(std::lround(kSmooth / step)));
  const int count = std::min(samples, 2 * half + 1);
  MeasuredMotion motion;
  for (int k = 0; k < samples; ++k) {
    const int first = std::min(std::max(k - half, 0), samples - count);
    Eigen::MatrixX3d powers(count, 3);
    for (int j = 0; j < count; ++j) {
      const double t = (first + j - k) * step;
      powers.row(j) << 1.0, t, t * t;
    }
    const Eigen::LDLT<Eigen::Matrix3d> normal = (powers.transpose() * powers).ldlt();
    Vec3<double> value, rate;
    for (int i = 0; i < 3; ++i) {
      const auto around = extension[static_cast<std::size_t>(i)].segment(first, count);
      const Eigen::Vector3d fitted = normal.solve(powers.transpose() * around);
      value(i) = fitted[0];
      rate(i) = fitted[1];
    }
    motion.extension.push_back(value);
    motion.rate.push_back(rate);
  }
  return motion;
}

}  // namespace detail
}  // namespace estimation
}  // namespace sms
