// A closed loop held against records: the same controller as in simulate.hpp, derivatives, states of the controller.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "estimation/bench_loop.hpp"
#include "random_cases.hpp"
#include "sms/simulate.hpp"

namespace est = sms::estimation;
using sms::Params;

namespace {

constexpr int kPeriodsASample = 5;
constexpr int kSamples = 240;

struct Case {
  Params<double> p;
  est::ControlLaw law;
  double amplitude = 0.03;  // of the set-point about mid-stroke, m
  double first = 0.2;       // extension at the beginning, m
};

double setpoint_at(const Case& c, double time) {
  return 0.2 + c.amplitude * std::sin(5.0 * time) + 0.3 * c.amplitude * std::sin(17.0 * time);
}

// As sms::Simulation makes it (simulate.hpp), 5 ms a sample; with the state and the integral at every sample.
struct Simulated {
  est::BenchRecord record;
  std::vector<sms::BenchState<double>> state;
  std::vector<double> integral;
};

Simulated simulated(const Case& c) {
  sms::ActuatorLaws laws = sms::published_laws();
  laws.drive = c.law.electronics ? sms::DriveLaw::filtered : sms::DriveLaw::direct;
  const auto bench = sms::make_bench(c.p, laws);
  sms::Simulation<sms::Bench<double>> s(bench);
  const auto begin = sms::bench_at_rest(bench, c.first, 0.0, 3e5);
  REQUIRE(sms::begin_simulation(begin, {c.p.valve_centre, 0.0}, c.p, c.law.control, c.law.compensated,
                                c.law.electronics, 1e-8, s) == SMS_OK);
  Simulated out;
  out.record.step = kPeriodsASample * c.p.control_period;
  for (Eigen::VectorXd* signal : {&out.record.command, &out.record.extension, &out.record.pressure_lower,
                                  &out.record.pressure_upper, &out.record.setpoint}) {
    signal->resize(kSamples);
  }
  const double no_noise = 0.0;
  for (int k = 0; k < kPeriodsASample * kSamples; ++k) {
    const double setpoint = setpoint_at(c, k * c.p.control_period);
    const sms::BenchState<double> y = s.run.state;
    const double integral = s.loop[0].pid.integral;
    REQUIRE(sms::take_sample(c.p, &setpoint, &no_noise, s) == SMS_OK);
    if (k % kPeriodsASample == 0) {
      const int row = k / kPeriodsASample;
      out.record.setpoint[row] = setpoint;
      out.record.extension[row] = y.extension;
      out.record.pressure_lower[row] = y.actuator.lower.pressure;
      out.record.pressure_upper[row] = y.actuator.upper.pressure;
      out.record.command[row] = s.command[0];
      out.state.push_back(y);
      out.integral.push_back(integral);
    }
    REQUIRE(sms::run_period(s) == SMS_OK);
  }
  return out;
}

est::BenchLoopPlant plant_of(const Case& c, const est::BenchRecord& record, double longest_step = 1e-3) {
  sms::ActuatorLaws laws = sms::published_laws();
  laws.drive = c.law.electronics ? sms::DriveLaw::filtered : sms::DriveLaw::direct;
  return {{record}, {1.0, 1.0, 1.0, 1.0}, 1.0, laws, c.law, c.p, longest_step};
}

// The window from sample 100 on; the controller is fed with the record from its first sample on.
constexpr int kFirst = 100, kRows = 4 * (kSamples - kFirst), kStart = est::BenchLoopPlant::kStart;
const est::Window window{0, kFirst, kSamples - kFirst, 0, kRows, {}};

using Start = Eigen::Matrix<double, kStart, 1>;

// As the simulation was there.
Start start_of(const Simulated& s) {
  const auto& y = s.state[kFirst];
  Start start = Start::Zero();
  start << y.extension, y.velocity, y.actuator.lower.pressure, y.actuator.upper.pressure, 0.0, 0.0, 0.0, 0.0,
      s.integral[0];
  return start;
}

Eigen::VectorXd run(const est::BenchLoopPlant& plant, const Params<double>& p, const Start& start) {
  Eigen::VectorXd out(kRows);
  plant.simulate(p, window, start.data(), out.data());
  return out;
}

// (samples x 4): extension, pressures, command.
Eigen::MatrixXd errors(const Case& c, double longest_step) {
  const Simulated s = simulated(c);
  const Eigen::VectorXd out = run(plant_of(c, s.record, longest_step), c.p, start_of(s));
  return Eigen::Map<const est::RowMatrix>(out.data(), kSamples - kFirst, 4);
}

Case some_case(int number, sms_test::Random& random) {
  Case c;
  c.p.proportional_gain = 12.0;
  c.p.dead_band_sharpness = 20.0;
  if (number == 1) {
    c.p.adc_bits = 24.0;
    c.p.pwm_steps = 1e9;
    c.law.electronics = true;
  }
  if (number == 2) {
    c.law.control = sms::PositionControl::state_feedback;
  }
  if (number >= 3) {
    c.p.proportional_gain = random.uniform(6.0, 15.0);
    c.p.integral_gain = random.uniform(2.0, 8.0);
    c.p.derivative_gain = random.uniform(0.0, 0.3);
    c.p.command_delay = random.uniform(0.0, 0.008);
    c.p.piston_leakage = random.uniform(0.0, 1e-9);
    c.p.valve_frequency = random.uniform(40.0, 90.0);
    c.law.compensated = random.uniform(0.0, 1.0) > 0.3;
    c.amplitude = random.uniform(0.02, 0.04);
    c.first = 0.2 + random.uniform(-0.005, 0.005);
  }
  return c;
}

}  // namespace

