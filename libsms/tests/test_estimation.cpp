// Fits: exact derivatives, parameters recovered, bad input refused.
#include <ceres/jet.h>
#include <doctest/doctest.h>

#include <cmath>

#include "estimation/cylinder.hpp"
#include "estimation/fit.hpp"
#include "random_cases.hpp"
#include "sms/piston.hpp"

namespace est = sms::estimation;

namespace {

// A record of a machine whose parameters are `truth`, with perfect sensors.
est::CylinderRecord record_of(const sms::Params<double>& truth, int n, sms_test::Random& random) {
  est::CylinderRecord r;
  for (Eigen::VectorXd* signal :
       {&r.extension, &r.velocity, &r.acceleration, &r.pressure_lower, &r.pressure_upper, &r.rod_force}) {
    signal->resize(n);
  }
  for (int i = 0; i < n; ++i) {
    r.extension[i] = random.uniform(0.0, 0.4);
    r.velocity[i] = random.uniform(-0.3, 0.3);
    r.acceleration[i] = random.uniform(-2.0, 2.0);
    r.pressure_lower[i] = random.uniform(1e5, 5e5);
    r.pressure_upper[i] = random.uniform(1e5, 5e5);
    r.rod_force[i] = sms::rod_force(truth, sms::Piston<double>{r.extension[i], r.velocity[i], r.acceleration[i],
                                                               r.pressure_lower[i], r.pressure_upper[i]});
  }
  return r;
}

// Counts how often derivatives are asked for where they were asked for last.
class Counted : public est::Problem {
 public:
  Counted(const est::Problem& problem, bool repeats) : problem_(problem), repeats_(repeats) {}

  int rows() const override { return problem_.rows(); }
  bool repeats() const override { return repeats_; }
  void evaluate(const sms::Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                est::RowMatrix* jacobian) const override {
    problem_.evaluate(params, free, residual, jacobian);
    if (jacobian != nullptr) {
      const Eigen::Vector2d here(params.coulomb_force, params.viscous_friction);
      again += here.isApprox(last_, 1e-15) ? 1 : 0;
      last_ = here;
    }
  }

  mutable int again = 0;

 private:
  const est::Problem& problem_;
  bool repeats_;
  mutable Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

}  // namespace

TEST_CASE("Jet derivatives of friction agree with differences, at the limits too") {
  using Jet = ceres::Jet<double, 2>;
  const sms::Params<double> p;
  const sms::Params<Jet> pj = sms::cast<Jet>(p);
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double v = random.uniform(-0.2, 0.2), a = random.uniform(-2.0, 2.0), h = 1e-7;
    if (std::abs(std::abs(v) - p.stiction_velocity) < 1e-5 || std::abs(v) < 1e-5 || std::abs(a) < 1e-3) continue;
    const auto at = [&](double dv, double da) {
      return sms::friction(p, sms::Piston<double>{0.2, v + dv, a + da, 4e5, 3e5});
    };
    const Jet f = sms::friction(pj, sms::Piston<Jet>{Jet(0.2), Jet(v, 0), Jet(a, 1), Jet(4e5), Jet(3e5)});
    CHECK(f.v[0] == doctest::Approx((at(h, 0) - at(-h, 0)) / (2 * h)).epsilon(1e-4).scale(10));
    CHECK(f.v[1] == doctest::Approx((at(0, h) - at(0, -h)) / (2 * h)).epsilon(1e-4).scale(10));
  }
  for (const double a : {0.0, 1e-9, 1e-300, 1.0}) {
    for (const double v : {0.0, 1e-300, 1e-9, -1e-9, 0.005, 0.1}) {
      const Jet f = sms::friction(pj, sms::Piston<Jet>{Jet(0.2), Jet(v, 0), Jet(a, 1), Jet(4e5), Jet(3e5)});
      CHECK(std::isfinite(f.a));
      CHECK(std::isfinite(f.v[0]));
      CHECK(std::isfinite(f.v[1]));
    }
  }
}

TEST_CASE("the problem's jacobian agrees with differences for every parameter it can feel") {
  sms_test::Random random;
  sms::Params<double> p;
  const est::CylinderProblem problem({record_of(p, 50, random)});
  std::vector<int> all;
  for (int i = 0; i < sms::index_of_sensor_offset_chamber_pressure_upper + 1; ++i) all.push_back(i);
  p.position_friction = 0.3;  // away from neutral, so that the sensors' columns are not zero
  p.pressure_friction = 1e-5;
  p.exponential_friction_force = 2.0;
  Eigen::VectorXd r;
  est::RowMatrix jacobian;
  problem.evaluate(p, all, &r, &jacobian);
  for (const int i : all) {
    const double h = 1e-6 * std::max(std::abs(sms::param(p, i)), 1e-3 * (sms_param_describe(i)->uncertainty + 1e-2));
    sms::Params<double> up = p, down = p;
    sms::param(up, i) += h;
    sms::param(down, i) -= h;
    Eigen::VectorXd ru, rd;
    problem.evaluate(up, {}, &ru, nullptr);
    problem.evaluate(down, {}, &rd, nullptr);
    const Eigen::VectorXd difference = (ru - rd) / (2 * h);
    INFO(sms_param_describe(i)->name);
    CHECK((difference - jacobian.col(i)).norm() <= 1e-4 * jacobian.col(i).norm() + 1e-5 / h * 1e-6);
  }
}

