// The tank held against records window by window: neutral effects, derivatives, the two laws of heat, bad input.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "estimation/tank_plant.hpp"

namespace est = sms::estimation;

namespace {

constexpr double kStep = 0.005;
constexpr int kChannels = 3;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Fills and vents at changing openings, with pauses.
Eigen::VectorXd command(int samples) {
  Eigen::VectorXd u(samples);
  for (int k = 0; k < samples; ++k) {
    const double t = kStep * k;
    u[k] = 5.0 + 1.6 * std::sin(4.0 * t) + 0.5 * std::sin(11.0 * t + 1.0);
  }
  return u;
}

est::TankPlantRecord record_of(const Eigen::MatrixXd& y) {
  return {kStep, command(static_cast<int>(y.rows())), y.col(0), y.col(1), y.col(2), {}};
}

// Readings of the model itself, (samples x kChannels), from a quarter full and a little warmer than the room.
Eigen::MatrixXd simulated(const sms::Params<double>& p, int samples, sms::ChamberLaw heat = sms::ChamberLaw::polytropic,
                          double longest_step = 1e-3) {
  sms::ActuatorLaws laws = sms::published_laws();
  laws.chamber = heat;
  const est::TankPlant plant({record_of(Eigen::MatrixXd::Zero(samples, kChannels))}, {1.0, 1.0, 1.0}, laws,
                             longest_step);
  const double start[est::TankPlant::kStart] = {2e5, 296.0, 4.8e5, 295.0};
  Eigen::VectorXd out(kChannels * samples);
  plant.simulate(p, {0, 0, samples, 0, kChannels * samples, {}}, start, out.data());
  return Eigen::Map<est::RowMatrix>(out.data(), samples, kChannels);
}

using Effect = std::pair<int, double>;
const Effect kEffects[] = {{sms::index_of_tank_flow_change, 0.1},
                           {sms::index_of_exhaust_flow_change, 0.1},
                           {sms::index_of_valve_leakage, 1e-9},
                           {sms::index_of_chamber_leakage_lower, 1e-8},
                           {sms::index_of_dead_band_change, 0.05},
                           {sms::index_of_tube_length, 2.0},
                           {sms::index_of_supply_line_resistance, 1e6},
                           {sms::index_of_heat_share, 0.5},
                           {sms::index_of_command_delay, 0.02},
                           {sms::index_of_sensor_lag_tank_pressure, 0.02},
                           {sms::index_of_sensor_gain_tank_pressure, 0.01},
                           {sms::index_of_sensor_offset_tank_pressure, 1e3},
                           {sms::index_of_sensor_offset_tank_temperature, 1.0},
                           {sms::index_of_sensor_gain_supply_pressure, 0.01},
                           {sms::index_of_clock_skew_tank, 0.002}};

}  // namespace

TEST_CASE("tank: neutral effects leave a simulation unchanged to the bit, and others do not") {
  const sms::Params<double> p;
  const Eigen::MatrixXd plain = simulated(p, 300);
  for (const Effect& effect : kEffects) {
    CAPTURE(std::string(sms_param_describe(effect.first)->name));
    sms::Params<double> changed = p;
    sms::param(changed, effect.first) = 0.0;
    const Eigen::MatrixXd neutral = simulated(changed, 300);
    CHECK(std::equal(neutral.data(), neutral.data() + neutral.size(), plain.data(), same_bits));
    sms::param(changed, effect.first) = effect.second;
    CHECK((simulated(changed, 300) - plain).cwiseAbs().maxCoeff() > 1e-3);
  }
}

