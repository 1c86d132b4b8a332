// Mechanisms given by data: the built-in platform as one of them, published ones, and what must come out again.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "parallel_cases.hpp"
#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define SMS_TEST_JETS
#endif

using namespace sms_test;

namespace {

const sms::Geometry<double> geometry = sms::make_geometry(sms::Params<double>());
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

sms_status forward(const Parallel& m, const double* length, const V6& start, V6& found,
                   sms::Search<double>* how = nullptr) {
  sms::Search<double> search;
  sms::PlatformPose<double> pose;
  const sms_status status = sms::parallel_forward(m, length, sms::pose_of(start), pose, search);
  if (status == SMS_OK) found = sms::coordinates_of(pose);
  if (how != nullptr) *how = search;
  return status;
}

V6 random_coordinates(Random& random, const V6& middle, double lengths, double angles) {
  V6 c = middle;
  for (int k = 0; k < 6; ++k) c(k) += random.uniform(-1.0, 1.0) * (k < 3 ? lengths : angles);
  return c;
}

V6 six(double x, double y, double z, double roll, double pitch, double yaw) {
  V6 c;
  c << x, y, z, roll, pitch, yaw;
  return c;
}

}  // namespace

TEST_CASE("parallel: the built-in platform given by data is the built-in platform") {
  const Parallel m = built_in(geometry);
  Random random;
  const V6 rest = coordinates_in_parallel(sms::rest_pose(geometry));
  double worst_inverse = 0.0, worst_forward = 0.0;
  for (int i = 0; i < sms_test::count; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, geometry);
    const sms::Pose<double> pose = pose_at(geometry, q);
    V6 found = rest;
    found(2) = -q(2), found(3) = q(0), found(4) = q(1);
    sms::Search<double> search;
    REQUIRE(sms::complete_coordinates(m, found, search) == SMS_OK);
    double length[6];
    sms::leg_lengths(m, sms::pose_of(found), length);
    const Vec extension = Vec(length[0], length[1], length[2]) - geometry.actuator_length;
    worst_inverse = std::max({worst_inverse, largest(extension - extension_at(geometry, q)),
                              largest(found - coordinates_in_parallel(pose))});
    V6 again;
    REQUIRE(forward(m, length, rest, again, &search) == SMS_OK);
    CHECK(search.residual < 1e-14);
    worst_forward = std::max(worst_forward, largest(again - coordinates_in_parallel(pose)));
  }
  MESSAGE("worst difference, m or rad: inverse " << worst_inverse << ", forward " << worst_forward);
  CHECK(worst_inverse < 1e-12);
  CHECK(worst_forward < 1e-12);
}

TEST_CASE("parallel: Dietmaier's hexapod has the 40 real postures of his paper") {
  double length[6];
  const Parallel m = dietmaier(length);
  Random random;
  std::vector<sms::PlatformPose<double>> postures;
  for (int i = 0; i < 20000; ++i) {  // a thousand find them all; the others would find a 41st
    const V6 start = random_coordinates(random, V6::Zero(), 1.2, 3.1416);
    sms::PlatformPose<double> pose;
    sms::Search<double> search;
    if (sms::parallel_forward(m, length, sms::pose_of(start), pose, search) != SMS_OK) continue;
    double again[6];
    sms::leg_lengths(m, pose, again);
    for (int k = 0; k < 6; ++k) REQUIRE(std::abs(again[k] - length[k]) < 1e-11);
    bool known = false;
    for (const auto& p : postures) {
      known = known || (largest(p.rotation - pose.rotation) < 1e-4 && largest(p.position - pose.position) < 1e-4);
    }
    if (!known) postures.push_back(pose);
  }
  CHECK(postures.size() == 40);
}

TEST_CASE("parallel: lengths to pose and back, of a hexapod and a 3-RPS, from another pose") {
  Random random;
  const Parallel hex = hexapod(), rps = three_rps();
  double worst = 0.0;
  int steps = 0;
  for (int i = 0; i < sms_test::count; ++i) {
    const double size = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-8 : 1.0;
    const V6 middle = six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
    V6 c = random_coordinates(random, middle, 0.15 * size, 0.25 * size), found;
    double length[6];
    sms::Search<double> search;
    sms::leg_lengths(hex, sms::pose_of(c), length);
    REQUIRE(forward(hex, length, middle, found, &search) == SMS_OK);
    worst = std::max(worst, largest(found - c));
    steps = std::max(steps, search.iterations);

    c = middle;
    c(2) += 0.15 * size * random.uniform(-1.0, 1.0);
    c(3) = 0.25 * size * random.uniform(-1.0, 1.0);
    c(4) = 0.25 * size * random.uniform(-1.0, 1.0);
    REQUIRE(sms::complete_coordinates(rps, c, search) == SMS_OK);
    CHECK(search.residual < 1e-14);
    sms::leg_lengths(rps, sms::pose_of(c), length);
    REQUIRE(forward(rps, length, middle, found, &search) == SMS_OK);
    worst = std::max(worst, largest(found - c));
    steps = std::max(steps, search.iterations);
  }
  MESSAGE("worst round trip " << worst << " m or rad, at most " << steps << " steps");
  CHECK(worst < 1e-12);
  CHECK(steps <= 8);
}

