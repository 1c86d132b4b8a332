// What the sensors of a simulated actuator say: late by a lag, through a play, and the truth where nothing is wrong.
#include <doctest/doctest.h>

#include <cmath>

#include "estimation/actuator_sensors.hpp"
#include "random_cases.hpp"

namespace est = sms::estimation;

namespace {

constexpr double kStep = 1e-3;

sms::BenchState<double> at(double extension, double velocity) {
  sms::BenchState<double> state{};
  state.extension = extension;
  state.velocity = velocity;
  return state;
}

}  // namespace

TEST_CASE("a slow sensor: a ramp is read late by the lag, a jump is approached as an exponential says") {
  sms::Params<double> p;
  p.sensor_lag_extension = 0.02;
  est::ActuatorSensors<double> sensors(p, kStep);
  const sms::BenchState<double> rest{};
  double x = 0.1;
  for (int k = 0; k < 200; ++k, x += 0.3 * kStep) {
    sensors.follow(p, at(x, 0.3), rest, 0.0);
    CHECK(sensors.extension_reading(p, at(x, 0.3), 0.0) == doctest::Approx(x - 0.3 * 0.02).epsilon(1e-12));
  }
  const double before = sensors.extension_reading(p, at(x, 0.3), 0.0), end = 0.25;
  sensors.follow(p, at(end, 0.0), rest, 0.0);  // rises within one step, and stays
  const double first = sensors.extension_reading(p, at(end, 0.0), 0.0);
  CHECK(first > before);
  for (int k = 1; k < 100; ++k) {
    sensors.follow(p, at(end, 0.0), rest, 0.0);
    CHECK(end - sensors.extension_reading(p, at(end, 0.0), 0.0) ==
          doctest::Approx((end - first) * std::exp(-k * kStep / 0.02)).epsilon(1e-9));
  }
}

TEST_CASE("a lag shorter than a step is a delay, and the two meet where it is one step") {
  sms::Params<double> p;
  const sms::BenchState<double> rest{};
  const auto read_sine = [&](double lag) {
    p.sensor_lag_extension = lag;
    est::ActuatorSensors<double> sensors(p, kStep);
    double reading = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double t = k * kStep;
      const auto state = at(0.2 + 0.05 * std::sin(6.0 * t), 0.3 * std::cos(6.0 * t));
      sensors.follow(p, state, rest, 0.0);
      reading = sensors.extension_reading(p, state, 0.0);
    }
    return reading;
  };
  CHECK(read_sine(kStep * (1.0 + 1e-9)) == doctest::Approx(read_sine(kStep * (1.0 - 1e-9))).epsilon(1e-5));
}

TEST_CASE("play: the sensor rests while the rod crosses the gap, and lags half of it behind after") {
  sms::Params<double> p;
  p.backlash = 2e-3;
  est::ActuatorSensors<double> sensors(p, kStep, 1.0);
  const sms::BenchState<double> rest{};
  const auto read = [&](double x, double v) {
    sensors.follow(p, at(x, v), rest, 0.0);
    return sensors.extension_reading(p, at(x, v), 0.0);
  };
  CHECK(read(0.100, 0.5) == doctest::Approx(0.099));  // pushed upwards
  CHECK(read(0.110, 0.5) == doctest::Approx(0.109));
  CHECK(read(0.1095, -0.5) == doctest::Approx(0.109));  // the rod has turned
  CHECK(read(0.1085, -0.5) == doctest::Approx(0.109));
  CHECK(read(0.1080, -0.5) == doctest::Approx(0.109));  // at the other side
  CHECK(read(0.1000, -0.5) == doctest::Approx(0.101));
  CHECK(read(0.1010, 0.5) == doctest::Approx(0.101));
}

TEST_CASE("which way a signal went last: by more than its noise, as far back as it takes") {
  Eigen::VectorXd signal(8);
  signal << 0.0, 1.0, 2.0, 1.9, 2.1, 2.0, 0.5, 0.6;
  CHECK(est::detail::moved_last(signal, 0, 0.5) == 0.0);
  CHECK(est::detail::moved_last(signal, 2, 0.5) == 1.0);
  CHECK(est::detail::moved_last(signal, 5, 0.5) == 1.0);
  CHECK(est::detail::moved_last(signal, 7, 0.5) == -1.0);
  CHECK(est::detail::moved_last(signal, 7, 5.0) == 0.0);
}

TEST_CASE("good sensors: the truth, bit for bit, wherever the piston goes") {
  sms_test::Random random;
  const sms::Params<double> p;
  est::ActuatorSensors<double> sensors(p, kStep);
  for (int k = 0; k < 1000; ++k) {
    auto state = at(random.uniform(0.0, 0.4), random.uniform(-1.0, 1.0)), rate = at(0.0, 0.0);
    state.actuator.lower.pressure = random.uniform(1e5, 6e5);
    rate.actuator.lower.pressure = random.uniform(-1e6, 1e6);
    sensors.follow(p, state, rate, random.uniform(-500.0, 500.0));
    CHECK(sensors.extension_reading(p, state, 0.0) == state.extension);
    CHECK(sensors.lower_reading(p, state, rate, 0.0) == state.actuator.lower.pressure);
  }
}
