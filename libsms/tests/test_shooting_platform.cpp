// The platform held against records: the plant of record, simulated whole, against its pistons along the measured path.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "estimation/platform_plant.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/integrate.hpp"

namespace est = sms::estimation;

namespace {

constexpr double kStep = 0.005;
constexpr int kSamples = 120;
const sms::ActuatorLaws laws = sms::published_laws();

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

est::PlatformNoise noise() {
  est::PlatformNoise n;
  n.extension.setConstant(1e-4);
  n.pressure_lower.setConstant(300.0);
  n.pressure_upper.setConstant(300.0);
  n.supply_pressure = 300.0;
  n.attitude.setConstant(2e-4);
  return n;
}

double command(double time, int leg) { return 5.0 + 0.9 * std::sin(5.0 * time + 2.0 * leg); }

// A record of the whole platform (platform.hpp) by small steps of fourth order.
est::PlatformRecord simulated(const sms::LegParams<double>& params) {
  sms::Platform<double> platform = sms::make_platform<double>(params, laws, sms::MassModel::corrected);
  for (int i = 0; i < 3; ++i) {
    platform.params[i] = sms::params_of_leg(params, i);
  }
  sms::PlatformState<double> state;
  REQUIRE(sms::platform_at_rest(platform, {0.02, -0.01, 0.5}, 3e5, state) == SMS_OK);
  sms::PlatformTerms<double> t;
  sms::prepare(platform, t);
  est::PlatformRecord r;
  r.step = kStep;
  for (est::LegSignals* legs : {&r.command, &r.extension, &r.pressure_lower, &r.pressure_upper}) {
    legs->fill(Eigen::VectorXd(kSamples));
  }
  for (Eigen::VectorXd* signal : {&r.supply_pressure, &r.roll, &r.pitch}) {
    signal->resize(kSamples);
  }
  const auto derivative = [&](double time, const sms::PlatformState<double>& y, sms::PlatformState<double>& rate) {
    const double sample = std::floor(time / kStep + 1e-9), part = time / kStep - sample;
    sms::PlatformInput<double> input;
    for (int i = 0; i < 3; ++i) {
      input.command(i) = (1.0 - part) * command(sample * kStep, i) + part * command((sample + 1.0) * kStep, i);
    }
    input.wrench.force.setZero();
    input.wrench.moment.setZero();
    return sms::derivative(platform, y, input, t, rate);
  };
  for (int k = 0; k < kSamples; ++k) {
    sms::PlatformState<double> rate;
    derivative(k * kStep, state, rate);
    for (int i = 0; i < 3; ++i) {
      const std::size_t leg = static_cast<std::size_t>(i);
      r.command[leg][k] = command(k * kStep, i);
      r.extension[leg][k] = t.extension(i);
      r.pressure_lower[leg][k] = state.actuator[i].lower.pressure;
      r.pressure_upper[leg][k] = state.actuator[i].upper.pressure;
    }
    r.supply_pressure[k] = state.actuator[0].supply_pressure;
    r.roll[k] = state.q(0);
    r.pitch[k] = state.q(1);
    for (int step = 0; step < 50; ++step) {
      REQUIRE(sms::runge_kutta_step(derivative, k * kStep + step * kStep / 50, kStep / 50, state) == SMS_OK);
    }
  }
  return r;
}

est::ShootingProblem<est::PlatformPlant> problem_of(const est::PlatformRecord& record) {
  return {est::PlatformPlant({record}, noise(), laws, sms::MassModel::corrected, 2.5e-3), {0.5, 0.1, 1}};
}

double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

}  // namespace

TEST_CASE("platform: a record of the whole machine leaves next to nothing at its own parameters") {
  sms::LegParams<double> truth;
  truth.shift[1].chamber_leakage_lower = 4e-9;
  truth.panhard_friction = 200.0;
  const auto problem = problem_of(simulated(truth));
  CHECK(problem.windows().size() == 1);
  Eigen::VectorXd residual;
  est::RowMatrix jacobian;
  const int leak = sms::leg_param_index(sms::index_of_chamber_leakage_lower, 2);
  const int rods = sms::leg_param_index(sms::index_of_panhard_friction, 0);
  const int payload = sms::leg_param_index(sms::index_of_payload_mass, 0);
  problem.evaluate(truth, {leak, rods, payload}, &residual, &jacobian);
  CHECK(rms(residual) < 0.15);

  // A wrong parameter shows, and the derivative says by how much.
  const auto shows = [&](int index, double step, int column) {
    CAPTURE(column);
    sms::LegParams<double> other = truth;
    sms::param(other, index) += step;
    Eigen::VectorXd there;
    problem.evaluate(other, {}, &there, nullptr);
    CHECK(rms(there - residual) > 0.05);
    CHECK((there - residual - step * jacobian.col(column)).norm() < 0.1 * (there - residual).norm());
  };
  shows(leak, 1e-9, 0);
  shows(rods, 400.0, 1);
  shows(payload, 10.0, 2);
}

