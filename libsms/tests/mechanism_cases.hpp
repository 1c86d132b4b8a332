// Random cases of the mechanism: poses inside the stroke, reached from nowhere in particular.
#pragma once

#include <doctest/doctest.h>

#include "random_cases.hpp"
#include "sms/forward_kinematics.hpp"
#include "sms/inverse_kinematics.hpp"

namespace sms_test {

using Vec = sms::Vec3<double>;
using Mat = sms::Mat3<double>;

template <typename Matrix>
double largest(const Matrix& m) {
  return m.cwiseAbs().maxCoeff();
}

inline Vec random_vector(Random& random, double lower, double upper) {
  return {random.uniform(lower, upper), random.uniform(lower, upper), random.uniform(lower, upper)};
}

inline Vec coordinates(const sms::Pose<double>& pose) { return {pose.roll, pose.pitch, pose.height}; }

inline sms::Pose<double> pose_at(const sms::Geometry<double>& g, const Vec& q) {
  sms::Pose<double> pose = sms::rest_pose(g);
  Vec extension;
  REQUIRE(sms::inverse_kinematics(g, q, sms::rest_pose(g), pose, extension) == sms_status::SMS_OK);
  return pose;
}

inline Vec extension_at(const sms::Geometry<double>& g, const Vec& q) {
  sms::Pose<double> pose;
  Vec extension;
  REQUIRE(sms::inverse_kinematics(g, q, sms::rest_pose(g), pose, extension) == sms_status::SMS_OK);
  return extension;
}

inline sms::Pose<double> pose_of_extension(const sms::Geometry<double>& g, const Vec& extension) {
  sms::Pose<double> pose;
  REQUIRE(sms::forward_kinematics(g, extension, sms::rest_pose(g), pose) == sms_status::SMS_OK);
  return pose;
}

inline sms::Pose<double> random_pose(Random& random, const sms::Geometry<double>& g) {
  return pose_of_extension(g, random_vector(random, 0.0, g.stroke));
}

// Level, next to level, anywhere: the three regimes in which an equation can go wrong in different ways.
inline Vec coordinates_in_regime(int regime, Random& random, const sms::Geometry<double>& g) {
  if (regime == 0) return {0.0, 0.0, 0.5};
  if (regime == 1) return {1e-8, -1e-8, 0.5 + 1e-8};
  return coordinates(random_pose(random, g));
}

}  // namespace sms_test