TEST_CASE("tank: derivatives of a simulation are those of differences, at neutral values and away from them") {
  using Jet = est::ParameterJet;
  const int samples = 200;
  const est::TankPlant plant({record_of(Eigen::MatrixXd::Zero(samples, kChannels))}, {100.0, 1.0, 100.0},
                             sms::published_laws(), 1e-3);
  const est::Window window{0, 0, samples, 0, kChannels * samples, {}};
  const double start[est::TankPlant::kStart] = {2e5, 296.0, 4.8e5, 295.0};
  sms::Params<double> away;
  away.heat_share = 0.6;
  away.sensor_lag_tank_pressure = 0.013;
  away.thermocouple_time_constant = 0.4;
  away.supply_line_resistance = 2e6;
  away.valve_leakage = 1e-10;
  for (const sms::Params<double>& p : {sms::Params<double>(), away}) {
    for (const Effect& one :
         {Effect{sms::index_of_tank_flow_change, 1e-7}, Effect{sms::index_of_tank_volume, 1e-9},
          Effect{sms::index_of_heat_share, 1e-7}, Effect{sms::index_of_valve_leakage, 1e-16},
          Effect{sms::index_of_clock_skew_tank, 1e-7}, Effect{sms::index_of_sensor_lag_tank_pressure, 1e-7},
          Effect{sms::index_of_thermocouple_time_constant, 1e-7}, Effect{sms::index_of_supply_pressure, 1.0}}) {
      CAPTURE(std::string(sms_param_describe(one.first)->name));
      sms::Params<Jet> seeded = sms::cast<Jet>(p);
      sms::param(seeded, one.first).v[0] = 1.0;
      Jet from[est::TankPlant::kStart], exact[kChannels * samples];
      std::transform(std::begin(start), std::end(start), from, [](double value) { return Jet(value); });
      plant.simulate(seeded, window, from, exact);
      const auto at = [&](double shift) {
        sms::Params<double> moved = p;
        sms::param(moved, one.first) += shift;
        Eigen::VectorXd out(kChannels * samples);
        plant.simulate(moved, window, start, out.data());
        return out;
      };
      Eigen::VectorXd slope(kChannels * samples);
      std::transform(std::begin(exact), std::end(exact), slope.data(), [](const Jet& jet) { return jet.v[0]; });
      // Forwards: some of these end at zero. The warm air's start counts from the first bit of heat_share on.
      const Eigen::VectorXd difference = (at(2.0 * one.second) - at(one.second)) / one.second;
      CHECK((difference - slope).norm() < 1e-3 * slope.norm() + 1e-9);
    }
  }
}

TEST_CASE("tank: steps that grow while the command rests change readings by far less than their noise") {
  const int samples = 2000;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(samples);
  Eigen::VectorXd steps_up = Eigen::VectorXd::Constant(samples, 5.0);
  steps_up.tail(samples - 100).setConstant(5.9);
  steps_up.tail(samples - 900).setConstant(4.2);
  const double step = 0.01;
  const est::LongestSteps longest{2.5e-3, 0.05};
  const est::SampleSteps cut = est::steps_by_command(steps_up, step, longest);
  CHECK(cut.of(90) == est::Pace{1, 5});
  CHECK(cut.of(98) == est::Pace{1, 1});  // a long step does not go over the jump at 100
  CHECK(cut.of(99) == est::Pace{4, 1});
  CHECK(cut.of(105) == est::Pace{4, 1});
  CHECK(cut.of(190) == est::Pace{3, 1});  // 0.9 s after the jump; they grow with the time since
  CHECK(cut.of(350) == est::Pace{1, 1});
  CHECK(cut.of(720) == est::Pace{1, 3});
  CHECK(cut.of(897) == est::Pace{1, 2});
  for (const double share : {0.0, 0.8}) {
    sms::Params<double> p;
    p.heat_share = share;
    p.thermocouple_time_constant = 0.3;
    p.sensor_lag_tank_pressure = 0.013;
    p.supply_line_resistance = 1e6;
    const est::Window window{0, 0, samples, 0, kChannels * samples, {}};
    const double start[est::TankPlant::kStart] = {2e5, 296.0, 4.8e5, 295.0};
    const auto readings = [&](const est::TankPlantRecord& record, const est::LongestSteps& steps) {
      Eigen::VectorXd out(kChannels * samples);
      est::TankPlant({record}, {1.0, 1.0, 1.0}, sms::published_laws(), steps).simulate(p, window, start, out.data());
      return Eigen::MatrixXd(Eigen::Map<est::RowMatrix>(out.data(), samples, kChannels));
    };
    const Eigen::MatrixXd fine = readings({step, steps_up, zero, zero, zero, {}}, 5e-5);
    const Eigen::MatrixXd off =
        readings({step, steps_up, fine.col(0), fine.col(1), fine.col(2), {}}, longest).cwiseAbs();
    CHECK(off.col(0).maxCoeff() < 100.0);
    CHECK(off.col(1).maxCoeff() < 0.02);
    CHECK(off.maxCoeff() > 0.0);
  }
}

TEST_CASE("tank: heat_share 1 is the full energy equation") {
  sms::Params<double> p;
  p.heat_share = 1.0;
  const Eigen::MatrixXd blended = simulated(p, 400), full = simulated(p, 400, sms::ChamberLaw::energy);
  CHECK((blended.col(0) - full.col(0)).cwiseAbs().maxCoeff() < 1e-6 * 4e5);
  CHECK((blended.col(1) - full.col(1)).cwiseAbs().maxCoeff() < 1e-6 * 300.0);
  CHECK((full.col(1).maxCoeff() - full.col(1).minCoeff()) > 5.0);
}

