// The tank's problem: exact derivatives, the equation's own limits, parameters recovered, bad input refused.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "estimation/fit.hpp"
#include "estimation/tank.hpp"
#include "random_cases.hpp"

namespace est = sms::estimation;

namespace {

const sms::FlowTestKind kIso{sms::FlowLaw::iso, sms::ChamberLaw::polytropic};
const sms::FlowTestKind kEnergy{sms::FlowLaw::iso, sms::ChamberLaw::energy};
const sms::FlowTestKind kClassic{sms::FlowLaw::classic, sms::ChamberLaw::polytropic};

sms::Params<double> test_of(bool charge, sms_test::Random& random) {
  sms::Params<double> p;
  p.component_conductance = random.uniform(1e-8, 4e-8);
  p.component_critical_ratio = random.uniform(0.2, 0.5);
  p.component_subsonic_index = random.uniform(1.0, 2.0);
  p.discharge_coefficient = random.uniform(0.3, 0.7);
  p.spool_position = random.uniform(4e-4, 1.5e-3);
  p.opening_time = random.uniform(0.1, 0.5);
  p.tank_initial_pressure = charge ? p.ambient_pressure : p.supply_pressure;
  p.thermocouple_time_constant = 0.8;
  return p;
}

// What that test would have recorded, without noise.
est::TankRecord record_of(const sms::Params<double>& p, sms::FlowTestKind kind, bool charge, bool temperature) {
  est::TankRecord r;
  r.charge = charge;
  r.time = Eigen::VectorXd::LinSpaced(801, 0.0, 8.0);
  r.pressure = Eigen::VectorXd::Zero(801);
  r.pressure.tail(800) = Eigen::VectorXd::LinSpaced(800, 0.0, 4e5);
  if (temperature) {
    r.temperature = Eigen::VectorXd::Zero(801);
  }
  for (int pass = 0; pass < 3; ++pass) {  // until the steps are those that belong to the record itself
    Eigen::VectorXd residual;
    est::TankProblem(r, kind).evaluate(p, {}, &residual, nullptr);
    r.pressure += residual.head(801);
    if (temperature) {
      r.temperature += residual.tail(801);
    }
  }
  return r;
}

}  // namespace

TEST_CASE("the tank's jacobian agrees with differences, by every law, charging and discharging") {
  sms_test::Random random;
  for (const sms::FlowTestKind kind : {kIso, kEnergy, kClassic}) {
    for (const bool charge : {true, false}) {
      sms::Params<double> p = test_of(charge, random);
      p.tank_line_resistance = 1e5;
      const est::TankProblem problem(record_of(p, kind, charge, true), kind);
      std::vector<int> free = {sms::index_of_tank_initial_pressure, sms::index_of_tank_volume,
                               sms::index_of_air_temperature, sms::index_of_tank_line_resistance,
                               sms::index_of_sensor_gain_tank_pressure};
      free.push_back(charge ? sms::index_of_supply_pressure : sms::index_of_ambient_pressure);
      if (kind.heat == sms::ChamberLaw::energy) {
        free.insert(free.end(), {sms::index_of_heat_transfer_coefficient, sms::index_of_wall_temperature,
                                 sms::index_of_thermocouple_time_constant});
      }
      if (kind.law == sms::FlowLaw::iso) {
        free.insert(free.end(), {sms::index_of_component_conductance, sms::index_of_component_critical_ratio,
                                 sms::index_of_component_subsonic_index});
      } else {
        free.push_back(sms::index_of_discharge_coefficient);
      }
      Eigen::VectorXd r;
      est::RowMatrix jacobian;
      problem.evaluate(p, free, &r, &jacobian);
      CHECK(r.cwiseAbs().maxCoeff() < 1e-6);
      for (std::size_t k = 0; k < free.size(); ++k) {
        const double h =
            1e-6 * std::max(std::abs(sms::param(p, free[k])), 1e-3 * std::abs(sms_param_describe(free[k])->value));
        if (!(h > 0.0)) continue;
        const Eigen::VectorXd column = jacobian.col(static_cast<Eigen::Index>(k));
        // A row in whose stencil the tank fills up (the flow's slope turns there) is judged by the narrower stencil.
        Eigen::VectorXd error = Eigen::VectorXd::Constant(column.size(), INFINITY);
        for (const double step : {h, 0.01 * h}) {
          sms::Params<double> up = p, down = p;
          sms::param(up, free[k]) += step;
          sms::param(down, free[k]) -= step;
          Eigen::VectorXd ru, rd;
          problem.evaluate(up, {}, &ru, nullptr);
          problem.evaluate(down, {}, &rd, nullptr);
          error = error.cwiseMin(((ru - rd) / (2 * step) - column).cwiseAbs());
        }
        INFO(std::string(sms_param_describe(free[k])->name), ", charge ", charge, ", h ", h);
        CHECK(error.norm() <= 1e-4 * column.norm() + 1e-8 / h);
      }
    }
  }
}