TEST_CASE("a fit recovers what made the data, and names a start outside the bounds") {
  sms_test::Random random;
  sms::Params<double> truth;
  truth.coulomb_force = 31.0;
  truth.pressure_friction = 7.5e-6;
  truth.bore_diameter = 0.1003;
  const est::CylinderProblem problem({record_of(truth, 200, random), record_of(truth, 300, random)});
  CHECK(problem.rows() == 500);
  const std::vector<est::FreeParam> free = {{sms::index_of_coulomb_force, 0.0, 1e3},
                                            {sms::index_of_pressure_friction, -1e-3, 1e-3},
                                            {sms::index_of_bore_diameter, 0.09, 0.11}};
  const est::Fit fit = est::fit(problem, sms::Params<double>(), free, Eigen::VectorXd());
  CHECK(fit.converged);
  CHECK(fit.params.coulomb_force == doctest::Approx(31.0).epsilon(1e-9));
  CHECK(fit.params.pressure_friction == doctest::Approx(7.5e-6).epsilon(1e-8));
  CHECK(fit.params.bore_diameter == doctest::Approx(0.1003).epsilon(1e-10));
  CHECK(fit.cost < 1e-12);

  const est::Fit boxed = est::fit(problem, sms::Params<double>(), {{sms::index_of_bore_diameter, 0.0999, 0.1001}}, {});
  CHECK(boxed.at_bound[0]);
  CHECK(boxed.params.bore_diameter == doctest::Approx(0.1001));

  // Bore and gain of a gauge cannot be told apart when one chamber is open: the pulled one stays.
  truth.pressure_friction = 0.0;
  est::CylinderRecord single = record_of(truth, 100, random);
  for (int i = 0; i < 100; ++i) {
    single.rod_force[i] =
        sms::rod_force(truth, sms::Piston<double>{single.extension[i], single.velocity[i], single.acceleration[i],
                                                  single.pressure_lower[i], truth.ambient_pressure});
    single.pressure_lower[i] = 1.02 * (single.pressure_lower[i] - truth.ambient_pressure);
  }
  single.gauge_lower = true;
  single.pressure_upper.resize(0);
  const est::CylinderProblem twin({single});
  const est::Fit pulled = est::fit(
      twin, truth,
      {{sms::index_of_bore_diameter, 0.09, 0.11, 1e3}, {sms::index_of_sensor_gain_chamber_pressure_lower, -0.5, 0.5}},
      Eigen::VectorXd());
  CHECK(pulled.params.bore_diameter == doctest::Approx(truth.bore_diameter).epsilon(1e-6));
  CHECK(pulled.params.sensor_gain_chamber_pressure_lower == doctest::Approx(0.02).epsilon(1e-4));

  CHECK_THROWS_WITH_AS(est::fit(problem, truth, {{sms::index_of_bore_diameter, 0.09, 0.1}}, {}),
                       doctest::Contains("bore_diameter"), std::invalid_argument);
}

TEST_CASE("derivatives are not computed twice at one place, but where a second answer may be another") {
  sms_test::Random random;
  sms::Params<double> truth;
  truth.coulomb_force = 31.0;
  truth.viscous_friction = 480.0;
  est::CylinderRecord record = record_of(truth, 300, random);
  for (double& force : record.rod_force) {
    force += random.uniform(-1.0, 1.0);
  }
  const est::CylinderProblem problem({record});
  for (const double upper : {1e3, 30.0}) {  // free, and ending at a bound, where the solver runs twice
    const std::vector<est::FreeParam> free = {{sms::index_of_coulomb_force, 0.0, upper},
                                              {sms::index_of_viscous_friction, 0.0, 1e4}};
    sms::Params<double> start;
    start.coulomb_force = 20.0;
    const Counted once(problem, true), anew(problem, false);
    const est::Fit kept = est::fit(once, start, free, {}), asked = est::fit(anew, start, free, {});
    CHECK(anew.again >= once.again + 2);  // at the start and at the end
    CHECK(kept.params.coulomb_force == asked.params.coulomb_force);
    CHECK(kept.params.viscous_friction == asked.params.viscous_friction);
    CHECK(kept.cost == asked.cost);
    CHECK((kept.jacobian - asked.jacobian).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("a record with a hole or a NaN is refused by name") {
  sms_test::Random random;
  est::CylinderRecord r = record_of(sms::Params<double>(), 20, random);
  r.velocity[3] = std::nan("");
  CHECK_THROWS_WITH_AS(est::CylinderProblem({r}), doctest::Contains("velocity"), std::invalid_argument);
  r.velocity.resize(7);
  CHECK_THROWS_WITH_AS(est::CylinderProblem({r}), doctest::Contains("7 samples"), std::invalid_argument);
}
