// Controllers, the test sequence, the electronics around them, and the designs on the simplified plant.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "random_cases.hpp"
#include "sms/controller.hpp"
#include "sms/electronics.hpp"
#include "sms/sequencer.hpp"
#include "sms/simplified_plant.hpp"

namespace {

using Params = sms::Params<double>;
using PidSettings = sms::PidSettings<double>;
using Pid = sms::Pid<double>;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

PidSettings pid_of(double proportional, double integral, double derivative) {
  return {proportional, integral, derivative, 100.0, 1e-3, 1e9, sms::AntiWindup::none};
}

std::vector<double> noise(int n, sms_test::Random& random) {
  std::vector<double> x;
  for (int i = 0; i < n; ++i) x.push_back(random.uniform(-1.0, 1.0));
  return x;
}

}  // namespace

TEST_CASE("PID: each branch is what its name says") {
  Pid p{}, i{}, d{};
  const PidSettings proportional = pid_of(3.0, 0.0, 0.0), integral = pid_of(0.0, 4.0, 0.0),
                    derivative = pid_of(0.0, 0.0, 5.0);
  for (int k = 1; k <= 2000; ++k) {
    const double t = k * 1e-3;
    CHECK(sms::pid_step(proportional, p, 0.7 * t) == doctest::Approx(3.0 * 0.7 * t));
    CHECK(sms::pid_step(integral, i, t) == doctest::Approx(4.0 * 0.5 * t * t).epsilon(1e-12));  // trapezoid: exact
    const double slope = sms::pid_step(derivative, d, 0.7 * t);
    if (k > 300) CHECK(slope == doctest::Approx(5.0 * 0.7).epsilon(1e-9));
  }
}

TEST_CASE("PID: eq. 7.4 as one difference equation gives the same") {
  // C(z) over the common denominator (z - 1) ((1 + h) z - (1 - h)), h = N T / 2.
  sms_test::Random random;
  for (int run = 0; run < 20; ++run) {
    const double gp = random.uniform(0.1, 50), gi = random.uniform(0.0, 20), gd = random.uniform(0.0, 2.0);
    const double n = random.uniform(10.0, 3000.0), T = 1e-3, h = 0.5 * n * T;
    const auto anti_windup = run % 2 == 0 ? sms::AntiWindup::conditional_integration : sms::AntiWindup::none;
    const PidSettings s = {gp, gi, gd, n, T, 1e12, anti_windup};
    const double a0 = 1 + h, a1 = -2.0, a2 = 1 - h;
    const double b0 = gp * a0 + gi * T / 2 * (1 + h) + gd * n;
    const double b1 = gp * a1 + gi * T / 2 * 2 * h - 2 * gd * n;
    const double b2 = gp * a2 - gi * T / 2 * (1 - h) + gd * n;
    const std::vector<double> e = noise(300, random);
    Pid state{};
    double u1 = 0, u2 = 0, e1 = 0, e2 = 0;
    for (const double now : e) {
      const double u = (b0 * now + b1 * e1 + b2 * e2 - a1 * u1 - a2 * u2) / a0;
      CHECK(sms::pid_step(s, state, now) == doctest::Approx(u).epsilon(1e-9).scale(gp + gd * n));
      u2 = u1, u1 = u, e2 = e1, e1 = now;
    }
  }
}

TEST_CASE("anti-windup: eq. 7.4 to the bit inside the limits, no memory of the time at a limit") {
  sms_test::Random random;
  PidSettings plain = pid_of(2.0, 5.0, 0.1), guarded = plain;
  guarded.anti_windup = sms::AntiWindup::conditional_integration;
  Pid a{}, b{};
  for (const double e : noise(1000, random)) {
    CHECK(same_bits(sms::pid_step(plain, a, e), sms::pid_step(guarded, b, e)));
  }
  plain.limit = guarded.limit = 5.0;
  a = b = Pid{};
  for (int k = 0; k < 10000; ++k) {  // ten seconds out of reach
    CHECK(sms::pid_step(plain, a, 1.0) <= 5.0);
    CHECK(sms::pid_step(guarded, b, 1.0) <= 5.0);
  }
  CHECK(a.integral > 40.0);
  CHECK(b.integral <= 5.0);
  int until = 0;
  while (sms::pid_step(guarded, b, -0.1) > 0.0) ++until;
  CHECK(until < 6500);  // (5 V - what P gives) / (0.1 x 5 V/s)
  CHECK(sms::pid_step(plain, a, -0.1) > 4.0);
}