TEST_CASE("the loop is that of simulate.hpp: published loop, with electronics, state feedback, and anyone's") {
  sms_test::Random random;
  for (int number = 0; number < 5; ++number) {
    CAPTURE(number);
    const Case c = some_case(number, random);
    const Eigen::MatrixXd fine = errors(c, 2.5e-4), coarse = errors(c, 1e-3);
    CHECK(fine.col(0).cwiseAbs().maxCoeff() < 2e-5);            // m
    CHECK(fine.middleCols(1, 2).cwiseAbs().maxCoeff() < 50.0);  // Pa
    CHECK(coarse.col(0).cwiseAbs().maxCoeff() < 1e-4);
    CHECK(coarse.middleCols(1, 2).cwiseAbs().maxCoeff() < 500.0);
    // Five periods a sample; in between the record runs straight.
    CHECK(fine.col(3).cwiseAbs().maxCoeff() < 0.02);  // V
  }
}

TEST_CASE("derivatives of a closed loop are those of differences, by parameter and by initial state") {
  using Jet = est::ParameterJet;
  sms_test::Random random;
  Case c = some_case(3, random);
  c.p.command_delay = 0.0037;
  c.law.compensated = true;
  const Simulated s = simulated(c);
  const est::BenchLoopPlant plant = plant_of(c, s.record);
  const Start start = start_of(s);
  const auto slope_of = [&](const Params<Jet>& p, const Eigen::Matrix<Jet, kStart, 1>& from) {
    std::vector<Jet> out(kRows);
    plant.simulate(p, window, from.data(), out.data());
    Eigen::VectorXd slope(kRows);
    for (int i = 0; i < kRows; ++i) {
      slope[i] = out[std::size_t(i)].v[0];
    }
    return slope;
  };
  const auto agree = [](const Eigen::VectorXd& by_differences, const Eigen::VectorXd& exact) {
    CHECK(exact.norm() > 0.0);
    CHECK((by_differences - exact).norm() < 2e-3 * exact.norm());
  };
  const std::pair<int, double> free[] = {
      {sms::index_of_proportional_gain, 1e-6}, {sms::index_of_integral_gain, 1e-6},
      {sms::index_of_derivative_gain, 1e-8},   {sms::index_of_dead_band_step, 1e-7},
      {sms::index_of_command_delay, 1e-8},     {sms::index_of_mass_flow_gain, 1e-7},
      {sms::index_of_piston_leakage, 1e-15},   {sms::index_of_sensor_gain_extension, 1e-7}};
  for (const auto& one : free) {
    CAPTURE(std::string(sms_param_describe(one.first)->name));
    Params<Jet> seeded = sms::cast<Jet>(c.p);
    sms::param(seeded, one.first).v[0] = 1.0;
    Params<double> less = c.p, more = c.p;
    sms::param(less, one.first) -= one.second;
    sms::param(more, one.first) += one.second;
    agree((run(plant, more, start) - run(plant, less, start)) / (2.0 * one.second),
          slope_of(seeded, start.cast<Jet>()));
  }
  for (const int k : {0, 1, 2, est::BenchPlant::kStart}) {
    CAPTURE(k);
    const double step = 1e-6 * est::BenchLoopPlant::start_scale(k);
    Eigen::Matrix<Jet, kStart, 1> seeded = start.cast<Jet>();
    seeded[k].v[0] = 1.0;
    const Start one = Start::Unit(k) * step;
    agree((run(plant, c.p, start + one) - run(plant, c.p, start - one)) / (2.0 * step),
          slope_of(sms::cast<Jet>(c.p), seeded));
  }
}

