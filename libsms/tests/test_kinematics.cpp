// Kinematics: what goes in comes out again, to rounding, from any start and in every scalar.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "mechanism_cases.hpp"
#include "sms/motion.hpp"
#include "sms/pair.hpp"
#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define SMS_TEST_JETS
#endif

using namespace sms_test;

namespace {

const sms::Geometry<double> geometry = sms::make_geometry(sms::Params<double>());
const sms::Geometry<float> geometryf = sms::make_geometry(sms::Params<float>());
constexpr double kDegree = 0.017453292519943295;

sms::Motion<double> motion_at(const Vec& q, const Vec& rate) {
  sms::Motion<double> m;
  sms::place(geometry, pose_at(geometry, q), m);
  sms::move(rate, m);
  return m;
}

template <typename Numbers>
bool same_bits(const Numbers& a, const Numbers& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename S>
void check_pairs() {
  Random random;
  const auto any = [&] { return S(random.uniform(0.1, 2.0)); };
  for (int i = 0; i < 1000; ++i) {
    const S a = any(), b = any(), c = any(), d = any();
    const sms::Pair<S> x(a, b), y(c, d);
    const auto is = [](const sms::Pair<S>& pair, const S& actuator, const S& rod) {
      return same_bits(pair.actuator(), actuator) && same_bits(pair.rod(), rod);
    };
    using std::sqrt;
    CHECK(is(x + y, a + c, b + d));
    CHECK(is(x - y, a - c, b - d));
    CHECK(is(x * y, a * c, b * d));
    CHECK(is(x / y, a / c, b / d));
    CHECK(is(-x, -a, -b));
    CHECK(is(sqrt(x), sqrt(a), sqrt(b)));
    CHECK(same_bits(x.sum(), a + b));
  }
}

}  // namespace

TEST_CASE("lengths follow from the rest pose, which has zero extension and no yaw") {
  CHECK(largest(geometry.actuator_length - Vec::Constant(0.7240001)) < 1e-7);
  CHECK(largest(geometry.panhard_length - Vec(1.55486117, 1.55479908, 1.55486010)) < 1e-8);
  const Vec rest(0.0, 0.0, 0.297561);
  CHECK(largest(extension_at(geometry, rest)) < 1e-15);
  CHECK(std::abs(pose_at(geometry, rest).yaw) < 1e-15);

  sms::Params<double> p;
  p.actuator_length_offset_2 = 0.001;
  p.panhard_length_offset_3 = -0.002;
  const sms::Geometry<double> other = sms::make_geometry(p);
  CHECK(other.actuator_length(1) == doctest::Approx(geometry.actuator_length(1) + 0.001));
  CHECK(other.panhard_length(2) == doctest::Approx(geometry.panhard_length(2) - 0.002));
}

TEST_CASE("level at 0.5 m: mid-stroke, with a yaw of 2.3026 deg; over the stroke 0 to 6.6 deg") {
  const Vec mid(0.0, 0.0, 0.5);
  CHECK(largest(extension_at(geometry, mid) - Vec::Constant(0.20042)) < 1e-5);
  CHECK(pose_at(geometry, mid).yaw == doctest::Approx(2.3026 * kDegree).epsilon(2e-5));
  const sms::Pose<double> top = pose_of_extension(geometry, Vec::Constant(0.4));
  CHECK(top.yaw == doctest::Approx(6.6 * kDegree).epsilon(0.01));
}

TEST_CASE("sine and cosine of the power series are exact to rounding") {
  Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double angle = random.uniform(-0.6, 0.6);
    const sms::SineCosine<double> s = sms::sine_cosine(angle);
    CHECK(std::abs(s.sine - std::sin(angle)) <= 4e-16 * std::abs(angle));
    CHECK(std::abs(s.cosine - std::cos(angle)) <= 2.3e-16);
    const float anglef = static_cast<float>(angle);
    const sms::SineCosine<float> f = sms::sine_cosine(anglef);
    CHECK(std::abs(f.sine - std::sin(anglef)) <= 2.4e-7f * std::abs(anglef));
    CHECK(std::abs(f.cosine - std::cos(anglef)) <= 1.2e-7f);
  }
}

