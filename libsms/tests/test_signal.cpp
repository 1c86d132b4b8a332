// Excitations, the alpha-beta filter, linear lags, the thermocouple.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "random_cases.hpp"
#include "sms/filter.hpp"
#include "sms/signal.hpp"
#include "sms/thermocouple.hpp"

namespace {

constexpr double pi = 3.14159265358979324;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE("the chirp starts at zero, turns (f1 + f2) T / 2 times, and has the frequency that it says") {
  const sms::Chirp<double> c = {0.15, 0.05, 1.0, 60.0};
  CHECK(same_bits(sms::chirp(c, 0.0), 0.0));
  CHECK(sms::chirp(c, 60.0) == doctest::Approx(0.15 * std::sin(2 * pi * 31.5)).scale(1.0));
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double t = random.uniform(0.0, 60.0), h = 1e-5;
    const auto quarter = [&](double at) {  // the same chirp, a quarter turn ahead
      return 0.15 * std::cos(std::asin(std::min(1.0, std::max(-1.0, sms::chirp(c, at) / 0.15))));
    };
    const double slope = (sms::chirp(c, t + h) - sms::chirp(c, t - h)) / (2 * h);
    CHECK(std::abs(slope) ==
          doctest::Approx(2 * pi * sms::chirp_frequency(c, t) * quarter(t)).epsilon(1e-4).scale(0.1));
  }
  CHECK(sms::chirp_frequency(c, 0.0) == doctest::Approx(0.05));
  CHECK(sms::chirp_frequency(c, 60.0) == doctest::Approx(1.0));
  CHECK(sms::sine(0.25, 2.0, 1.0, 0.5) == doctest::Approx(2.5));
}

TEST_CASE(
    "alpha-beta filter: a constant stays, a ramp is followed, an acceleration lags by a dt^2 (1 - alpha) / beta") {
  sms_test::Random random;
  for (int k = 0; k < 20; ++k) {
    const double alpha = random.uniform(0.05, 0.9), beta = random.uniform(0.005, 0.3), dt = 0.01;
    const double level = random.uniform(-1e5, 1e5), rate = random.uniform(-10.0, 10.0), a = random.uniform(1.0, 5.0);
    sms::AlphaBeta<double> still = {level, 0.0}, ramp = {level, rate}, bent = {0.0, 0.0};
    for (int i = 1; i <= 20000; ++i) {
      const double t = i * dt;
      still = sms::alpha_beta_step(alpha, beta, dt, still, level);
      ramp = sms::alpha_beta_step(alpha, beta, dt, ramp, level + rate * t);
      bent = sms::alpha_beta_step(alpha, beta, dt, bent, 0.5 * a * t * t);
    }
    CHECK(same_bits(still.value, level));
    CHECK(ramp.value == doctest::Approx(level + rate * 200.0).epsilon(1e-9));
    CHECK(0.5 * a * 200.0 * 200.0 - bent.value == doctest::Approx(a * dt * dt * (1 - alpha) / beta).epsilon(1e-3));
  }
}

TEST_CASE("alpha-beta filter: 0.25 and 0.02 take the noise of a rest to about its 0.41st part") {
  // The variance reduction of the filter, (2 alpha^2 + 2 beta - 3 alpha beta) / (alpha (4 - 2 alpha - beta)).
  sms_test::Random random;
  const double alpha = 0.25, beta = 0.02;
  sms::AlphaBeta<double> state = {0.0, 0.0};
  double sum = 0.0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    state = sms::alpha_beta_step(alpha, beta, 0.01, state, random.uniform(-1.0, 1.0));
    sum += state.value * state.value;
  }
  const double expected = (2 * alpha * alpha + 2 * beta - 3 * alpha * beta) / (alpha * (4 - 2 * alpha - beta));
  CHECK(3.0 * sum / n == doctest::Approx(expected).epsilon(0.03));
  CHECK(std::sqrt(expected) == doctest::Approx(0.415).epsilon(0.01));
}

