// The spool's problem: exact derivatives, its own records leave nothing, stops, bad input.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "estimation/fit.hpp"
#include "estimation/spool.hpp"
#include "random_cases.hpp"

namespace est = sms::estimation;

namespace {

constexpr double kStep = 1e-3;

Eigen::VectorXd command(double amplitude) {
  Eigen::VectorXd u(800);
  for (int k = 0; k < u.size(); ++k) {
    u[k] = 5.0 + amplitude * std::sin(6.28 * 12.0 * kStep * k * (1.0 + kStep * k));
  }
  return u;
}

// What the model itself reads, m.
est::SpoolRecord record_of(const sms::Params<double>& p, double amplitude, est::SpoolLaw law) {
  est::SpoolRecord record{kStep, command(amplitude), Eigen::VectorXd::Zero(800)};
  Eigen::VectorXd read;
  est::SpoolProblem({record}, law).evaluate(p, {}, &read, nullptr);
  record.position.tail(read.size()) = read;
  return record;
}

sms::Params<double> spool_of(sms_test::Random& random) {
  sms::Params<double> p;
  p.valve_frequency = random.uniform(30.0, 100.0);
  p.valve_damping_ratio = random.uniform(0.4, 1.3);
  p.command_delay = random.uniform(1e-4, 4e-3);
  return p;
}

}  // namespace

TEST_CASE("the spool's jacobian agrees with differences, by either law and within the stops") {
  sms_test::Random random;
  for (const est::SpoolLaw law : {est::SpoolLaw::cubic, est::SpoolLaw::linear}) {
    const sms::Params<double> truth = spool_of(random), p = spool_of(random);
    const est::SpoolProblem problem({record_of(truth, 1.5, law)}, law);
    const std::vector<int> free = {sms::index_of_valve_frequency, sms::index_of_valve_damping_ratio,
                                   sms::index_of_spool_cubic_1, sms::index_of_spool_linear_1};
    Eigen::VectorXd residual, above, below;
    est::RowMatrix jacobian;
    problem.evaluate(p, free, &residual, &jacobian);
    for (std::size_t k = 0; k < free.size(); ++k) {
      sms::Params<double> up = p, down = p;
      const double h = 1e-5 * std::abs(param(p, free[k]));
      param(up, free[k]) += h;
      param(down, free[k]) -= h;
      problem.evaluate(up, {}, &above, nullptr);
      problem.evaluate(down, {}, &below, nullptr);
      const Eigen::VectorXd column = jacobian.col(static_cast<Eigen::Index>(k));
      CHECK((column - (above - below) / (2.0 * h)).norm() <= 1e-5 * column.norm() + 1e-12);
    }
  }
}

TEST_CASE("a spool's own record gives its parameters back") {
  sms_test::Random random;
  const sms::Params<double> truth = spool_of(random);
  const est::SpoolProblem problem({record_of(truth, 2.0, est::SpoolLaw::cubic)}, est::SpoolLaw::cubic);
  const auto bounded = [](int index) {
    const auto* d = sms_param_describe(index);
    return est::FreeParam{index, d->lower, d->upper};
  };
  const est::Fit found = est::fit(problem, sms::Params<double>(),
                                  {bounded(sms::index_of_valve_frequency), bounded(sms::index_of_valve_damping_ratio),
                                   bounded(sms::index_of_command_delay)},
                                  {});
  CHECK(found.params.valve_frequency == doctest::Approx(truth.valve_frequency).epsilon(1e-3));
  CHECK(found.params.valve_damping_ratio == doctest::Approx(truth.valve_damping_ratio).epsilon(1e-3));
  CHECK(found.params.command_delay == doctest::Approx(truth.command_delay).epsilon(5e-3));
}

TEST_CASE("at its stop the spool feels its limit, and short of it nothing of it") {
  const sms::Params<double> p;
  for (const double amplitude : {0.5, 5.0}) {
    const est::SpoolProblem problem({record_of(p, amplitude, est::SpoolLaw::cubic)}, est::SpoolLaw::cubic);
    Eigen::VectorXd residual;
    est::RowMatrix jacobian;
    problem.evaluate(p, {sms::index_of_spool_limit}, &residual, &jacobian);
    CHECK((jacobian.norm() > 0.0) == (amplitude > 4.0));
  }
}

TEST_CASE("bad records of a spool are refused") {
  const est::SpoolRecord good{kStep, command(1.0), Eigen::VectorXd::Zero(800)};
  est::SpoolRecord record = good;
  record.position.conservativeResize(799);
  CHECK_THROWS_AS(est::SpoolProblem({record}, est::SpoolLaw::cubic), std::invalid_argument);
  record = good;
  record.command[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(est::SpoolProblem({record}, est::SpoolLaw::cubic), std::invalid_argument);
  record = good;
  record.step = 0.0;
  CHECK_THROWS_AS(est::SpoolProblem({record}, est::SpoolLaw::cubic), std::invalid_argument);
}