TEST_CASE("the moment of opening shifts the curve and nothing else") {
  sms_test::Random random;
  sms::Params<double> p = test_of(true, random);
  p.opening_time = 0.5;
  const est::TankProblem problem(record_of(p, kIso, true, false), kIso);
  Eigen::VectorXd r;
  est::RowMatrix jacobian;
  sms::Params<double> late = p;
  late.opening_time += 0.01;  // one sample
  Eigen::VectorXd shifted;
  problem.evaluate(p, {sms::index_of_opening_time}, &r, &jacobian);
  problem.evaluate(late, {}, &shifted, nullptr);
  const est::TankRecord record = record_of(p, kIso, true, false);
  const Eigen::VectorXd now = shifted + record.pressure;
  CHECK((now.tail(800) - record.pressure.head(800)).cwiseAbs().maxCoeff() < 1e-6);
  // d p / d t_0 = -p'. A full tank settles within two samples, so p' is not that of the samples but of the curve between
  // them: the same record read 10 us earlier and later, which takes the same steps.
  const double h = 1e-5;
  const auto read_later = [&](double by) {
    est::TankRecord moved = record;
    moved.time.array() += by;
    Eigen::VectorXd ahead;
    est::TankProblem(moved, kIso).evaluate(p, {}, &ahead, nullptr);
    return Eigen::VectorXd(ahead + moved.pressure);
  };
  const Eigen::VectorXd rate = (read_later(h) - read_later(-h)) / (2.0 * h);
  for (Eigen::Index i = 60; i < 200; ++i) {
    CHECK(jacobian(i, 0) == doctest::Approx(-rate[i]).epsilon(1e-4).scale(1e5));
  }
}

TEST_CASE("an adiabatic tank that was filled is hotter than the air by eq. 4.27, and a floor is a floor") {
  sms_test::Random random;
  sms::Params<double> p = test_of(true, random);
  p.heat_transfer_coefficient = 0.0;
  p.thermocouple_time_constant = 0.0;
  const est::TankRecord r = record_of(p, kEnergy, true, true);
  // energy: m_end c_v T_end = m_0 c_v T_0 + (m_end - m_0) c_p T, with p V = m R T at both ends
  const double p0 = p.tank_initial_pressure, ps = p.supply_pressure, kappa = p.heat_capacity_ratio;
  const double end = ps / (p0 / p.wall_temperature + (ps - p0) / (kappa * p.air_temperature));
  CHECK(r.pressure[800] == doctest::Approx(ps).epsilon(1e-6));
  CHECK(r.temperature[800] == doctest::Approx(end).epsilon(1e-4));

  sms::Params<double> floored = test_of(false, random);
  floored.tank_pressure_floor = 1.3e5;
  floored.tank_pressure_ceiling = 4.5e5;
  const est::TankRecord d = record_of(floored, kIso, false, false);
  CHECK(d.pressure.minCoeff() == doctest::Approx(1.3e5));
  CHECK(d.pressure.maxCoeff() == doctest::Approx(4.5e5));
}

TEST_CASE("the integration is exact to less than a pascal in the mean") {
  // A choked discharge at constant temperature is p = p_0 exp(-t / T), T = V / (alpha_o R T C rho_0 sqrt(T_0 / T)).
  sms_test::Random random;
  sms::Params<double> p = test_of(false, random);
  p.opening_duration = 0.0;
  p.component_critical_ratio = 0.9;
  const est::TankRecord r = record_of(p, kIso, false, false);
  const double T = p.air_temperature;
  const double rate = p.outflow_heat_ratio * p.gas_constant * T * p.component_conductance * p.reference_density *
                      std::sqrt(p.reference_temperature / T) / p.tank_volume;
  for (Eigen::Index i = 0; i < 801; ++i) {
    const double exact = p.tank_initial_pressure * std::exp(-rate * std::max(0.0, r.time[i] - p.opening_time));
    if (exact > p.ambient_pressure / 0.89) {
      CHECK(std::abs(r.pressure[i] - exact) < 1.0);
    }
  }
}

