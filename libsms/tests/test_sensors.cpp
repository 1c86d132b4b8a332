// What the sensors of a simulated actuator say: late by a lag, through a play, and the truth where nothing is wrong.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "random_cases.hpp"
#include "sms/plant_sensors.hpp"

namespace {

constexpr double kStep = 1e-3;

// The sensors of a bench on whose mount a force stands, N.
struct Looking {
  sms::Bench<double> bench;
  sms::BenchSensors<double> sensors;
  sms::BenchTerms<double> terms{};

  explicit Looking(const sms::Params<double>& p, double moved = 0.0)
      : bench(sms::make_bench(p, sms::published_laws())), sensors(bench, kStep, moved) {}

  void follow(const sms::BenchState<double>& state, const sms::BenchState<double>& rate, double force = 0.0) {
    terms.actuator.force = force;
    sensors.follow(bench, state, rate, terms);
  }
  double read(const char* signal, const sms::BenchState<double>& state, const sms::BenchState<double>& rate,
              double late = 0.0) const {
    double reading = std::nan("");
    sensors.each(bench, state, rate, terms,
                 [&](const char* name, int, const sms::Sensor<double>& sensor, double value, double slope) {
                   reading = name == std::string(signal) ? sensor.reading(value, slope, late) : reading;
                 });
    return reading;
  }
};

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
  Looking sensors(p);
  const sms::BenchState<double> rest{};
  double x = 0.1;
  for (int k = 0; k < 200; ++k, x += 0.3 * kStep) {
    sensors.follow(at(x, 0.3), rest);
    CHECK(sensors.read("extension", at(x, 0.3), rest) == doctest::Approx(x - 0.3 * 0.02).epsilon(1e-12));
  }
  const double before = sensors.read("extension", at(x, 0.3), rest), end = 0.25;
  sensors.follow(at(end, 0.0), rest);  // rises within one step, and stays
  const double first = sensors.read("extension", at(end, 0.0), rest);
  CHECK(first > before);
  for (int k = 1; k < 100; ++k) {
    sensors.follow(at(end, 0.0), rest);
    CHECK(end - sensors.read("extension", at(end, 0.0), rest) ==
          doctest::Approx((end - first) * std::exp(-k * kStep / 0.02)).epsilon(1e-9));
  }
}

TEST_CASE("a lag shorter than a step is a delay, and the two meet where it is one step") {
  sms::Params<double> p;
  const sms::BenchState<double> rest{};
  const auto read_sine = [&](double lag) {
    p.sensor_lag_extension = lag;
    Looking sensors(p);
    double reading = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double t = k * kStep;
      const auto state = at(0.2 + 0.05 * std::sin(6.0 * t), 0.3 * std::cos(6.0 * t));
      sensors.follow(state, rest);
      reading = sensors.read("extension", state, rest);
    }
    return reading;
  };
  CHECK(read_sine(kStep * (1.0 + 1e-9)) == doctest::Approx(read_sine(kStep * (1.0 - 1e-9))).epsilon(1e-5));
}

TEST_CASE("play: the sensor rests while the rod crosses the gap, and lags half of it behind after") {
  sms::Params<double> p;
  p.backlash = 2e-3;
  Looking sensors(p, 1.0);
  const sms::BenchState<double> rest{};
  const auto read = [&](double x, double v) {
    sensors.follow(at(x, v), rest);
    return sensors.read("extension", at(x, v), rest);
  };
  CHECK(read(0.100, 0.5) == doctest::Approx(0.099));  // pushed upwards
  CHECK(read(0.110, 0.5) == doctest::Approx(0.109));
  CHECK(read(0.1095, -0.5) == doctest::Approx(0.109));  // the rod has turned
  CHECK(read(0.1085, -0.5) == doctest::Approx(0.109));
  CHECK(read(0.1080, -0.5) == doctest::Approx(0.109));  // at the other side
  CHECK(read(0.1000, -0.5) == doctest::Approx(0.101));
  CHECK(read(0.1010, 0.5) == doctest::Approx(0.101));
}

TEST_CASE("good sensors: the truth, bit for bit, wherever the piston goes") {
  sms_test::Random random;
  const sms::Params<double> p;
  Looking sensors(p);
  for (int k = 0; k < 1000; ++k) {
    auto state = at(random.uniform(0.0, 0.4), random.uniform(-1.0, 1.0)), rate = at(0.0, 0.0);
    state.actuator.lower.pressure = random.uniform(1e5, 6e5);
    rate.actuator.lower.pressure = random.uniform(-1e6, 1e6);
    sensors.follow(state, rate, random.uniform(-500.0, 500.0));
    CHECK(sensors.read("extension", state, rate) == state.extension);
    CHECK(sensors.read("chamber_pressure_lower", state, rate) == state.actuator.lower.pressure);
  }
}