TEST_CASE("extensions to pose and back, from the pose of another random case: rounding only") {
  Random random;
  sms::Pose<double> start = sms::rest_pose(geometry);
  double worst = 0.0, residual = 0.0;
  int steps = 0;
  for (int i = 0; i < sms_test::count; ++i) {
    const Vec extension = random_vector(random, 0.0, geometry.stroke);
    sms::Pose<double> pose, again;
    Vec back;
    sms::Convergence<double> forward, inverse;
    REQUIRE(sms::forward_kinematics(geometry, extension, start, pose, &forward) == SMS_OK);
    REQUIRE(sms::inverse_kinematics(geometry, coordinates(pose), start, again, back, &inverse) == SMS_OK);
    worst = std::max({worst, largest(back - extension), std::abs(again.yaw - pose.yaw), std::abs(again.x - pose.x),
                      std::abs(again.y - pose.y)});
    residual = std::max({residual, forward.residual, inverse.residual});
    steps = std::max({steps, forward.iterations, inverse.iterations});
    start = pose;
  }
  CHECK(worst < 4e-15);
  CHECK(residual < 2e-15);
  CHECK(steps <= 8);
}

TEST_CASE("who does not ask how the iteration ended gets the same pose, to the bit") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec extension = random_vector(random, 0.0, geometry.stroke);
    sms::Pose<double> pose, asked;
    Vec back, asked_back;
    sms::Convergence<double> convergence;
    REQUIRE(sms::forward_kinematics(geometry, extension, sms::rest_pose(geometry), pose) == SMS_OK);
    REQUIRE(sms::forward_kinematics(geometry, extension, sms::rest_pose(geometry), asked, &convergence) == SMS_OK);
    CHECK(same_bits(pose, asked));
    const Vec q = coordinates(pose);
    REQUIRE(sms::inverse_kinematics(geometry, q, sms::rest_pose(geometry), pose, back) == SMS_OK);
    REQUIRE(sms::inverse_kinematics(geometry, q, sms::rest_pose(geometry), asked, asked_back, &convergence) == SMS_OK);
    CHECK(same_bits(pose, asked));
    CHECK(same_bits(back, asked_back));
  }
}

TEST_CASE("a pair computes in either half what a number alone does, to the bit") {
  check_pairs<double>();
  check_pairs<float>();
}

TEST_CASE("warm start: two or three steps for 1 mrad, and the same pose as from cold") {
  Random random;
  int steps = 0;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const sms::Pose<double> start = random_pose(random, geometry);
    const Vec q = coordinates(start) + random_vector(random, -1e-3, 1e-3);
    sms::Pose<double> warm;
    Vec extension;
    sms::Convergence<double> convergence;
    REQUIRE(sms::inverse_kinematics(geometry, q, start, warm, extension, &convergence) == SMS_OK);
    CHECK(largest(extension - extension_at(geometry, q)) < 4e-15);
    steps = std::max(steps, convergence.iterations);
  }
  CHECK(steps <= 3);
}

TEST_CASE("float stays within 2e-6 m of double over the workspace") {
  Random random;
  double worst_inverse = 0.0, worst_forward = 0.0;
  for (int i = 0; i < sms_test::count; ++i) {
    const Vec extension = random_vector(random, 0.0, geometry.stroke);
    const sms::Pose<double> pose = pose_of_extension(geometry, extension);
    sms::Pose<float> posef;
    sms::Vec3<float> extensionf;
    REQUIRE(sms::inverse_kinematics(geometryf, sms::Vec3<float>(coordinates(pose).cast<float>()),
                                    sms::rest_pose(geometryf), posef, extensionf) == SMS_OK);
    worst_inverse = std::max(worst_inverse, largest(extensionf.cast<double>() - extension));
    REQUIRE(sms::forward_kinematics(geometryf, sms::Vec3<float>(extension.cast<float>()), sms::rest_pose(geometryf),
                                    posef) == SMS_OK);
    const sms::Pose<double> wide = sms::cast<double>(posef);
    worst_forward = std::max({worst_forward, largest(coordinates(wide) - coordinates(pose)),
                              std::abs(wide.yaw - pose.yaw), std::abs(wide.x - pose.x), std::abs(wide.y - pose.y)});
  }
  MESSAGE("float against double: inverse " << worst_inverse << " m, forward " << worst_forward << " m or rad");
  CHECK(worst_inverse < 2e-6);
  CHECK(worst_forward < 2e-6);
}