TEST_CASE("platform: neutral effects leave a simulation unchanged to the bit, of one leg as of all") {
  const est::PlatformRecord record = simulated(sms::LegParams<double>());
  const est::PlatformPlant plant({record}, noise(), laws, sms::MassModel::corrected, 2.5e-3);
  const int rows = 40 * plant.channels(0);
  const est::Window window{0, 20, 40, 0, rows, plant.guess(0, 20)};
  const auto readings = [&](const sms::LegParams<double>& p) {
    Eigen::VectorXd out(rows);
    plant.simulate(p, window, window.start.data(), out.data());
    return out;
  };
  const Eigen::VectorXd plain = readings(sms::LegParams<double>());
  using Effect = std::pair<int, double>;
  for (const Effect& effect :
       {Effect{sms::index_of_presliding_share, 0.5}, Effect{sms::index_of_friction_lag, 0.01},
        Effect{sms::index_of_command_delay, 0.01}, Effect{sms::index_of_backlash, 1e-3},
        Effect{sms::index_of_frame_compliance, 1e-6}, Effect{sms::index_of_panhard_friction, 100.0},
        Effect{sms::index_of_sensor_lag_roll, 0.01}, Effect{sms::index_of_sensor_gain_pitch, 0.01},
        Effect{sms::index_of_clock_skew_attitude, 0.01}, Effect{sms::index_of_sensor_offset_roll, 1e-3}}) {
    CAPTURE(std::string(sms_param_describe(effect.first)->name));
    sms::LegParams<double> changed;
    sms::param(changed, effect.first) = effect.second;
    CHECK((readings(changed) - plain).cwiseAbs().maxCoeff() > 1e-3);
    sms::param(changed, effect.first) = 0.0;
    const Eigen::VectorXd again = readings(changed);
    for (int i = 0; i < rows; ++i) {
      CHECK(same_bits(again[i], plain[i]));
    }
  }
}

TEST_CASE("platform: what one leg has more is in its own readings first") {
  const est::PlatformRecord record = simulated(sms::LegParams<double>());
  const est::PlatformPlant plant({record}, noise(), laws, sms::MassModel::corrected, 2.5e-3);
  const int channels = plant.channels(0), rows = 20 * channels;
  CHECK(channels == 12);
  const est::Window window{0, 20, 20, 0, rows, plant.guess(0, 20)};
  Eigen::VectorXd plain(rows), leaking(rows);
  sms::LegParams<double> p;
  plant.simulate(p, window, window.start.data(), plain.data());
  p.shift[2].piston_leakage = 1e-8;
  plant.simulate(p, window, window.start.data(), leaking.data());
  const est::RowMatrix off = Eigen::Map<est::RowMatrix>(Eigen::VectorXd(leaking - plain).data(), 20, channels);
  for (const int of_other : {3, 4, 6, 7}) {
    CHECK(off.col(of_other).norm() < 0.2 * off.col(5).norm());
    CHECK(off.col(of_other).norm() < 0.2 * off.col(8).norm());
  }
}

TEST_CASE("platform: droop and deflection are felt at the start by those machines only that are said to") {
  const est::PlatformRecord record = simulated(sms::LegParams<double>());
  const est::PlatformPlant plant({record}, noise(), laws, sms::MassModel::corrected, 2.5e-3);
  const int rows = 20 * plant.channels(0);
  const est::Window window{0, 20, 20, 0, rows, plant.guess(0, 20)};
  const auto moves = [&](const sms::LegParams<double>& p, int number) {
    Eigen::VectorXd start = window.start, plain(rows), moved(rows);
    plant.simulate(p, window, start.data(), plain.data());
    start[number] += est::PlatformPlant::start_scale(number);
    plant.simulate(p, window, start.data(), moved.data());
    return (moved - plain).cwiseAbs().maxCoeff();
  };
  sms::LegParams<double> p;
  CHECK_FALSE(plant.feels_all(p, window));
  for (int k = 0; k < est::PlatformPlant::kStart; ++k) {
    CAPTURE(k);
    CHECK((moves(p, k) > 0.0) == (k < est::PlatformPlant::kFelt));
  }
  p.shift[1].presliding_share = 0.5;
  CHECK(plant.feels_all(p, window));
  CHECK(moves(p, 16) > 0.0);
  p.shift[1].presliding_share = 0.0;
  p.supply_line_resistance = 1e6;
  CHECK(plant.feels_all(p, window));
  CHECK(moves(p, 12) > 0.0);
}

TEST_CASE("platform: a path that is remembered follows mechanism and sensors") {
  const est::PlatformRecord record = simulated(sms::LegParams<double>());
  const auto make = [&record] {
    return est::PlatformPlant({record}, noise(), laws, sms::MassModel::corrected, 2.5e-3);
  };
  const est::PlatformPlant plant = make();
  const int rows = 20 * plant.channels(0);
  const auto readings = [rows](const est::PlatformPlant& of, const sms::LegParams<double>& p, int first) {
    const est::Window window{0, first, 20, 0, rows, of.guess(0, first)};
    Eigen::VectorXd out(rows);
    of.simulate(p, window, window.start.data(), out.data());
    return out;
  };
  for (const int changed : {sms::index_of_payload_mass, sms::index_of_gravity, sms::index_of_sensor_gain_extension,
                            sms::index_of_clock_skew_extension, sms::index_of_coulomb_force}) {
    CAPTURE(std::string(sms_param_describe(changed)->name));
    sms::LegParams<double> p;
    sms::param(p, changed) += 0.01;
    for (const int first : {20, 60}) {
      const Eigen::VectorXd before = readings(plant, sms::LegParams<double>(), first),
                            after = readings(plant, p, first);
      CHECK((after - before).cwiseAbs().maxCoeff() > 0.0);
      CHECK((after - readings(make(), p, first)).cwiseAbs().maxCoeff() <= 0.0);
    }
  }
}

TEST_CASE("platform: bad records are refused") {
  est::PlatformRecord record = simulated(sms::LegParams<double>());
  const auto refused = [](const est::PlatformRecord& r) {
    CHECK_THROWS_AS(est::PlatformPlant({r}, noise(), laws, sms::MassModel::corrected, 2.5e-3), std::invalid_argument);
  };
  est::PlatformRecord bad = record;
  bad.pressure_upper[1].conservativeResize(kSamples - 1);
  refused(bad);
  bad = record;
  bad.extension[0][3] = std::nan("");
  refused(bad);
  bad = record;
  bad.step = 0.0;
  refused(bad);
}