TEST_CASE("parallel: a 3-RPS with its joints on circles obeys the closed form of its parasitic motion") {
  // The planes of three legs at 120 degrees: x, y and yaw of R = Rz(yaw) Ry Rx follow from roll and pitch alone. From
  // n_i . (d + R p_i) = 0, with the upper left 2x2 block A of R: A(1,0) = A(0,1), x = r (A(0,0) - A(1,1)) / 2,
  // y = -r A(0,1).
  const Parallel m = three_rps();
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    V6 c = six(0.0, 0.0, random.uniform(0.8, 1.2), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0.0);
    sms::Search<double> search;
    REQUIRE(sms::complete_coordinates(m, c, search) == SMS_OK);
    const Mat r = sms::pose_of(c).rotation;
    CHECK(std::abs(r(1, 0) - r(0, 1)) < 1e-14);
    CHECK(std::abs(c(0) - 0.15 * (r(0, 0) - r(1, 1))) < 1e-14);
    CHECK(std::abs(c(1) + 0.3 * r(0, 1)) < 1e-14);
  }
}

TEST_CASE("parallel: the Jacobian against differences") {
  Random random;
  for (const Parallel& m : {hexapod(), three_rps(), built_in(geometry)}) {
    sms::LegEquation equation[6];
    REQUIRE(sms::equations_of(m, equation) == 6);
    for (int i = 0; i < 100; ++i) {
      const V6 c = random_coordinates(random, six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0), 0.1, 0.3);
      const sms::PlatformPose<double> pose = sms::pose_of(c);
      sms::LegVectors<double> v;
      sms::locate_legs(m, pose, v);
      const sms::Mat6<double> jacobian = sms::parallel_jacobian(m, equation, v);
      constexpr double h = 1e-6;
      for (int k = 0; k < 6; ++k) {
        double value[2][6];
        for (int side = 0; side < 2; ++side) {
          sms::PlatformPose<double> moved = pose;
          sms::move_by(V6((side == 0 ? -h : h) * V6::Unit(k)), moved);
          double length[6];
          sms::leg_lengths(m, moved, length);
          sms::locate_legs(m, moved, v);
          for (int e = 0; e < 6; ++e) {
            const int leg = equation[e].leg;
            value[side][e] = equation[e].is_plane ? m.leg[leg].normal.dot(v.link[leg]) : length[leg];
          }
        }
        for (int e = 0; e < 6; ++e) {
          CHECK(std::abs((value[1][e] - value[0][e]) / (2 * h) - jacobian(e, k)) < 1e-9);
        }
      }
    }
  }
}

TEST_CASE("parallel: angles come back from a rotation, and a turn is a rotation") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const V6 c = six(0.0, 0.0, 0.0, random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5), random.uniform(-3.1, 3.1));
    const sms::PlatformPose<double> pose = sms::pose_of(c);
    CHECK(largest(sms::coordinates_of(pose) - c) < 1e-13);
    const Mat turned = sms::turned_by(random_vector(random, -1.0, 1.0), pose.rotation);
    CHECK(largest(turned * turned.transpose() - Mat::Identity()) < 2e-15);
    const Vec at(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
    CHECK(largest(sms::full_rotation(at(0), at(1), at(2)) - sms::attitude(at(0), at(1), at(2)).rotation) < 1e-15);
  }
}