TEST_CASE("bumpless: what follows takes over without a jump, and so do other gains") {
  const PidSettings s = pid_of(7.0, 3.0, 0.4);
  Pid state{};
  sms::pid_follow(s, state, 0.02, 1.234);
  CHECK(sms::pid_step(s, state, 0.02) == doctest::Approx(1.234));

  PidSettings running = s;
  for (int k = 0; k < 100; ++k) sms::pid_step(running, state, 0.02 * std::sin(0.1 * k));
  Pid unchanged = state;
  sms::pid_change_gains(running, state, pid_of(20.0, 3.0, 0.1));
  const double e = state.change.input, slope = state.change.output;
  CHECK(running.proportional == doctest::Approx(20.0));
  const double jump = sms::pid_step(running, state, e) - sms::pid_step(s, unchanged, e);
  CHECK(std::abs(jump) < 0.3 * std::abs(slope) * 0.1 + 1e-9);  // what the filter moves in one period
}

TEST_CASE("state feedback: position error at rest, rates in motion, within the valve's range") {
  const Params p;
  sms::StateFeedbackSettings<double> s = sms::state_feedback_settings(p);
  s.position = 2.0;
  s.velocity = 1.5;
  s.acceleration = 0.25;
  sms::StateFeedback<double> state = sms::state_feedback_at(0.2);
  for (int k = 0; k < 100; ++k) {
    CHECK(sms::state_feedback_step(s, state, 0.25, 0.2) == doctest::Approx(0.1));
  }
  for (int k = 1; k <= 3000; ++k) {  // x = 0.2 + 0.05 t^2
    const double t = k * 1e-3, u = sms::state_feedback_step(s, state, 0.25, 0.2 + 0.05 * t * t);
    if (k == 3000) {  // the filter is 1/N late
      CHECK(u == doctest::Approx(2.0 * (0.05 - 0.45) - 1.5 * 0.1 * (3.0 - 0.01) - 0.25 * 0.1).epsilon(1e-9));
    }
  }
  CHECK(same_bits(sms::state_feedback_step(s, state, 100.0, 0.2), 5.0));
}

TEST_CASE("dead-band compensation: published numbers, odd, 5 V to 5 V, its gain its slope, b = 0 nothing") {
  const sms::DeadBand<double> d = sms::make_dead_band(0.8, 100.0);
  CHECK(d.gain == doctest::Approx(0.8402).epsilon(1e-4));
  CHECK(sms::dead_band_gain(d, 0.0) == doctest::Approx(51.7698).epsilon(1e-6));
  CHECK(sms::over_dead_band(d, 5.0) == doctest::Approx(5.0).epsilon(1e-15));
  sms_test::Random random;
  const sms::DeadBand<double> none = sms::make_dead_band(0.0, 100.0);
  for (int i = 0; i < 1000; ++i) {
    const double v = random.uniform(-5.0, 5.0), h = 1e-6;
    CHECK(same_bits(sms::over_dead_band(d, -v), -sms::over_dead_band(d, v)));
    CHECK(sms::dead_band_gain(d, v) ==
          doctest::Approx((sms::over_dead_band(d, v + h) - sms::over_dead_band(d, v - h)) / (2 * h)).epsilon(1e-5));
    CHECK(sms::over_dead_band(none, v) == doctest::Approx(v));
  }
  CHECK(same_bits(sms::valve_command(d, 5.0, 7.0), 10.0));
  CHECK(same_bits(sms::valve_command(d, 5.0, -7.0), 0.0));
  CHECK(same_bits(sms::valve_command(d, 5.0, 0.0), 5.0));
}

TEST_CASE("the sequencer counts: level, excite, the next cycle, finished; stopped when told") {
  const sms::SequencerSettings s = {3, 2, 2};
  sms::Sequencer state{};
  const int phases[] = {0, 0, 0, 1, 1, 0, 0, 0, 1, 1, 2, 2};
  const unsigned long samples[] = {0, 1, 2, 0, 1, 0, 1, 2, 0, 1, 0, 1};
  for (int k = 0; k < 12; ++k) {
    const sms::SequencerStep step = sms::sequencer_step(s, state);
    CHECK(int(step.phase) == phases[k]);
    CHECK(step.sample == samples[k]);
    CHECK(int(step.cycle) == k / 5);
  }
  state = {};
  for (int k = 0; k < 4; ++k) sms::sequencer_step(s, state);
  sms::sequencer_stop(s, state);
  CHECK(sms::sequencer_step(s, state).phase == sms::TestPhase::finished);
  state = {};
  for (int k = 0; k < 100; ++k) CHECK(sms::sequencer_step({3, 2, 0}, state).phase == sms::TestPhase::level);
}