TEST_CASE("the exact steps are exact: two halves make a whole, and the rates agree") {
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double omega = random.uniform(1.0, 1000.0), zeta = random.uniform(0.1, 0.99), dt = random.uniform(1e-4, 0.1);
    const double input = random.uniform(-5.0, 5.0);
    const sms::Lag<double> lag = {random.uniform(-5.0, 5.0), random.uniform(-100.0, 100.0)};
    const auto half = sms::make_lag_step(omega, zeta, 0.5 * dt), whole = sms::make_lag_step(omega, zeta, dt);
    const sms::Lag<double> twice = sms::lag_step(half, sms::lag_step(half, lag, input), input);
    const sms::Lag<double> once = sms::lag_step(whole, lag, input);
    CHECK(twice.value == doctest::Approx(once.value).epsilon(1e-10).scale(10.0));
    CHECK(twice.rate == doctest::Approx(once.rate).epsilon(1e-10).scale(10.0 * omega));
    const double h = 1e-9;
    const sms::Lag<double> rate = sms::lag_rate(omega, zeta, lag, input);
    const sms::Lag<double> near = sms::lag_step(sms::make_lag_step(omega, zeta, h), lag, input);
    CHECK((near.value - lag.value) / h == doctest::Approx(rate.value).epsilon(1e-3).scale(10.0));
    CHECK((near.rate - lag.rate) / h == doctest::Approx(rate.rate).epsilon(1e-3).scale(1e3));

    const double w = sms::low_pass_weight(omega, dt), w2 = sms::low_pass_weight(omega, 0.5 * dt);
    const double y = sms::low_pass_step(w2, sms::low_pass_step(w2, 1.0, input), input);
    CHECK(sms::low_pass_step(w, 1.0, input) == doctest::Approx(y).epsilon(1e-12));
    CHECK(sms::low_pass_rate(omega, 1.0, input) == doctest::Approx(omega * (input - 1.0)));
  }
}

TEST_CASE("a Butterworth lag passes 0.7071 at its frequency, 90 degrees late") {
  const double f = 98.0, dt = 1e-6, omega = sms::angular_frequency(f);
  const auto step = sms::make_lag_step(omega, std::sqrt(0.5), dt);
  sms::Lag<double> lag = {0.0, 0.0};
  double in_phase = 0.0, late = 0.0;
  const int period = 10204, settle = 10 * period;
  for (int i = 0; i < settle + 20 * period; ++i) {
    const double phase = 2 * pi * i / period;
    lag = sms::lag_step(step, lag, std::sin(phase + pi / period));  // held: half a step late
    if (i >= settle) {
      in_phase += lag.value * std::sin(phase) / (10 * period);
      late -= lag.value * std::cos(phase) / (10 * period);
    }
  }
  CHECK(std::hypot(in_phase, late) == doctest::Approx(std::sqrt(0.5)).epsilon(2e-3));
  CHECK(std::atan2(late, in_phase) == doctest::Approx(pi / 2).epsilon(3e-3));
}

TEST_CASE("the thermocouple: NIST's own table of type K, to 0.05 K") {
  const struct {
    double celsius, millivolts;
  } nist[] = {{0, 0.0},     {20, 0.798},  {25, 1.000},   {50, 2.023},
              {100, 4.096}, {200, 8.138}, {300, 12.209}, {500, 20.644}};
  const sms::Params<double> p;
  for (const auto& row : nist) {
    CHECK(std::abs(sms::thermocouple_difference(1e-3 * row.millivolts) - row.celsius) < 0.06);
    CHECK(sms::thermocouple_temperature(p, 0.5 * row.millivolts, 273.15) ==
          doctest::Approx(273.15 + sms::thermocouple_difference(1e-3 * row.millivolts)));
  }
}

TEST_CASE("float follows double") {
  const sms::Chirp<double> c = {0.15, 0.05, 1.0, 60.0};
  const sms::Chirp<float> cf = {0.15f, 0.05f, 1.0f, 60.0f};
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double t = random.uniform(0.0, 60.0), e = random.uniform(0.0, 0.02);
    CHECK(std::abs(double(sms::chirp(cf, float(t))) - sms::chirp(c, t)) < 1e-5);
    CHECK(double(sms::thermocouple_difference(float(e))) ==
          doctest::Approx(sms::thermocouple_difference(e)).epsilon(1e-4).scale(1.0));
  }
}
