// How three pistons moved, as their sensors read it.
#pragma once

#include <array>
#include <vector>

#include "sms/scalar.hpp"

namespace sms {
namespace estimation {

// Extensions and their rates, one a sample.
struct MeasuredMotion {
  std::vector<Vec3<double>> extension;
  std::vector<Vec3<double>> rate;
};

namespace detail {

// Value and slope of every sample of three signals, by a parabola through those around it.
MeasuredMotion smoothed(const std::array<Eigen::VectorXd, 3>& extension, double step);

}  // namespace detail

}  // namespace estimation
}  // namespace sms