TEST_CASE("gain and zero: a reading has its truth back, about the datum of a thermocouple too") {
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const sms::SensorErrors<double> errors{random.uniform(-0.5, 0.5), random.uniform(-1e3, 1e3), 0.0, 0.0,
                                           i % 2 == 0 ? 0.0 : 293.0};
    const double truth = random.uniform(0.0, 6e5);
    CHECK(errors.truth(errors.reading(truth)) == doctest::Approx(truth).epsilon(1e-12));
  }
  const sms::SensorErrors<double> thermocouple{0.1, 0.0, 0.0, 0.0, 293.0};
  CHECK(thermocouple.reading(303.0) == doctest::Approx(304.0));
}

TEST_CASE("a gain error is a share of what the sensor itself reads: at its datum there is none") {
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    sms::Params<double> p;
    p.sensor_gain_extension = random.uniform(-0.5, 0.5);
    p.sensor_offset_extension = random.uniform(-1e-2, 1e-2);
    p.sensor_datum_extension = random.uniform(-0.5, 0.5);
    const sms::SensorErrors<double> sensor = sms::extension_sensor(p);
    CHECK(sensor.reading(p.sensor_datum_extension) - p.sensor_datum_extension ==
          doctest::Approx(p.sensor_offset_extension).epsilon(1e-9).scale(1.0));
    const double truth = random.uniform(0.0, 0.4), from_datum = truth - p.sensor_datum_extension;
    CHECK(sensor.reading(truth) ==
          doctest::Approx(truth + p.sensor_gain_extension * from_datum + p.sensor_offset_extension));
    CHECK(sensor.truth(sensor.reading(truth)) == doctest::Approx(truth).epsilon(1e-12).scale(1.0));
  }
}

TEST_CASE("linearity: a reading has its truth back, and no straight line is nearer than the bow") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    sms::Params<double> p;
    p.sensor_gain_chamber_pressure_lower = random.uniform(-0.1, 0.1);
    p.sensor_offset_chamber_pressure_lower = random.uniform(-1e4, 1e4);
    p.sensor_linearity_chamber_pressure_lower = random.uniform(-0.02, 0.02);
    const sms::SensorErrors<double> gauge = sms::chamber_pressure_lower_sensor(p);
    const double truth = random.uniform(-0.05e6, 0.55e6);  // beyond its span as well
    CHECK(std::abs(gauge.truth(gauge.reading(truth)) - truth) < 1e-12 * 1e6);
    const double by = 10.0;
    CHECK(gauge.slope(truth) ==
          doctest::Approx((gauge.reading(truth + by) - gauge.reading(truth - by)) / (2.0 * by)).epsilon(1e-9));
    const double size = p.sensor_linearity_chamber_pressure_lower * 5e5;
    sms::SensorErrors<double> straight = gauge;
    straight.linearity = 0.0;
    for (const auto& [place, share] : {std::pair{0.0, -1.0}, {2.5e5, 1.0}, {5e5, -1.0}}) {
      CHECK(gauge.reading(place) - straight.reading(place) == doctest::Approx(share * size));
    }
  }
}

TEST_CASE("a yielding mount: the sensor sees less by what the force bends it") {
  sms::Params<double> p;
  p.frame_compliance = 1e-6;
  Looking sensors(p);
  const sms::BenchState<double> rest{};
  sensors.follow(at(0.2, 0.0), rest, 500.0);
  CHECK(sensors.read("extension", at(0.2, 0.0), rest) == doctest::Approx(0.2 - 5e-4));
}

TEST_CASE("a channel: noise, then the ends of its range, then its converter, which rounds or counts full steps") {
  sms::Channel<double> channel;
  CHECK(channel.recorded(0.12345, 3.0) == 0.12345);
  channel.noise = 0.01;
  CHECK(channel.recorded(0.5, -2.0) == doctest::Approx(0.48));
  channel.high = 0.49;
  CHECK(channel.recorded(0.5, 2.0) == 0.49);
  channel = sms::Channel<double>();
  channel.resolution = 0.25;
  CHECK(channel.recorded(0.90, 0.0) == doctest::Approx(1.0));
  channel.rounding = sms::Rounding::down;
  CHECK(channel.recorded(0.90, 0.0) == doctest::Approx(0.75));
  CHECK(channel.recorded(-0.1, 0.0) == doctest::Approx(-0.25));
}

TEST_CASE("a late clock: whole samples, and what is left is at most half of one") {
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double step = random.uniform(1e-4, 1e-2), late = random.uniform(-5.0, 5.0);
    double rest;
    const int samples = sms::whole_samples(step, late, &rest);
    CHECK(std::abs(rest) <= 0.5 * step * (1.0 + 1e-9));
    CHECK(samples * step + rest == doctest::Approx(late));
  }
}