TEST_CASE("the six-leg inverse agrees: rods keep their length, actuators have their extension") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec extension = random_vector(random, 0.0, geometry.stroke);
    double length[6];
    sms::six_leg_inverse(geometry, pose_of_extension(geometry, extension), length);
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(length[k] - geometry.actuator_length(k) - extension(k)) < 4e-15);
      CHECK(std::abs(length[3 + k] - geometry.panhard_length(k)) < 4e-15);
    }
  }
}

TEST_CASE("the height may be another point's") {
  sms::Params<double> p;
  p.reference_point_z -= 0.3;
  p.reference_point_x += 0.1;
  const sms::Geometry<double> other = sms::make_geometry(p);
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Vec extension = random_vector(random, 0.0, geometry.stroke);
    const sms::Pose<double> a = pose_of_extension(geometry, extension), b = pose_of_extension(other, extension);
    CHECK(std::abs(a.roll - b.roll) + std::abs(a.pitch - b.pitch) + std::abs(a.yaw - b.yaw) < 6e-15);
    const Vec shift = sms::attitude(a.roll, a.pitch, a.yaw).rotation * (other.reference - geometry.reference);
    CHECK(largest(Vec(b.x - a.x, b.y - a.y, a.height - b.height) - shift) < 6e-15);
  }
}

TEST_CASE("rates and accelerations against differences in time, both ways") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, geometry);
    const Vec rate = random_vector(random, -0.3, 0.3), acceleration = random_vector(random, -1.0, 1.0);
    const sms::Motion<double> m = motion_at(q, rate);
    constexpr double h = 1e-3;
    const auto at = [&](double t) { return Vec(q + t * rate + 0.5 * t * t * acceleration); };
    const Vec before = extension_at(geometry, at(-h)), now = extension_at(geometry, q),
              after = extension_at(geometry, at(h));
    CHECK(largest((after - before) / (2 * h) - m.extension_rate) < 1e-6);
    CHECK(largest((after - 2 * now + before) / (h * h) - sms::extension_acceleration(m, acceleration)) < 1e-6);

    const auto parasitic = [&](double t) {
      const sms::Pose<double> pose = pose_at(geometry, at(t));
      return Vec(pose.yaw, pose.x, pose.y);
    };
    CHECK(largest((parasitic(h) - parasitic(-h)) / (2 * h) - m.parasitic_rate) < 1e-6);
    CHECK(largest((parasitic(h) - 2 * parasitic(0) + parasitic(-h)) / (h * h) -
                  sms::parasitic_acceleration(m, acceleration)) < 1e-6);

    CHECK(largest(sms::rate_of_extension(m, m.extension_rate) - rate) < 4e-14);
    CHECK(largest(sms::acceleration_of_extension(m, sms::extension_acceleration(m, acceleration)) - acceleration) <
          4e-14);
  }
}

