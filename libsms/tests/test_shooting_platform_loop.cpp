// A platform in a closed loop held against records: the controllers are those of simulate.hpp, each its own leg's.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "estimation/platform_loop.hpp"
#include "random_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/simulate.hpp"

namespace est = sms::estimation;
using Machine = sms::LegParams<double>;

namespace {

constexpr int kPeriodsASample = 5;
constexpr int kSamples = 160;
constexpr int kFirst = 100, kRows = 12 * (kSamples - kFirst), kStart = est::PlatformLoopPlant::kStart;
const est::Window window{0, kFirst, kSamples - kFirst, 0, kRows, {}};
const est::ControlLaw law;

using Start = Eigen::Matrix<double, kStart, 1>;

// As sms::Simulation makes it, 5 ms a sample, with the window's initial state.
struct Simulated {
  est::PlatformRecord record;
  Start start;
};

// Controllers are those of the common parameters, the legs have their own.
Simulated simulated(const Machine& p) {
  sms::Platform<double> platform = sms::make_platform<double>(p, sms::published_laws(), sms::MassModel::corrected);
  for (int i = 0; i < 3; ++i) {
    platform.params[i] = sms::params_of_leg(p, i);
  }
  sms::PlatformState<double> begin;
  REQUIRE(sms::platform_at_rest(platform, {0.02, -0.01, 0.5}, 3e5, begin) == SMS_OK);
  sms::Simulation<sms::Platform<double>> s(platform);
  sms::PlatformInput<double> input;
  input.command.setConstant(p.valve_centre);
  input.wrench.force.setZero();
  input.wrench.moment.setZero();
  REQUIRE(sms::begin_simulation(begin, input, p, law.control, law.compensated, law.electronics, 1e-6, s) == SMS_OK);
  Simulated out;
  out.record.step = kPeriodsASample * p.control_period;
  for (est::LegSignals* legs : {&out.record.command, &out.record.extension, &out.record.pressure_lower,
                                &out.record.pressure_upper, &out.record.setpoint}) {
    legs->fill(Eigen::VectorXd(kSamples));
  }
  const Eigen::Vector3d first = s.system.terms.extension;
  const double no_noise[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < kPeriodsASample * kSamples; ++k) {
    const double time = k * p.control_period;
    double setpoint[3];
    for (int i = 0; i < 3; ++i) {
      setpoint[i] =
          first(i) + 0.02 * std::sin(5.0 * time + i) - 0.02 * std::sin(double(i)) + 0.006 * std::sin(17.0 * time);
    }
    const sms::PlatformState<double> y = s.run.state;
    const int row = k / kPeriodsASample;
    if (k == 0) {
      for (int i = 0; i < 3; ++i) {
        out.start[est::PlatformPlant::kStart + i] = s.loop[i].pid.integral;  // the record's first sample feeds them
      }
    }
    REQUIRE(sms::take_sample(p, setpoint, no_noise, s) == SMS_OK);
    if (k % kPeriodsASample == 0) {
      const Eigen::Vector3d speed = s.system.terms.velocity;
      for (int i = 0; i < 3; ++i) {
        const std::size_t leg = static_cast<std::size_t>(i);
        out.record.setpoint[leg][row] = setpoint[i];
        out.record.extension[leg][row] = s.system.terms.extension(i);
        out.record.pressure_lower[leg][row] = y.actuator[i].lower.pressure;
        out.record.pressure_upper[leg][row] = y.actuator[i].upper.pressure;
        out.record.command[leg][row] = s.command[i];
        if (row == kFirst) {
          out.start[i] = s.system.terms.extension(i);
          out.start[3 + i] = speed(i);
          out.start[6 + i] = y.actuator[i].lower.pressure;
          out.start[9 + i] = y.actuator[i].upper.pressure;
          out.start[12 + i] = out.start[15 + i] = 0.0;
        }
      }
    }
    REQUIRE(sms::run_period(s) == SMS_OK);
  }
  return out;
}

est::PlatformNoise noise() {
  est::PlatformNoise n;
  n.extension.setConstant(1e-4);
  n.pressure_lower.setConstant(500.0);
  n.pressure_upper.setConstant(500.0);
  n.supply_pressure = 500.0;
  n.attitude.setConstant(2e-4);
  return n;
}

est::PlatformLoopPlant plant_of(const est::PlatformRecord& record, const Machine& said) {
  return {{record}, noise(), Eigen::Vector3d(0.01, 0.01, 0.01), sms::published_laws(),
          law,      said,    sms::MassModel::corrected,         2.5e-3};
}

Eigen::VectorXd run(const est::PlatformLoopPlant& plant, const Machine& p, const Start& start) {
  Eigen::VectorXd out(kRows);
  plant.simulate(p, window, start.data(), out.data());
  return out;
}

// (samples x 12): three extensions, six pressures, three commands, in units of the noise.
est::RowMatrix table(const Eigen::VectorXd& out) {
  return Eigen::Map<const est::RowMatrix>(out.data(), kSamples - kFirst, 12);
}

Machine some_machine(sms_test::Random& random) {
  Machine p;
  p.proportional_gain = random.uniform(6.0, 12.0);
  p.integral_gain = random.uniform(2.0, 8.0);
  p.derivative_gain = random.uniform(0.0, 0.2);
  p.dead_band_sharpness = 20.0;
  p.command_delay = random.uniform(0.0, 0.008);
  p.shift[1].chamber_leakage_lower = random.uniform(0.0, 4e-9);
  return p;
}

}  // namespace