TEST_CASE("the converters: nearest count, 4096 of 0.45 m, ends held, pulses in 1500 steps") {
  const Params p;
  const sms::Converter<double> adc = sms::position_converter(p), dac = sms::command_converter(p);
  CHECK(adc.step == doctest::Approx(0.45 / 4096));
  sms_test::Random random;
  double last = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.4 * i / 999.0, read = sms::sampled_extension(p, adc, x);
    CHECK(std::abs(read - x) <= 0.5 * adc.step * (1 + 1e-9));
    CHECK(sms::sampled_extension(p, adc, read) == doctest::Approx(read).epsilon(1e-12));
    CHECK(read >= last);
    last = read;
    const double v = random.uniform(0.0, 10.0);
    CHECK(std::abs(sms::pulse_width_voltage(dac, v) - v) <= 0.5 * 10.0 / 1500 * (1 + 1e-9));
  }
  CHECK(same_bits(sms::to_counts(adc, -1.0), 0.0));
  CHECK(same_bits(sms::to_counts(adc, 1.0), 4095.0));
  CHECK(same_bits(sms::pulse_width_voltage(dac, 11.0), 1500.0 * dac.step));
  const sms::LagStep<double> filter = sms::dac_filter(p, 1.0);  // long after a step
  CHECK(sms::lag_step(filter, {0.0, 0.0}, 6.0).value == doctest::Approx(6.0));
}

TEST_CASE("the delay line: any whole delay it has room for") {
  for (int delay = -1; delay <= 9; ++delay) {
    sms::DelayLine<double, 8> line = sms::delay_line_at<8>(-1.0);
    const int steps = std::min(7, std::max(0, delay));
    for (int k = 0; k < 50; ++k) {
      const double out = sms::delay_line_step(line, double(k), delay);
      CHECK(out == doctest::Approx(k < steps ? -1.0 : double(k - steps)));
    }
  }
  CHECK(sms::delay_steps(0.0, 1e-3) == 0);
  CHECK(sms::delay_steps(0.0034, 1e-3) == 3);
}

TEST_CASE("simplified plant: eq. 8.2 and 8.3 with the published numbers and the right ones") {
  const Params p;
  CHECK(sms::air_spring(p, 667e3) == doctest::Approx(73341.0).epsilon(1e-4));  // printed as 73.341 N/m
  const sms::SimplifiedPlant<double> published = sms::simplified_plant(p, 667e3, 320.0 / 3, 0.85);
  CHECK(published.natural_frequency == doctest::Approx(26.221).epsilon(1e-4));
  const sms::SimplifiedPlant<double> right = sms::simplified_plant(p, 333.5e3, 106.19, 0.85);
  CHECK(right.natural_frequency == doctest::Approx(18.58).epsilon(1e-3));
  CHECK(right.damping_ratio == doctest::Approx(0.1343).epsilon(1e-3));
}

TEST_CASE("state feedback designs: the poles come out where they were put, the published gains as read") {
  sms_test::Random random;
  for (int i = 0; i < 100; ++i) {
    const sms::SimplifiedPlant<double> g = {random.uniform(0.1, 1.0), random.uniform(5.0, 40.0),
                                            random.uniform(0.02, 0.5)};
    const double alpha = random.uniform(0.5, 2.0);
    for (const bool situm : {true, false}) {
      const auto k = situm ? sms::gains_situm(g, alpha, false) : sms::gains_specification_based(g, alpha);
      const double pole = alpha * g.natural_frequency / (situm ? 2.0 : std::sqrt(3.0));
      const sms::ThirdOrder<double> t = sms::closed_loop(g, k);
      CHECK(t.square == doctest::Approx(3 * pole));
      CHECK(t.linear == doctest::Approx(3 * pole * pole));
      CHECK(t.constant == doctest::Approx(pole * pole * pole));
      CHECK(sms::is_stable(t));
      CHECK(sms::poles(t).real == doctest::Approx(-pole).epsilon(1e-4));  // a triple root has a third of the digits
      // -3 dB of three equal poles: 0.5098 of one (the source rounds it to 0.5088)
      CHECK(sms::frequency_response(t, 0.50982 * pole).amplitude == doctest::Approx(std::sqrt(0.5)).epsilon(1e-4));
    }
  }
  const sms::SimplifiedPlant<double> g = {0.7, 26.221, 0.095};
  const auto situm = sms::gains_situm(g, 1.5, true), sbd = sms::gains_specification_based(g, 0.8157);
  CHECK(situm.position == doctest::Approx(15.8031).epsilon(1e-4));
  CHECK(situm.velocity == doctest::Approx(1.3393).epsilon(1e-4));
  CHECK(situm.acceleration == doctest::Approx(0.1123).epsilon(1e-3));
  CHECK(sbd.position == doctest::Approx(3.9128).epsilon(1e-3));
  CHECK(sbd.velocity == doctest::Approx(-0.4780).epsilon(1e-3));
  CHECK(sbd.acceleration == doctest::Approx(0.0666).epsilon(1e-3));
}