TEST_CASE("Jacobians: three coordinates from six, and those against differences") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const sms::Pose<double> pose = random_pose(random, geometry);
    sms::Motion<double> m;
    sms::place(geometry, pose, m);
    const Eigen::Matrix<double, 3, 6> slope = sms::extension_slope_by_pose(m);
    CHECK(largest(slope.leftCols<3>() + slope.rightCols<3>() * m.eliminated.parasitic - m.extension_slope) < 4e-15);

    constexpr double h = 1e-6;
    double sms::Pose<double>::*const coordinate[6] = {&sms::Pose<double>::roll,   &sms::Pose<double>::pitch,
                                                      &sms::Pose<double>::height, &sms::Pose<double>::yaw,
                                                      &sms::Pose<double>::x,      &sms::Pose<double>::y};
    for (int k = 0; k < 6; ++k) {
      sms::Pose<double> before = pose, after = pose;
      before.*coordinate[k] -= h;
      after.*coordinate[k] += h;
      double lower[6], upper[6];
      sms::six_leg_inverse(geometry, before, lower);
      sms::six_leg_inverse(geometry, after, upper);
      for (int leg = 0; leg < 3; ++leg) {
        CHECK(std::abs((upper[leg] - lower[leg]) / (2 * h) - slope(leg, k)) < 1e-9);
      }
    }
  }
}

TEST_CASE("what cannot be is refused, and leaves the output as it was") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const sms::Pose<double> mark = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, rest = sms::rest_pose(geometry);
  const auto inverse = [&](const Vec& q, const sms::Pose<double>& start) {
    sms::Pose<double> pose = mark;
    Vec extension(7.0, 8.0, 9.0);
    const sms_status status = sms::inverse_kinematics(geometry, q, start, pose, extension);
    CHECK(same_bits(pose, mark));
    CHECK(extension == Vec(7.0, 8.0, 9.0));
    return status;
  };
  CHECK(inverse(Vec(nan, 0.0, 0.5), rest) == SMS_NOT_A_NUMBER);
  CHECK(inverse(Vec(0.0, 0.0, inf), rest) == SMS_NOT_A_NUMBER);
  CHECK(inverse(Vec(0.0, 0.0, 0.5), {0.0, 0.0, 0.5, nan, 0.0, 0.0}) == SMS_NOT_A_NUMBER);
  CHECK(inverse(Vec(0.7, 0.0, 0.5), rest) == SMS_OUT_OF_WORKSPACE);
  CHECK(inverse(Vec(1e300, 0.0, 0.5), rest) == SMS_OUT_OF_WORKSPACE);
  CHECK(inverse(Vec(0.0, 0.0, 1.5), rest) == SMS_OUT_OF_WORKSPACE);  // the rods do not reach
  CHECK(inverse(Vec(0.0, 0.0, 3.0), rest) == SMS_OUT_OF_WORKSPACE);

  const auto forward = [&](const Vec& extension, const sms::Pose<double>& start) {
    sms::Pose<double> pose = mark;
    const sms_status status = sms::forward_kinematics(geometry, extension, start, pose);
    CHECK(same_bits(pose, mark));
    return status;
  };
  CHECK(forward(Vec(0.2, nan, 0.2), rest) == SMS_NOT_A_NUMBER);
  CHECK(forward(Vec(0.2, 0.2, 0.2), {nan, 0.0, 0.5, 0.0, 0.0, 0.0}) == SMS_NOT_A_NUMBER);
  CHECK(forward(Vec(-1.0, 0.2, 0.2), rest) == SMS_OUT_OF_WORKSPACE);
  CHECK(forward(Vec(0.0, 1.5, 0.0), rest) == SMS_OUT_OF_WORKSPACE);
  CHECK(forward(Vec(3.0, 3.0, 3.0), rest) == SMS_OUT_OF_WORKSPACE);
  CHECK(forward(Vec::Constant(-0.6), rest) == SMS_NOT_CONVERGED);  // the platform would have to pass the ground
}

TEST_CASE("far outside the stroke, too, a solution is of the built machine or none at all") {
  Random random;
  int solved = 0;
  for (int i = 0; i < sms_test::count; ++i) {
    const Vec extension = random_vector(random, -0.7, 1.2);
    sms::Pose<double> pose, again;
    Vec back;
    if (sms::forward_kinematics(geometry, extension, sms::rest_pose(geometry), pose) != SMS_OK) continue;
    ++solved;
    REQUIRE(sms::inverse_kinematics(geometry, coordinates(pose), sms::rest_pose(geometry), again, back) == SMS_OK);
    CHECK(largest(back - extension) < 1e-9);
  }
  CHECK(solved > 0);
}