TEST_CASE("a tank fit recovers what made the record; what it cannot feel is refused by name") {
  sms_test::Random random;
  for (const bool charge : {true, false}) {
    const sms::Params<double> truth = test_of(charge, random);
    const est::TankProblem problem(record_of(truth, kIso, charge, false), kIso);
    sms::Params<double> start = truth;
    start.component_conductance *= 1.3;
    start.component_critical_ratio = 0.3;
    start.component_subsonic_index = 1.3;
    start.opening_time += 0.02;
    const std::vector<est::FreeParam> free = {{sms::index_of_component_conductance, 0.0, 1e-5},
                                              {sms::index_of_component_critical_ratio, 0.0, 0.95},
                                              {sms::index_of_component_subsonic_index, 0.05, 50.0},
                                              {sms::index_of_opening_time, -1e6, 1e6},
                                              {sms::index_of_tank_initial_pressure, 1.0, 1e9}};
    const est::Fit fit = est::fit(problem, start, free, {});
    CHECK(fit.params.component_conductance == doctest::Approx(truth.component_conductance).epsilon(1e-6));
    CHECK(fit.params.component_critical_ratio == doctest::Approx(truth.component_critical_ratio).epsilon(1e-4));
    CHECK(fit.params.component_subsonic_index == doctest::Approx(truth.component_subsonic_index).epsilon(1e-4));
    CHECK(fit.params.opening_time == doctest::Approx(truth.opening_time).epsilon(1e-6));
    CHECK(fit.condition > 1.0);
    CHECK(fit.condition < 1e4);
    CHECK_THROWS_WITH_AS(est::fit(problem, start, {{sms::index_of_heat_transfer_coefficient, 0.0, 1e3}}, {}),
                         doctest::Contains("heat_transfer_coefficient"), std::invalid_argument);
    // Volume and conductance are one number to a tank with constant temperature, and the condition says so.
    const est::Fit both = est::fit(problem, start, {free[0], {sms::index_of_tank_volume, 4e-3, 6e-3}}, {});
    CHECK(both.condition > 1e6);
  }
}

TEST_CASE("Huber's loss holds against wild readings that spoil least squares") {
  sms_test::Random random;
  const sms::Params<double> truth = test_of(true, random);
  est::TankRecord r = record_of(truth, kIso, true, false);
  for (Eigen::Index i = 0; i < r.pressure.size(); ++i) {
    r.pressure[i] += random.uniform(-300.0, 300.0) + (i % 20 == 0 ? 5e4 : 0.0);
  }
  const est::TankProblem problem(r, kIso);
  const std::vector<est::FreeParam> free = {{sms::index_of_component_conductance, 0.0, 1e-5}};
  const Eigen::VectorXd weight = Eigen::VectorXd::Constant(problem.rows(), 1.0 / 175.0);
  est::FitOptions robust;
  robust.huber = 2.0;
  const double squares = est::fit(problem, truth, free, weight).params.component_conductance;
  const double huber = est::fit(problem, truth, free, weight, robust).params.component_conductance;
  const double C = truth.component_conductance;
  CHECK(std::abs(huber / C - 1.0) < 0.3 * std::abs(squares / C - 1.0));
}

TEST_CASE("a tank record with a hole, a NaN or a clock that stands still is refused by name") {
  sms_test::Random random;
  const est::TankRecord good = record_of(test_of(true, random), kIso, true, false);
  est::TankRecord r = good;
  r.pressure[3] = std::nan("");
  CHECK_THROWS_WITH_AS(est::TankProblem(r, kIso), doctest::Contains("pressure"), std::invalid_argument);
  r = good;
  r.supply = Eigen::VectorXd::Zero(7);
  CHECK_THROWS_WITH_AS(est::TankProblem(r, kIso), doctest::Contains("7 samples"), std::invalid_argument);
  r = good;
  r.time[5] = r.time[4];
  CHECK_THROWS_WITH_AS(est::TankProblem(r, kIso), doctest::Contains("time does not rise"), std::invalid_argument);
}