TEST_CASE("tank: halving the step changes readings by far less than their noise, and a tiny tank stays finite") {
  sms::Params<double> p;
  p.heat_share = 0.5;
  const Eigen::MatrixXd coarse = simulated(p, 300), fine = simulated(p, 300, sms::ChamberLaw::polytropic, 2e-4);
  CHECK((coarse.col(0) - fine.col(0)).cwiseAbs().maxCoeff() < 60.0);
  p.tank_volume = 2e-5;
  p.supply_line_resistance = 1e3;
  const Eigen::MatrixXd tiny = simulated(p, 300);
  CHECK(tiny.allFinite());
  CHECK(tiny.col(0).minCoeff() > 0.5 * p.ambient_pressure);
  CHECK(tiny.col(0).maxCoeff() < 1.5 * p.supply_pressure);
}

TEST_CASE("tank: a record of the model itself leaves nothing") {
  sms::Params<double> p;
  p.tank_flow_change = 0.1;
  const Eigen::MatrixXd y = simulated(p, 620);
  const est::ShootingProblem<est::TankPlant> problem(
      est::TankPlant({record_of(y)}, {300.0, 0.1, 300.0}, sms::published_laws(), 1e-3), {1.0, 0.1, 1});
  Eigen::VectorXd with, without;
  problem.evaluate(p, {}, &with, nullptr);
  problem.evaluate(sms::Params<double>(), {}, &without, nullptr);
  CHECK(with.cwiseAbs().maxCoeff() < 0.3);
  CHECK(without.norm() > 50.0);
}

TEST_CASE("tank: a reading that is NaN is compared with nothing, at the beginning of a window too") {
  const sms::Params<double> p;
  Eigen::MatrixXd y = simulated(p, 300);
  const auto held_against = [](const Eigen::MatrixXd& record) {
    return est::ShootingProblem<est::TankPlant>(
        est::TankPlant({record_of(record)}, {1.0, 1.0, 1.0}, sms::published_laws(), 1e-3), {});
  };
  const int begins = held_against(y).windows().back().first;
  y.block(begins - 2, 0, 30, 1).setConstant(std::nan(""));
  y(20, 0) = std::nan("");
  const auto problem = held_against(y);
  Eigen::VectorXd residual;
  problem.evaluate(p, {}, &residual, nullptr);
  CHECK(residual.allFinite());
  CHECK(problem.errors(p).cwiseAbs().maxCoeff() < 1.0);
}

TEST_CASE("tank: after parameters beyond numbers a search begins where it began before") {
  const sms::Params<double> p;
  const est::TankPlant plant({record_of(simulated(p, 300))}, {100.0, 1.0, 100.0}, sms::published_laws(), 1e-3);
  est::ShootingProblem<est::TankPlant> problem(plant, {});
  Eigen::VectorXd residual;
  est::RowMatrix jacobian;
  const std::vector<int> free = {sms::index_of_tank_volume};
  sms::Params<double> broken = p;
  broken.tank_volume = std::numeric_limits<double>::quiet_NaN();
  problem.evaluate(broken, free, &residual, &jacobian);
  CHECK_FALSE(residual.allFinite());
  problem.evaluate(p, free, &residual, nullptr);
  CHECK(residual.norm() < 5.0);
  problem.evaluate(p, free, &residual, &jacobian);
  CHECK(residual.norm() < 5.0);
  CHECK(jacobian.allFinite());
}

TEST_CASE("tank: what cannot be a record is refused") {
  const Eigen::VectorXd good = Eigen::VectorXd::Constant(100, 5.0), bad = Eigen::VectorXd::Constant(99, 5.0);
  Eigen::VectorXd endless = good;
  endless[50] = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd nowhere = Eigen::VectorXd::Constant(100, std::nan(""));
  const auto make = [](const est::TankPlantRecord& record) {
    return est::TankPlant({record}, {1.0, 1.0, 1.0}, sms::published_laws(), 1e-3);
  };
  CHECK_NOTHROW(make({kStep, good, good, {}, {}, {}}));
  CHECK_THROWS_WITH_AS(make({kStep, good, bad, {}, {}, {}}), doctest::Contains("pressure has 99 samples"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(make({kStep, good, good, endless, {}, {}}), doctest::Contains("temperature holds"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(make({kStep, good, nowhere, {}, {}, {}}), doctest::Contains("pressure is nowhere within"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(make({0.0, good, good, {}, {}, {}}), doctest::Contains("step of time"), std::invalid_argument);
}