TEST_CASE("a platform's loop is that of simulate.hpp") {
  sms_test::Random random;
  const Machine p = some_machine(random);
  const Simulated s = simulated(p);
  const est::PlatformLoopPlant plant = plant_of(s.record, p);
  REQUIRE(plant.channels(0) == 12);
  const est::RowMatrix off = table(run(plant, p, s.start));
  CHECK(off.leftCols(3).cwiseAbs().maxCoeff() < 2.0);       // 0.2 mm after 0.3 s
  CHECK(off.middleCols(3, 6).cwiseAbs().maxCoeff() < 4.0);  // 2 kPa
  CHECK(off.rightCols(3).cwiseAbs().maxCoeff() < 2.0);  // five periods a sample; in between the record runs straight
}

TEST_CASE("derivatives of a platform's loop are those of differences, by parameter, by leg and by initial state") {
  using Jet = est::ParameterJet;
  sms_test::Random random;
  const Machine p = some_machine(random);
  const Simulated s = simulated(p);
  const est::PlatformLoopPlant plant = plant_of(s.record, p);
  const auto slope_of = [&](const sms::LegParams<Jet>& seeded, const Eigen::Matrix<Jet, kStart, 1>& from) {
    std::vector<Jet> out(kRows);
    plant.simulate(seeded, window, from.data(), out.data());
    Eigen::VectorXd slope(kRows);
    for (int i = 0; i < kRows; ++i) {
      slope[i] = out[std::size_t(i)].v[0];
    }
    return slope;
  };
  const auto agree = [](const Eigen::VectorXd& by_differences, const Eigen::VectorXd& exact) {
    CHECK(exact.norm() > 0.0);
    CHECK((by_differences - exact).norm() < 5e-3 * exact.norm());
  };
  struct Free {
    int param, leg;
    double step;
  };
  for (const Free& free : {Free{sms::index_of_proportional_gain, 0, 1e-6}, Free{sms::index_of_integral_gain, 2, 1e-6},
                           Free{sms::index_of_derivative_gain, 3, 1e-8}, Free{sms::index_of_dead_band_step, 0, 1e-7},
                           Free{sms::index_of_command_delay, 1, 1e-8}, Free{sms::index_of_piston_leakage, 2, 1e-15}}) {
    CAPTURE(std::string(sms_param_describe(free.param)->name));
    const int index = sms::leg_param_index(free.param, free.leg);
    sms::LegParams<Jet> seeded = sms::cast<Jet>(p);
    sms::param(seeded, index).v[0] = 1.0;
    Machine less = p, more = p;
    sms::param(less, index) -= free.step;
    sms::param(more, index) += free.step;
    agree((run(plant, more, s.start) - run(plant, less, s.start)) / (2.0 * free.step),
          slope_of(seeded, s.start.cast<Jet>()));
  }
  for (const int k : {0, 4, 8, est::PlatformPlant::kStart, est::PlatformPlant::kStart + 2}) {
    CAPTURE(k);
    const double step = 1e-6 * est::PlatformLoopPlant::start_scale(k);
    Eigen::Matrix<Jet, kStart, 1> seeded = s.start.cast<Jet>();
    seeded[k].v[0] = 1.0;
    const Start one = Start::Unit(k) * step;
    agree((run(plant, p, s.start + one) - run(plant, p, s.start - one)) / (2.0 * step),
          slope_of(sms::cast<Jet>(p), seeded));
  }
}