TEST_CASE("third order: poles solve it, Routh's border is where they cross, -11 dB at 1 Hz") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const sms::SimplifiedPlant<double> g = {random.uniform(0.1, 1.0), random.uniform(5.0, 40.0),
                                            random.uniform(0.02, 1.5)};
    const double gain = random.uniform(0.05, 3.0) * sms::largest_stable_gain(g);
    const sms::ThirdOrder<double> t = sms::closed_loop(g, {gain, 0.0, 0.0});
    const sms::Poles<double> s = sms::poles(t);
    CHECK(s.real + 2 * s.middle == doctest::Approx(-t.square).epsilon(1e-9));
    const double product = s.middle * s.middle + (s.is_pair ? 1 : -1) * s.spread * s.spread;
    CHECK(s.real * product == doctest::Approx(-t.constant).epsilon(1e-7));
    CHECK(product + 2 * s.real * s.middle == doctest::Approx(t.linear).epsilon(1e-7).scale(1.0));
    const bool left = s.real < 0.0 && s.middle + (s.is_pair ? 0.0 : s.spread) < 0.0;
    if (std::abs(gain / sms::largest_stable_gain(g) - 1.0) > 1e-6) CHECK(sms::is_stable(t) == left);
  }
  const sms::SimplifiedPlant<double> g = {0.85, 26.221, 0.095};
  const auto response = sms::frequency_response(sms::closed_loop(g, {2.0, 0.0, 0.0}), 2 * 3.14159265358979);
  CHECK(20 * std::log10(response.amplitude) == doctest::Approx(-11.1).epsilon(0.01));
  CHECK(response.phase * 180 / 3.14159265358979 == doctest::Approx(-77.0).epsilon(0.02));
  double last = 0.0;
  for (int k = 0; k <= 150; ++k) {  // the phase falls all the way to -270 degrees
    const double w = 0.1 * std::pow(1.05, k);
    const double phase = sms::frequency_response(sms::closed_loop(g, {2.0, 0.0, 0.0}), w).phase;
    CHECK(phase < last);
    last = phase;
  }
  CHECK(last == doctest::Approx(-1.5 * 3.14159265358979).epsilon(0.01));
}

TEST_CASE("the same code in float: within a count of the valve's pulses over a run") {
  const Params p;
  const sms::Params<float> pf;
  PidSettings s = sms::pid_settings(p);
  sms::PidSettings<float> sf = sms::pid_settings(pf);
  s.proportional = 10.0, sf.proportional = 10.0f;
  s.integral = 1.0, sf.integral = 1.0f;
  s.derivative = 0.2, sf.derivative = 0.2f;
  const sms::DeadBand<double> d = sms::make_dead_band(p.dead_band_step, p.dead_band_sharpness);
  const sms::DeadBand<float> df = sms::make_dead_band(pf.dead_band_step, pf.dead_band_sharpness);
  Pid state{};
  sms::Pid<float> statef{};
  sms::StateFeedback<double> feedback = sms::state_feedback_at(0.2);
  sms::StateFeedback<float> feedbackf = sms::state_feedback_at(0.2f);
  for (int k = 0; k < 5000; ++k) {
    const double x = 0.05 * std::sin(0.004 * k);
    const double u = sms::valve_command(d, 5.0, sms::pid_step(s, state, x));
    const float uf = sms::valve_command(df, 5.0f, sms::pid_step(sf, statef, float(x)));
    CHECK(std::abs(double(uf) - u) < 10.0 / 1500);
    const double v = sms::state_feedback_step(sms::state_feedback_settings(p), feedback, 0.2, 0.2 + x);
    const float vf = sms::state_feedback_step(sms::state_feedback_settings(pf), feedbackf, 0.2f, float(0.2 + x));
    CHECK(std::abs(double(vf) - v) < 10.0 / 1500);
  }
}