TEST_CASE("parallel: a singular pose on a way is found where the determinant is zero") {
  // A level platform with the hexapod's symmetry is singular when turned by a quarter about the vertical (Fichter,
  // A Stewart platform-based manipulator: general theory and practical construction, 1986).
  const Parallel m = hexapod();
  sms::LegEquation equation[6];
  REQUIRE(sms::equations_of(m, equation) == 6);
  const V6 level = six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  V6 turned = level;
  sms::Crossing<double> crossing;
  turned(5) = 0.5;
  REQUIRE(sms::crossing_between(m, level, turned, crossing) == SMS_OK);
  CHECK_FALSE(crossing.found);
  turned(5) = 2.0;
  REQUIRE(sms::crossing_between(m, level, turned, crossing) == SMS_OK);
  REQUIRE(crossing.found);
  MESSAGE("singular at a yaw of " << crossing.coordinates(5) << " rad");
  CHECK(std::abs(crossing.coordinates(5) - 0.5 * 3.14159265358979323846) < 1e-9);
  const sms::Distance<double> there = sms::distance_from_singularity(m, equation, sms::pose_of(crossing.coordinates));
  const sms::Distance<double> here = sms::distance_from_singularity(m, equation, sms::pose_of(level));
  CHECK(std::abs(there.determinant) < 1e-9 * std::abs(here.determinant));
  CHECK(there.condition > 1e6);
}

TEST_CASE("parallel: what cannot be is refused, and leaves the output as it was") {
  const Parallel m = hexapod();
  const V6 level = six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  double length[6];
  sms::leg_lengths(m, sms::pose_of(level), length);
  V6 found = V6::Constant(7.0);
  sms::Search<double> search;
  length[2] = kNan;
  CHECK(forward(m, length, level, found) == SMS_NOT_A_NUMBER);
  length[2] = -1.0;
  CHECK(forward(m, length, level, found) == SMS_OUT_OF_WORKSPACE);
  for (double& l : length) l = 1.0;
  length[0] = 30.0;  // no such triangle
  CHECK(forward(m, length, level, found, &search) != SMS_OK);
  sms::leg_lengths(m, sms::pose_of(level), length);
  V6 start = level;
  start(5) = 0.5 * 3.14159265358979323846;
  CHECK(forward(m, length, start, found, &search) != SMS_OK);  // beyond or at a singular pose
  start(0) = kNan;
  CHECK(forward(m, length, start, found) == SMS_NOT_A_NUMBER);
  CHECK(found == V6::Constant(7.0));

  Parallel five = m;
  five.legs = 5;
  CHECK(forward(five, length, level, found) == SMS_OUT_OF_RANGE);
  V6 c = six(0.0, 0.0, 5.0, 0.0, 0.0, 0.0);  // the rods do not reach
  CHECK(sms::complete_coordinates(built_in(geometry), c, search) != SMS_OK);
  CHECK(c == six(0.0, 0.0, 5.0, 0.0, 0.0, 0.0));
}

TEST_CASE("parallel: float stays within 2e-5 of double") {
  const Parallel m = hexapod();
  const sms::ParallelMechanism<float> mf = sms::cast<float>(m);
  const V6 level = six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const V6 c = random_coordinates(random, level, 0.15, 0.25);
    double length[6];
    sms::leg_lengths(m, sms::pose_of(c), length);
    float lengthf[6];
    for (int k = 0; k < 6; ++k) lengthf[k] = float(length[k]);
    sms::Search<float> search;
    sms::PlatformPose<float> pose;
    REQUIRE(sms::parallel_forward(mf, lengthf, sms::pose_of(sms::Vec6<float>(level.cast<float>())), pose, search) ==
            SMS_OK);
    CHECK(largest(sms::coordinates_of(pose).cast<double>() - c) < 2e-5);
  }
}

#ifdef SMS_TEST_JETS
TEST_CASE("parallel, Jets: the pose's derivatives by the lengths are the Jacobian's inverse, and differences") {
  using Jet = ceres::Jet<double, 6>;
  const V6 level = six(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  Random random;
  const Parallel m = hexapod();
  for (int i = 0; i < 100; ++i) {
    const V6 c = random_coordinates(random, level, 0.15, 0.25);
    double length[6];
    sms::leg_lengths(m, sms::pose_of(c), length);
    Jet seeded[6];
    for (int k = 0; k < 6; ++k) seeded[k] = Jet(length[k], k);
    sms::PlatformPose<Jet> pose;
    sms::Search<double> search;
    REQUIRE(sms::parallel_forward(m, seeded, sms::pose_of(level), pose, search) == SMS_OK);
    const sms::Vec6<Jet> found = sms::coordinates_of(pose);
    constexpr double h = 1e-6;
    for (int k = 0; k < 6; ++k) {
      V6 lower, upper;
      const double at = length[k];
      length[k] = at - h;
      REQUIRE(forward(m, length, level, lower) == SMS_OK);
      length[k] = at + h;
      REQUIRE(forward(m, length, level, upper) == SMS_OK);
      length[k] = at;
      for (int j = 0; j < 6; ++j) {
        CHECK(std::abs((upper(j) - lower(j)) / (2 * h) - found(j).v(k)) < 1e-7);
      }
    }
  }
}
#endif