TEST_CASE("the command of a leg is that of its own controller, and knows nothing of the machine") {
  sms_test::Random random;
  const Machine p = some_machine(random);
  const Simulated s = simulated(p);
  const est::PlatformLoopPlant plant = plant_of(s.record, p);
  const est::RowMatrix plain = table(run(plant, p, s.start));
  Machine leaky = p, eager = p;
  leaky.piston_leakage += 4e-9;
  eager.shift[1].proportional_gain = 0.2 * p.proportional_gain;
  const est::RowMatrix with_leak = table(run(plant, leaky, s.start)) - plain;
  const est::RowMatrix with_gain = table(run(plant, eager, s.start)) - plain;
  CHECK(with_leak.leftCols(9).norm() > 1.0);
  CHECK(with_leak.rightCols(3).norm() == 0.0);
  CHECK(with_gain.col(1).norm() > 1.0);
  CHECK(with_gain.col(10).cwiseAbs().maxCoeff() > 1.0);
  CHECK(with_gain.col(9).norm() + with_gain.col(11).norm() == 0.0);
}

TEST_CASE("a platform's loop without recorded commands has three rows less, and the rest is the same to the bit") {
  sms_test::Random random;
  const Machine p = some_machine(random);
  Simulated s = simulated(p);
  const Eigen::VectorXd with = run(plant_of(s.record, p), p, s.start);
  s.record.command.fill({});
  const est::PlatformLoopPlant plant = plant_of(s.record, p);
  REQUIRE(plant.channels(0) == 9);
  Eigen::VectorXd without(9 * (kSamples - kFirst));
  plant.simulate(p, window, s.start.data(), without.data());
  for (int k = 0; k < kSamples - kFirst; ++k) {
    CHECK(std::memcmp(without.data() + 9L * k, with.data() + 12L * k, 9 * sizeof(double)) == 0);
  }
}

TEST_CASE("a search finds the integrals of three controllers, and a loop leaves next to nothing of its own record") {
  sms_test::Random random;
  const Machine p = some_machine(random);
  Simulated s = simulated(p);
  constexpr int kLost = 30;  // samples before the record begins
  for (est::LegSignals* legs : {&s.record.command, &s.record.extension, &s.record.pressure_lower,
                                &s.record.pressure_upper, &s.record.setpoint}) {
    for (Eigen::VectorXd& signal : *legs) {
      signal = signal.tail(kSamples - kLost).eval();
    }
  }
  const est::ShootingProblem<est::PlatformLoopPlant> problem(plant_of(s.record, p), {});
  Eigen::VectorXd residual;
  problem.evaluate(p, {}, &residual, nullptr);
  CHECK(residual.size() == problem.rows());
  CHECK(residual.squaredNorm() < 0.05 * problem.rows());
}

TEST_CASE("a platform's loop of a period that fits no record, and without set-points") {
  const Simulated s = simulated(Machine());
  Machine p;
  p.control_period = 0.7 * s.record.step;
  CHECK_THROWS_WITH_AS(plant_of(s.record, p), doctest::Contains("a whole multiple of the other"),
                       std::invalid_argument);
  est::PlatformRecord without = s.record;
  without.setpoint[1].resize(3);
  CHECK_THROWS_WITH_AS(plant_of(without, Machine()), doctest::Contains("setpoint has 3 samples"),
                       std::invalid_argument);
}
