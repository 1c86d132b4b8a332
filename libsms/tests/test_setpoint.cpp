// The limited set-point: no limit is ever passed, every target in range is reached, nothing chatters.
#include <doctest/doctest.h>

#include <cmath>

#include "random_cases.hpp"
#include "sms/excitation.hpp"
#include "sms/setpoint.hpp"

namespace {

using Limits = sms::SetpointLimits<double>;
constexpr double kRounding = 1e-12;

Limits any_limits(sms_test::Random& random) {
  const double lower = random.uniform(-1.0, 1.0);
  return {lower, lower + random.uniform(0.01, 1.0), std::pow(10.0, random.uniform(-2.0, 0.5)),
          std::pow(10.0, random.uniform(-1.0, 1.5)), 1e-3};
}

}  // namespace

TEST_CASE("setpoint: range, rate and acceleration hold, whatever the target does") {
  sms_test::Random random;
  for (int run = 0; run < sms_test::count / 100; ++run) {
    const Limits limits = any_limits(random);
    sms::Setpoint<double> state = {random.uniform(limits.lower, limits.upper), 0.0};
    double target = state.position;
    for (int k = 0; k < 500; ++k) {
      if (random.uniform(0.0, 1.0) < 0.05) target = random.uniform(limits.lower - 1.0, limits.upper + 1.0);
      const sms::Setpoint<double> before = state;
      sms::setpoint_step(limits, state, target, random.uniform(-2.0, 2.0));
      REQUIRE(state.position <= limits.upper + kRounding);
      REQUIRE(state.position >= limits.lower - kRounding);
      REQUIRE(std::abs(state.rate) <= limits.rate + kRounding);
      REQUIRE(std::abs(state.rate - before.rate) <= limits.acceleration * limits.period + kRounding);
    }
  }
}

TEST_CASE("setpoint: the same in float, up to its rounding") {
  sms_test::Random random;
  const sms::SetpointLimits<float> limits = {0.01f, 0.39f, 1.0f, 8.0f, 1e-3f};
  sms::Setpoint<float> state = {0.2f, 0.0f};
  float target = 0.2f;
  for (int k = 0; k < 2 * sms_test::count; ++k) {
    if (random.uniform(0.0, 1.0) < 0.01) target = float(random.uniform(-0.2, 0.6));
    const float before = state.rate;
    sms::setpoint_step(limits, state, target, float(random.uniform(-2.0, 2.0)));
    REQUIRE(state.position <= limits.upper + 1e-6f);
    REQUIRE(state.position >= limits.lower - 1e-6f);
    REQUIRE(std::abs(state.rate) <= limits.rate);
    REQUIRE(std::abs(state.rate - before) <= limits.acceleration * limits.period * 1.0001f + 1e-6f);
  }
}

TEST_CASE("setpoint: a target in range is reached from below, and then held") {
  sms_test::Random random;
  for (int run = 0; run < 200; ++run) {
    const Limits limits = any_limits(random);
    const double from = random.uniform(limits.lower, limits.upper), to = random.uniform(limits.lower, limits.upper);
    sms::Setpoint<double> state = {from, 0.0};
    const double distance = std::abs(to - from);
    // Trapezoid: no time-optimal motion is longer than this, and one more for each of the two corners.
    const double time = distance / limits.rate + limits.rate / limits.acceleration +
                        2.0 * std::sqrt(distance / limits.acceleration) + 3.0 * limits.period;
    for (int k = 0; k < int(std::ceil(time / limits.period)); ++k) {
      sms::setpoint_step(limits, state, to, 0.0);
      REQUIRE((state.position - to) * (from - to) >= -kRounding);  // never passed over
    }
    CHECK(state.position == doctest::Approx(to).epsilon(1e-9));
    const sms::SetpointLimited idle = sms::setpoint_step(limits, state, to, 0.0);
    CHECK(std::abs(state.rate) <= 2.0 * limits.acceleration * limits.period);
    CHECK_FALSE(idle.range);
    CHECK_FALSE(idle.rate);
  }
}

TEST_CASE("setpoint: a moving target within the limits is followed without lag") {
  const Limits limits = {0.0, 0.4, 1.0, 8.0, 1e-3};
  sms::Setpoint<double> state = {0.2, 0.0};
  double before = 0.2;
  for (int k = 1; k < 5000; ++k) {
    const double target = 0.2 + 0.15 * std::sin(2 * M_PI * 1e-3 * k);  // 0.94 m/s, 5.9 m/s^2
    sms::setpoint_step(limits, state, target, (target - before) / limits.period);
    before = target;
    if (k > 2000) REQUIRE(state.position == doctest::Approx(target).epsilon(1e-9));  // it starts at 0.94 m/s
  }
}

TEST_CASE("setpoint: what kept it back is said") {
  const Limits limits = {0.0, 0.4, 0.1, 1.0, 1e-3};
  sms::Setpoint<double> state = {0.2, 0.0};
  CHECK(sms::setpoint_step(limits, state, 0.5, 0.0).range);
  state = {0.2, 0.1};
  CHECK(sms::setpoint_step(limits, state, 0.4, 0.0).rate);
  state = {0.2, 0.0};
  const sms::SetpointLimited at_rest = sms::setpoint_step(limits, state, 0.2, 0.0);
  CHECK_FALSE((at_rest.range || at_rest.rate || at_rest.acceleration));
  CHECK(sms::setpoint_step(limits, state, 0.25, 0.0).acceleration);
}

TEST_CASE("setpoint: from outside the range it comes in and stays") {
  const Limits limits = {0.01, 0.39, 0.5, 2.0, 1e-3};
  sms::Setpoint<double> state = {-0.02, 0.0};
  for (int k = 0; k < 3000; ++k) {
    const double before = state.position;
    sms::setpoint_step(limits, state, 0.0, 0.0);
    CHECK(state.position >= before - kRounding);
  }
  CHECK(state.position == doctest::Approx(0.01));
}

TEST_CASE("excitation: each leg by itself, as the desk's signals give it") {
  const sms::Excitation<double> sine = {sms::Waveform::sine, {0.0, 0.9, -0.9}, {0.3, 0.5, 0.8}, {0.1, 0.2, 0.3}, 0, 10};
  const sms::Excitation<double> chirp = {
      sms::Waveform::chirp, {0.15, 0.15, 0.15}, {0.05, 0.05, 0.05}, {0, 0, 0}, 1.0, 60.0};
  for (double t = 0.0; t < 60.0; t += 0.37) {
    CHECK(sms::excitation_at(sine, 0, t) == doctest::Approx(0.1));
    CHECK(sms::excitation_at(sine, 2, t) == doctest::Approx(0.3 - 0.9 * std::sin(2 * M_PI * 0.8 * t)));
    CHECK(sms::excitation_at(chirp, 1, t) == doctest::Approx(0.15 * std::sin(2 * M_PI * (0.95 / 120 * t + 0.05) * t)));
  }
}