TEST_CASE("a delay of nothing changes nothing, and has the slope towards a longer one") {
  using Jet = est::ParameterJet;
  sms_test::Random random;
  const Case c = some_case(0, random);
  const Simulated s = simulated(c);
  const est::BenchLoopPlant plant = plant_of(c, s.record);
  const Start start = start_of(s);
  Params<Jet> seeded = sms::cast<Jet>(c.p);
  seeded.command_delay.v[0] = 1.0;
  const Eigen::Matrix<Jet, kStart, 1> from = start.cast<Jet>();
  std::vector<Jet> exact(kRows);
  plant.simulate(seeded, window, from.data(), exact.data());
  Params<double> late = c.p;
  late.command_delay = 1e-8;
  const Eigen::VectorXd here = run(plant, c.p, start), there = run(plant, late, start);
  Eigen::VectorXd slope(kRows);
  for (int i = 0; i < kRows; ++i) {
    const Jet& jet = exact[std::size_t(i)];
    CHECK(std::memcmp(&jet.a, &here[i], sizeof jet.a) == 0);
    slope[i] = jet.v[0];
  }
  CHECK(slope.norm() > 0.0);
  CHECK(((there - here) / 1e-8 - slope).norm() < 2e-3 * slope.norm());
}

TEST_CASE("what a parameter of the machine changes, it changes in the signals; the command's row is the controller's") {
  sms_test::Random random;
  const Case c = some_case(4, random);
  const Simulated s = simulated(c);
  const est::BenchLoopPlant plant = plant_of(c, s.record);
  const auto command_of = [](const Eigen::VectorXd& out) {
    return Eigen::VectorXd(Eigen::Map<const est::RowMatrix>(out.data(), kSamples - kFirst, 4).col(3));
  };
  const Eigen::VectorXd plain = run(plant, c.p, start_of(s));
  Params<double> leaky = c.p, eager = c.p;
  leaky.piston_leakage += 2e-9;
  eager.proportional_gain *= 1.1;
  const Eigen::VectorXd with_leak = run(plant, leaky, start_of(s)), with_gain = run(plant, eager, start_of(s));
  CHECK((with_leak - plain).norm() > 1.0);
  CHECK((command_of(with_leak) - command_of(plain)).norm() == 0.0);
  CHECK((with_gain - plain).norm() > 1.0);
  CHECK((command_of(with_gain) - command_of(plain)).cwiseAbs().maxCoeff() > 0.01);
}

TEST_CASE("without a recorded command there is a row less, and the rest is the same to the bit") {
  sms_test::Random random;
  const Case c = some_case(3, random);
  Simulated s = simulated(c);
  const Start start = start_of(s);
  const Eigen::VectorXd with = run(plant_of(c, s.record), c.p, start);
  s.record.command.resize(0);
  const est::BenchLoopPlant plant = plant_of(c, s.record);
  REQUIRE(plant.channels(0) == 3);
  Eigen::VectorXd without(3 * (kSamples - kFirst));
  plant.simulate(c.p, window, start.data(), without.data());
  for (int k = 0; k < kSamples - kFirst; ++k) {
    CHECK(std::memcmp(without.data() + 3L * k, with.data() + 4L * k, 3 * sizeof(double)) == 0);
  }
}

TEST_CASE(
    "a search finds the integral, wherever the record begins, and a closed loop leaves nothing of its own record") {
  sms_test::Random random;
  const Case c = some_case(3, random);
  Simulated s = simulated(c);
  constexpr int kLost = 60;  // samples before the record begins
  for (Eigen::VectorXd* signal : {&s.record.command, &s.record.extension, &s.record.pressure_lower,
                                  &s.record.pressure_upper, &s.record.setpoint}) {
    *signal = signal->tail(kSamples - kLost).eval();
  }
  sms::ActuatorLaws laws = sms::published_laws();
  const est::BenchLoopPlant plant({s.record}, {1e-4, 500.0, 500.0, 500.0}, 0.01, laws, c.law, c.p, 1e-3);
  const est::ShootingProblem<est::BenchLoopPlant> problem(plant, {});
  Eigen::VectorXd residual;
  problem.evaluate(c.p, {}, &residual, nullptr);
  CHECK(residual.size() == problem.rows());
  CHECK(residual.squaredNorm() < 0.05 * problem.rows());
}

TEST_CASE("a controller that is slower than the record, and one that fits no record") {
  sms_test::Random random;
  Case c = some_case(0, random);
  const Simulated s = simulated(c);
  c.p.control_period = 4 * s.record.step;
  CHECK(run(plant_of(c, s.record), c.p, start_of(s)).allFinite());
  c.p.control_period = 0.7 * s.record.step;
  CHECK_THROWS_WITH_AS(plant_of(c, s.record), doctest::Contains("a whole multiple of the other"),
                       std::invalid_argument);
  est::BenchRecord without = s.record;
  without.setpoint.resize(3);
  c.p.control_period = s.record.step;
  CHECK_THROWS_WITH_AS(plant_of(c, without), doctest::Contains("setpoint has 3 samples"), std::invalid_argument);
}
