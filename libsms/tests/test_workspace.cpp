// Workspace: what is known of this machine's reach, and that the margins mean what they say.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanism_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/workspace.hpp"

using namespace sms_test;

namespace {

const sms::Params<double> params;
const sms::Geometry<double> geometry = sms::make_geometry(params);
constexpr double kDegree = 0.017453292519943295;

double box_margin(double height, double roll, double pitch) {
  double margin = 0.0;
  REQUIRE(sms::rectangle_margin(geometry, height, roll * kDegree, pitch * kDegree, margin) == SMS_OK);
  return margin;
}

double reach_in(double height, double roll, double pitch) {
  double angle = 0.0;
  REQUIRE(sms::reach(geometry, height, roll, pitch, angle) == SMS_OK);
  return angle / kDegree;
}

}  // namespace

TEST_CASE("at 0.5 m each axis alone reaches 9.7 deg of roll, 8.5 deg of pitch") {
  CHECK(std::min(reach_in(0.5, 1.0, 0.0), reach_in(0.5, -1.0, 0.0)) == doctest::Approx(9.7).epsilon(0.005));
  CHECK(std::min(reach_in(0.5, 0.0, 1.0), reach_in(0.5, 0.0, -1.0)) == doctest::Approx(8.5).epsilon(0.005));
}

TEST_CASE("+-6 by +-6 deg fits between 0.491 and 0.506 m; +-8 by +-4 deg at no height") {
  double lowest = 1.0, highest = 0.0, best = -1.0;
  for (int i = 300; i <= 700; ++i) {
    const double height = 1e-3 * i;
    if (box_margin(height, 6.0, 6.0) >= 0.0) {
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    best = std::max(best, box_margin(height, 8.0, 4.0));
  }
  CHECK(lowest == doctest::Approx(0.491));
  CHECK(highest == doctest::Approx(0.506));
  MESSAGE("+-8 by +-4 deg lacks " << -1e3 * best << " mm of stroke at its best height");
  CHECK(best < -0.009);
}

TEST_CASE("the edges of a rectangle are its worst places") {
  Random random;
  for (int i = 0; i < 20; ++i) {
    const double height = random.uniform(0.4, 0.6), roll = random.uniform(1.0, 6.0), pitch = random.uniform(1.0, 6.0);
    const double margin = box_margin(height, roll, pitch);
    for (int k = 0; k < sms_test::count / 100; ++k) {
      double inside = 0.0;
      const Vec q(random.uniform(-roll, roll) * kDegree, random.uniform(-pitch, pitch) * kDegree, height);
      REQUIRE(sms::stroke_margin_at(geometry, q, inside) == SMS_OK);
      CHECK(inside >= margin - 1e-6);
    }
  }
}

TEST_CASE("reach ends where the stroke does") {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const double height = random.uniform(0.31, 0.68), direction = random.uniform(0.0, 6.283);
    double angle = 0.0, margin = 1.0;
    REQUIRE(sms::reach(geometry, height, std::cos(direction), std::sin(direction), angle) == SMS_OK);
    const Vec q(angle * std::cos(direction), angle * std::sin(direction), height);
    REQUIRE(sms::stroke_margin_at(geometry, q, margin) == SMS_OK);
    CHECK(margin >= 0.0);
    CHECK(margin < 1e-9);
  }
  double angle = 7.0;
  CHECK(sms::reach(geometry, 0.75, 1.0, 0.0, angle) == SMS_OUT_OF_WORKSPACE);
  CHECK(sms::reach(geometry, 5.0, 1.0, 0.0, angle) == SMS_OUT_OF_WORKSPACE);
  CHECK(angle == doctest::Approx(7.0).epsilon(1e-300));
}

TEST_CASE("condition numbers: no singularity is near") {
  Random random;
  double panhard_lowest = 9.0, panhard_highest = 0.0, links_lowest = 9.0, links_highest = 0.0;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    sms::Motion<double> m;
    sms::place(geometry, random_pose(random, geometry), m);
    const sms::Conditioning<double> c = sms::conditioning(m);
    panhard_lowest = std::min(panhard_lowest, c.panhard);
    panhard_highest = std::max(panhard_highest, c.panhard);
    links_lowest = std::min(links_lowest, c.links);
    links_highest = std::max(links_highest, c.links);
  }
  CHECK(panhard_lowest > 1.02);
  CHECK(panhard_highest < 1.12);
  CHECK(links_lowest > 1.53);
  CHECK(links_lowest < 1.545);
  CHECK(links_highest > 1.66);
  CHECK(links_highest < 1.75);
}

TEST_CASE("eigenvalues of a symmetric matrix: residual and orthogonality") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    Eigen::Matrix<double, 6, 6> a;
    for (int k = 0; k < 36; ++k) a(k / 6, k % 6) = random.uniform(-1.0, 1.0);
    const Eigen::Matrix<double, 6, 6> symmetric = a + a.transpose();
    const sms::SymmetricEigen<double, 6> e = sms::symmetric_eigen<double, 6>(symmetric);
    CHECK(largest(symmetric * e.vectors - e.vectors * e.values.asDiagonal()) < 5e-14);
    CHECK(largest(e.vectors.transpose() * e.vectors - Eigen::Matrix<double, 6, 6>::Identity()) < 3e-14);
    for (int k = 0; k < 5; ++k) CHECK(e.values(k) <= e.values(k + 1));
  }
  const sms::SymmetricEigen<double, 3> degenerate = sms::symmetric_eigen<double, 3>(Mat::Identity());
  CHECK(largest(degenerate.values - Vec::Ones()) < 1e-300);
}

TEST_CASE("joint angles: none at rest, 16 deg at most") {
  sms::Motion<double> m;
  sms::place(geometry, sms::rest_pose(geometry), m);
  sms::JointAngles<double> angles = sms::joint_angles(geometry, m);
  for (int i = 0; i < 6; ++i) CHECK(angles.base[i] + angles.platform[i] < 1e-7);
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    sms::place(geometry, random_pose(random, geometry), m);
    angles = sms::joint_angles(geometry, m);
    for (int k = 0; k < 6; ++k) {
      CHECK(angles.base[k] < 16.0 * kDegree);
      CHECK(angles.platform[k] < 16.0 * kDegree);
    }
  }
}

TEST_CASE("force: 0.4 MPa gauge carries the payload level with a third of what it has") {
  const sms::ForceRange<double> range = sms::force_range(params, params.ambient_pressure + 0.4e6);
  CHECK(range.push == doctest::Approx(0.4e6 * 7.854e-3).epsilon(1e-4));
  CHECK(range.pull == doctest::Approx(0.4e6 * 7.363e-3).epsilon(1e-4));
  const sms::Mechanism<double> mechanism = sms::make_mechanism(params, sms::MassModel::corrected);
  sms::DynamicsTerms<double> t;
  REQUIRE(sms::dynamics_at(mechanism, Vec(0.0, 0.0, 0.5), Vec(Vec::Zero()), sms::rest_pose(geometry), t) == SMS_OK);
  CHECK(sms::force_share(range, sms::holding_force(t, Vec(Vec::Zero()))) ==
        doctest::Approx(1042.5 / 3141.6).epsilon(1e-3));
  CHECK(sms::force_share(range, Vec(0.0, 0.0, -range.pull)) == doctest::Approx(1.0));
}