#ifdef SMS_TEST_JETS
TEST_CASE("Jets: the extensions' derivatives by q are the Jacobian, and back") {
  using Jet = ceres::Jet<double, 3>;
  const sms::Geometry<Jet> g = sms::make_geometry(sms::Params<Jet>());
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const sms::Pose<double> start = random_pose(random, geometry);
    const Vec q = coordinates_in_regime(i % 3, random, geometry);
    const sms::Motion<double> m = motion_at(q, Vec::Zero());
    const sms::Vec3<Jet> seeded(Jet(q(0), 0), Jet(q(1), 1), Jet(q(2), 2));
    sms::Pose<Jet> pose, found;
    sms::Vec3<Jet> extension;
    REQUIRE(sms::inverse_kinematics(g, seeded, start, pose, extension) == SMS_OK);
    for (int k = 0; k < 3; ++k) CHECK(largest(extension(k).v - m.extension_slope.row(k).transpose()) < 2e-14);
    CHECK(largest(pose.yaw.v - m.eliminated.parasitic.row(0).transpose()) < 2e-14);

    REQUIRE(sms::forward_kinematics(g, extension, start, found) == SMS_OK);
    CHECK(largest(found.roll.v - Vec::UnitX()) < 1e-13);
    CHECK(largest(found.pitch.v - Vec::UnitY()) < 1e-13);
    CHECK(largest(found.height.v - Vec::UnitZ()) < 1e-13);
    CHECK(largest(found.yaw.v - pose.yaw.v) < 1e-13);
  }
}

TEST_CASE("Jets: derivatives by the geometry against differences") {
  using Jet = ceres::Jet<double, 3>;
  sms::Params<Jet> seeded;
  seeded.base_joint_4_x.v(0) = 1.0;
  seeded.platform_joint_2_z.v(1) = 1.0;
  seeded.panhard_length_offset_1.v(2) = 1.0;
  const sms::Geometry<Jet> g = sms::make_geometry(seeded);
  double sms::Params<double>::*const member[3] = {&sms::Params<double>::base_joint_4_x,
                                                  &sms::Params<double>::platform_joint_2_z,
                                                  &sms::Params<double>::panhard_length_offset_1};
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Vec extension = random_vector(random, 0.0, 0.4);
    const Vec q = coordinates(pose_of_extension(geometry, extension));
    sms::Pose<Jet> pose;
    sms::Vec3<Jet> by_inverse;
    const sms::Vec3<Jet> fixed(Jet(q(0)), Jet(q(1)), Jet(q(2)));
    REQUIRE(sms::inverse_kinematics(g, fixed, sms::rest_pose(geometry), pose, by_inverse) == SMS_OK);
    const sms::Vec3<Jet> constant(Jet(extension(0)), Jet(extension(1)), Jet(extension(2)));
    REQUIRE(sms::forward_kinematics(g, constant, sms::rest_pose(geometry), pose) == SMS_OK);
    for (int k = 0; k < 3; ++k) {
      constexpr double h = 1e-5;
      sms::Params<double> lower, upper;
      lower.*member[k] -= h;
      upper.*member[k] += h;
      const sms::Geometry<double> before = sms::make_geometry(lower), after = sms::make_geometry(upper);
      const Vec slope = (extension_at(after, q) - extension_at(before, q)) / (2 * h);
      const sms::Pose<double> a = pose_of_extension(before, extension), b = pose_of_extension(after, extension);
      for (int leg = 0; leg < 3; ++leg) CHECK(std::abs(by_inverse(leg).v(k) - slope(leg)) < 1e-9);
      CHECK(std::abs(pose.roll.v(k) - (b.roll - a.roll) / (2 * h)) < 1e-9);
      CHECK(std::abs(pose.height.v(k) - (b.height - a.height) / (2 * h)) < 1e-9);
      CHECK(std::abs(pose.yaw.v(k) - (b.yaw - a.yaw) / (2 * h)) < 1e-9);
    }
  }
}
#endif
