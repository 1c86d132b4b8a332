// A simulation held against records window by window: derivatives, neutral effects, the stiff step, bad input.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>
#include <utility>

#include "estimation/bench_plant.hpp"
#include "estimation/shooting_search.hpp"
#include "random_cases.hpp"

namespace est = sms::estimation;

namespace {

constexpr double kStep = 0.005;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Eigen::VectorXd command(int samples, double step = kStep) {
  Eigen::VectorXd u(samples);
  for (int k = 0; k < samples; ++k) {
    u[k] = 5.0 + 0.9 * std::sin(3.1 * step * k) + 0.5 * std::sin(10.7 * step * k + 1.0);
  }
  return u;
}

const est::BenchNoise unit_noise{1.0, 1.0, 1.0, 1.0};

// Readings of the model itself from mid-stroke, (samples x 3).
Eigen::MatrixXd simulated(const sms::Params<double>& p, int samples, double longest_step) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(samples);
  const est::BenchRecord record{kStep, command(samples), zero, zero, zero, {}, {}};
  const est::BenchPlant plant({record}, unit_noise, sms::published_laws(), longest_step);
  const est::Window window{0, 0, samples, 0, 3 * samples, {}};
  const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0};
  Eigen::VectorXd out(3 * samples);
  plant.simulate(p, window, start, out.data());
  return Eigen::Map<est::RowMatrix>(out.data(), samples, 3);
}

est::ShootingProblem<est::BenchPlant> problem_of(const sms::Params<double>& truth, int samples,
                                                 double least_gain = 0.1) {
  const Eigen::MatrixXd y = simulated(truth, samples, 1e-3);
  const est::BenchRecord record{kStep, command(samples), y.col(0), y.col(1), y.col(2), {}, {}};
  est::WindowOptions options;
  options.least_gain = least_gain;
  options.least_share = 0.01 * least_gain;
  return {est::BenchPlant({record}, {1e-4, 500.0, 500.0, 500.0}, sms::published_laws(), 1e-3), options};
}

}  // namespace

TEST_CASE("the stiff step: halving it changes readings by far less than their noise") {
  const sms::Params<double> p;
  const Eigen::MatrixXd coarse = simulated(p, 200, 1e-3), fine = simulated(p, 200, 2e-4);
  CHECK((coarse.col(0) - fine.col(0)).cwiseAbs().maxCoeff() < 5e-5);
  CHECK((coarse.col(1) - fine.col(1)).cwiseAbs().maxCoeff() < 150.0);
  CHECK((coarse.col(2) - fine.col(2)).cwiseAbs().maxCoeff() < 150.0);
}

TEST_CASE("steps of a record: few where every piston is well on its way, most near rest and at the ends") {
  const int samples = 400;
  Eigen::VectorXd there_and_back(samples), always(samples);
  for (int k = 0; k < samples; ++k) {
    there_and_back[k] = 0.2 - 0.1 * std::cos(2.0 * 3.14159265358979 * kStep * k);  // stands still at 0, 100, 200, ...
    always[k] = 0.1 + 0.1 * kStep * k;
  }
  const est::LongestSteps longest{1e-3, 2.5e-3};
  const est::SampleSteps one = est::steps_by_motion({&there_and_back}, kStep, longest);
  CHECK(one.most() == 5);
  for (const int rest : {0, 1, 99, 100, 101, 200, 300, samples - 1}) {
    CHECK(one.of(rest).parts == 5);
  }
  for (const int fast : {25, 50, 75, 150, 250, 325}) {
    CHECK(one.of(fast).parts == 2);
  }
  const est::SampleSteps other = est::steps_by_motion({&always}, kStep, longest);
  CHECK(other.of(100).parts == 2);
  CHECK(est::steps_by_motion({&always, &there_and_back}, kStep, longest).of(100).parts == 5);
  CHECK(est::steps_by_motion({&always}, kStep, 1e-3).of(100).parts == 5);
  const est::SampleSteps quick = est::steps_by_motion({&always}, 1e-3, longest);
  CHECK(quick.of(100) == est::Pace{1, 2});
  CHECK(quick.of(samples - 1) == est::Pace{1, 1});
}

TEST_CASE("a command over several samples: its mean, held or straight, and a delay moves it smoothly") {
  Eigen::VectorXd volts(6);
  volts << 1.0, 2.0, 4.0, 3.0, 3.0, 3.0;
  const auto arriving = [&](est::Hold hold, double at, double late) {
    est::RecordedVoltage<double> command(volts, hold, late);
    CHECK(command.begin_step(at, {1, 3}));
    return command.at(at + 1.0);
  };
  CHECK(arriving(est::Hold::previous, 0.0, 0.0) == doctest::Approx((1.0 + 2.0 + 4.0) / 3.0));
  CHECK(arriving(est::Hold::previous, 1.0, 0.25) == doctest::Approx((0.25 * 1.0 + 2.0 + 4.0 + 0.75 * 3.0) / 3.0));
  CHECK(arriving(est::Hold::previous, 3.0, 0.0) == doctest::Approx(3.0));
  CHECK(arriving(est::Hold::linear, 0.0, 0.0) == doctest::Approx((0.5 * 1.0 + 2.0 + 4.0 + 0.5 * 3.0) / 3.0));
  CHECK(arriving(est::Hold::linear, 1.0, 0.5) == doctest::Approx((0.5 * 1.5 + 3.0 + 3.5 + 0.5 * 3.0) / 3.0));
  est::RecordedVoltage<double> command(volts, est::Hold::linear, 0.0);
  command.begin_step(0.0, {1, 3});
  CHECK(command.begin_step(3.0, {1, 1}));  // the mean before is no more
  CHECK(command.at(3.0) == doctest::Approx(3.0));
  CHECK_FALSE(command.begin_step(4.0, {1, 1}));
}

TEST_CASE("within a step: cubics are met exactly, with their slopes") {
  using State = sms::TankState<double>;
  const auto cubic = [](double t, State* rate) {
    State state;
    for (int k = 0; k < sms::vector_of(state).size(); ++k) {
      const double a = 1.0 + k, b = -2.0, c = 0.5 * k, d = 3.0;
      sms::vector_of(state)[k] = a + t * (b + t * (c + t * d));
      sms::vector_of(*rate)[k] = b + t * (2.0 * c + t * 3.0 * d);
    }
    return state;
  };
  State from_rate, to_rate, rate, true_rate;
  const double h = 0.7;
  const State from = cubic(0.2, &from_rate), to = cubic(0.2 + h, &to_rate);
  for (const double share : {0.0, 0.25, 0.6, 1.0}) {
    const State there = est::within_step(from, from_rate, to, to_rate, share, h, &rate);
    const State truth = cubic(0.2 + share * h, &true_rate);
    CHECK((sms::vector_of(there) - sms::vector_of(truth)).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((sms::vector_of(rate) - sms::vector_of(true_rate)).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("longer steps in motion change readings by far less than their noise, at any rate, slow sensors or not") {
  for (const double step : {kStep, 1e-3}) {
    for (const double lag : {0.0, 1.5e-3, 0.02}) {
      CAPTURE(step);
      CAPTURE(lag);
      sms::Params<double> p;
      p.sensor_lag_extension = lag;
      p.frame_compliance = 1e-6;
      const int samples = static_cast<int>(2.0 / step);
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(samples);
      const est::Window window{0, 0, samples, 0, 3 * samples, {}};
      const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0};
      const auto readings = [&](const est::BenchRecord& record, const est::LongestSteps& longest) {
        Eigen::VectorXd out(3 * samples);
        est::BenchPlant({record}, unit_noise, sms::published_laws(), longest).simulate(p, window, start, out.data());
        return Eigen::MatrixXd(Eigen::Map<est::RowMatrix>(out.data(), samples, 3));
      };
      const Eigen::MatrixXd fine = readings({step, command(samples, step), zero, zero, zero, {}, {}}, 2e-4);
      const est::BenchRecord record{step, command(samples, step), fine.col(0), fine.col(1), fine.col(2), {}, {}};
      const est::LongestSteps longest{1e-3, 2.5e-3};
      const est::SampleSteps steps = est::steps_by_motion({&record.extension}, step, longest);
      int long_ones = 0;
      for (int k = 0; k < samples; ++k) {
        long_ones += steps.of(k) == (step < 2e-3 ? est::Pace{1, 2} : est::Pace{2, 1}) ? 1 : 0;
      }
      CHECK(long_ones > samples / 4);
      const Eigen::MatrixXd off = readings(record, longest).cwiseAbs();
      CHECK(off.col(0).maxCoeff() < 5e-5);
      CHECK(off.col(1).maxCoeff() < 150.0);
      CHECK(off.col(2).maxCoeff() < 150.0);
      CHECK(off.maxCoeff() > 0.0);
    }
  }
}

TEST_CASE("a record of the model itself leaves nothing, and windows cover it") {
  const auto problem = problem_of(sms::Params<double>(), 620);
  Eigen::VectorXd residual;
  problem.evaluate(sms::Params<double>(), {}, &residual, nullptr);
  CHECK(residual.size() == problem.rows());
  CHECK(residual.cwiseAbs().maxCoeff() < 0.3);
  int row = 0, sample = 20;
  for (const est::Window& w : problem.windows()) {
    CHECK(w.row == row);
    CHECK(w.first == sample);
    row += w.rows;
    sample += w.samples;
  }
  CHECK(row == problem.rows());
  CHECK(sample == 620);
}

TEST_CASE("derivatives of a simulation are those of differences, by parameter and by initial state") {
  using Jet = est::ParameterJet;
  const sms::Params<double> p;
  const int samples = 120;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(samples);
  const est::BenchRecord record{kStep, command(samples), zero, zero, zero, {}, {}};
  const est::BenchPlant plant({record}, {1e-4, 500.0, 500.0, 500.0}, sms::published_laws(), 1e-3);
  const est::Window window{0, 0, samples, 0, 3 * samples, {}};
  const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0};
  const std::pair<int, double> free[] = {
      {sms::index_of_mass_flow_gain, 1e-6},       {sms::index_of_moving_mass, 1e-6},
      {sms::index_of_piston_leakage, 1e-14},      {sms::index_of_sensor_gain_extension, 1e-7},
      {sms::index_of_clock_skew_extension, 1e-7}, {sms::index_of_compression_heat_ratio, 1e-7},
      {sms::index_of_friction_lag, 1e-7},         {sms::index_of_heat_share, 1e-6}};
  for (const auto& one : free) {
    CAPTURE(std::string(sms_param_describe(one.first)->name));
    sms::Params<Jet> seeded = sms::cast<Jet>(p);
    sms::param(seeded, one.first).v[0] = 1.0;
    Jet from[est::BenchPlant::kStart], exact[3 * samples];
    std::transform(std::begin(start), std::end(start), from, [](double value) { return Jet(value); });
    plant.simulate(seeded, window, from, exact);
    sms::Params<double> less = p, more = p;
    sms::param(less, one.first) -= sms_param_describe(one.first)->lower < sms::param(p, one.first) ? one.second : 0.0;
    sms::param(more, one.first) += one.second;
    Eigen::VectorXd low(3 * samples), high(3 * samples), slope(3 * samples);
    plant.simulate(less, window, start, low.data());
    plant.simulate(more, window, start, high.data());
    for (int i = 0; i < 3 * samples; ++i) {
      slope[i] = exact[i].v[0];
    }
    const double step = sms::param(more, one.first) - sms::param(less, one.first);
    CHECK(((high - low) / step - slope).norm() < 1e-3 * slope.norm());
  }
}

// The search must go on where a step gains next to nothing: these differences move chi-square by 1e-4 to 0.3, which is
// less than what ends a search otherwise.
TEST_CASE("the projected Jacobian is that of the residual at the refitted initial states, by differences") {
  const sms::Params<double> p;
  auto problem = problem_of(p, 620, 1e-9);
  problem.settle(p);
  const std::vector<int> free = {sms::index_of_mass_flow_gain,       sms::index_of_moving_mass,
                                 sms::index_of_piston_leakage,       sms::index_of_sensor_gain_extension,
                                 sms::index_of_clock_skew_extension, sms::index_of_compression_heat_ratio};
  const double steps[] = {1e-4, 1e-3, 1e-12, 1e-5, 1e-5, 1e-4};
  Eigen::VectorXd residual, there;
  est::RowMatrix jacobian;
  problem.evaluate(p, free, &residual, &jacobian);
  for (std::size_t k = 0; k < free.size(); ++k) {
    sms::Params<double> moved = p;
    sms::param(moved, free[k]) += steps[k];
    problem.evaluate(moved, {}, &there, nullptr);
    const Eigen::VectorXd slope = (there - residual) / steps[k];
    const Eigen::VectorXd exact = jacobian.col(static_cast<Eigen::Index>(k));
    CAPTURE(sms_param_describe(free[k])->name);
    CHECK(slope.dot(exact) / (slope.norm() * exact.norm()) > 0.994);
    CHECK(slope.norm() == doctest::Approx(exact.norm()).epsilon(0.01));
  }
}

TEST_CASE("after a Jacobian a search begins where the best initial states have moved to, to first order") {
  sms_test::Random random;
  const sms::Params<double> p;
  const std::vector<int> free = {sms::index_of_mass_flow_gain, sms::index_of_compression_heat_ratio,
                                 sms::index_of_valve_centre};
  sms::Params<double> moved = p;
  moved.mass_flow_gain *= 1.0 + random.uniform(-0.01, 0.01);
  moved.compression_heat_ratio += random.uniform(-0.01, 0.01);
  moved.valve_centre += random.uniform(-0.01, 0.01);
  auto stays = problem_of(p, 620, 1e12), follows = problem_of(p, 620, 1e12);  // no step is worth being made
  auto in_parts = problem_of(p, 620, 1e12);
  const auto searches = problem_of(p, 620, 1e-9);
  Eigen::VectorXd still, residual, best;
  est::RowMatrix jacobian;
  stays.settle(p);
  follows.settle(p);
  stays.evaluate(moved, {}, &still, nullptr);
  follows.evaluate(p, free, &residual, &jacobian);
  follows.evaluate(moved, {}, &residual, nullptr);
  searches.evaluate(moved, {}, &best, nullptr);
  CHECK(still.squaredNorm() > best.squaredNorm() + 1.0);
  CHECK(residual.squaredNorm() - best.squaredNorm() < 0.1 * (still.squaredNorm() - best.squaredNorm()));

  // One parameter after another: the others move the initial states as the last Jacobian had it that had them.
  in_parts.settle(p);
  Eigen::VectorXd of_parts;
  for (const int parameter : free) {
    in_parts.evaluate(p, {parameter}, &of_parts, &jacobian);
  }
  in_parts.evaluate(moved, {}, &of_parts, nullptr);
  CHECK((of_parts - residual).norm() <= 1e-9 * residual.norm());
}

TEST_CASE("a search that cannot beat what there is already ends at once") {
  // Straight: residual = start - (3, 4) and a last row of 2 that nothing changes, so that the least is 4.
  struct Straight : est::WindowSimulation {
    mutable int simulated = 0;
    void find_residual(const Eigen::VectorXd& start, Eigen::VectorXd* residual) const override {
      ++simulated;
      *residual = Eigen::Vector3d(start[0] - 3.0, start[1] - 4.0, 2.0);
    }
    void find_slopes(est::Shot* shot) const override {
      find_residual(shot->start, &shot->residual);
      shot->slopes = Eigen::MatrixXd::Identity(3, 2);
      shot->has_slopes = true;
    }
  };
  const Eigen::VectorXd from = Eigen::Vector2d(10.0, -10.0), scale = Eigen::Vector2d::Ones();
  const auto left = [&](double to_beat, int* simulated) {
    const Straight window;
    const est::Shot shot = est::shoot(window, from, scale, {}, 12, to_beat);
    *simulated = window.simulated;
    return shot.residual.squaredNorm();
  };
  int simulated = 0;
  CHECK(left(1.0, &simulated) > 200.0);
  CHECK(simulated == 1);
  CHECK(left(4.1, &simulated) < 4.1);
  CHECK(simulated > 1);
}

TEST_CASE("slopes of the last Jacobian lead to initial states as good as their own do") {
  sms_test::Random random;
  const sms::Params<double> p;
  auto near = problem_of(p, 620);
  near.settle(p);
  const double rows = near.rows();
  Eigen::VectorXd residual, best;
  for (int trial = 0; trial < 5; ++trial) {
    sms::Params<double> moved = p;
    moved.mass_flow_gain *= 1.0 + random.uniform(-3e-3, 3e-3);
    moved.moving_mass *= 1.0 + random.uniform(-3e-3, 3e-3);
    moved.valve_centre += random.uniform(-1e-3, 1e-3);
    near.evaluate(moved, {}, &residual, nullptr);
    problem_of(p, 620).evaluate(moved, {}, &best, nullptr);
    CAPTURE(moved.mass_flow_gain);
    CAPTURE(moved.valve_centre);
    CHECK(residual.squaredNorm() < 1.02 * best.squaredNorm() + 0.01 * rows);
  }
}

TEST_CASE("what a search has found once is found again after others") {
  sms_test::Random random;
  const sms::Params<double> truth;
  const auto problem = problem_of(truth, 620);
  const std::vector<int> free = {sms::index_of_mass_flow_gain, sms::index_of_valve_centre};
  Eigen::VectorXd first, residual;
  est::RowMatrix jacobian;
  problem.evaluate(truth, free, &first, &jacobian);
  for (int trial = 0; trial < 5; ++trial) {
    sms::Params<double> other = truth;
    other.coulomb_force *= random.uniform(0.3, 3.0);
    other.valve_centre += random.uniform(-0.3, 0.3);
    other.mass_flow_gain *= random.uniform(0.5, 2.0);
    problem.evaluate(other, free, &residual, &jacobian);
    problem.evaluate(truth, free, &residual, &jacobian);
    CAPTURE(other.coulomb_force);
    CAPTURE(other.valve_centre);
    CHECK(residual.squaredNorm() < first.squaredNorm() + 4.0 * problem.rows());
  }
}

TEST_CASE("the lubricant's film follows the motion before a window, to the speed of a swing that it has swung into") {
  using Jet = est::ParameterJet;
  sms_test::Random random;
  for (int trial = 0; trial < 20; ++trial) {
    sms::Params<double> p;
    // Eight lags of the record before the window count; half a sample away from one sample more, for the difference below.
    p.friction_lag = (std::floor(random.uniform(0.01, 0.2) * 8.0 / kStep) + 0.5) * kStep / 8.0;
    p.clock_skew_extension = random.uniform(0.0, 0.012);
    p.sensor_gain_extension = random.uniform(-0.05, 0.05);
    p.sensor_offset_extension = random.uniform(-1e-3, 1e-3);
    const double omega = random.uniform(2.0, 12.0), swing = 0.05, turn = omega * p.friction_lag;
    const int samples = 800, first = 600;
    const auto place = [&](double t) { return 0.2 + swing * std::sin(omega * t); };
    Eigen::VectorXd readings(samples);
    for (int k = 0; k < samples; ++k) {
      readings[k] = sms::extension_sensor(p).reading(place(kStep * k - p.clock_skew_extension));
    }
    readings[500] = std::nan("");
    const double t = kStep * first, phase = omega * t;
    const double film = swing * omega * (std::cos(phase) + turn * std::sin(phase)) / (1.0 + turn * turn);
    const auto found = [&](const sms::Params<double>& with) {
      return est::film_at_start(with, readings, kStep, first, place(t), swing * omega * std::cos(phase));
    };
    CAPTURE(p.friction_lag);
    CAPTURE(omega);
    CHECK(found(p) == doctest::Approx(film).epsilon(0.01).scale(swing * omega));

    sms::Params<Jet> seeded = sms::cast<Jet>(p);
    seeded.friction_lag.v[0] = 1.0;
    const Jet slope = est::film_at_start(seeded, readings, kStep, first, Jet(place(t)), Jet(0.0));
    sms::Params<double> less = p, more = p;
    less.friction_lag -= 1e-6;
    more.friction_lag += 1e-6;
    CHECK(slope.a == doctest::Approx(found(p)).epsilon(1e-9));
    CHECK(slope.v[0] == doctest::Approx((found(more) - found(less)) / 2e-6).epsilon(1e-4).scale(1e-2));
  }
}

TEST_CASE("neutral effects leave a simulation unchanged to the bit, and others do not") {
  const sms::Params<double> p;
  const Eigen::MatrixXd plain = simulated(p, 200, 1e-3);
  using Effect = std::pair<int, double>;
  for (const Effect& effect :
       {Effect{sms::index_of_presliding_share, 0.5}, Effect{sms::index_of_friction_lag, 0.01},
        Effect{sms::index_of_command_delay, 0.01}, Effect{sms::index_of_backlash, 1e-3},
        Effect{sms::index_of_frame_compliance, 1e-6}, Effect{sms::index_of_stiction_shape, 1.0},
        Effect{sms::index_of_sensor_lag_extension, 0.01}, Effect{sms::index_of_heat_share, 0.5}}) {
    CAPTURE(sms_param_describe(effect.first)->name);
    sms::Params<double> changed = p;
    sms::param(changed, effect.first) = 0.0;
    const Eigen::MatrixXd neutral = simulated(changed, 200, 1e-3);
    CHECK(std::equal(neutral.data(), neutral.data() + neutral.size(), plain.data(), same_bits));
    sms::param(changed, effect.first) = effect.second;
    CHECK((simulated(changed, 200, 1e-3) - plain).cwiseAbs().maxCoeff() > 1e-7);
  }
}

TEST_CASE("with all of the heat a simulation is that of the energy equation") {
  sms::Params<double> p;
  p.heat_share = 1.0;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(200);
  const est::BenchRecord record{kStep, command(200), zero, zero, zero, {}, {}};
  const est::Window window{0, 0, 200, 0, 600, {}};
  const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0, 5.0, -5.0};
  const auto with = [&](sms::ChamberLaw law) {
    sms::ActuatorLaws laws = sms::published_laws();
    laws.chamber = law;
    Eigen::VectorXd out(600);
    est::BenchPlant({record}, unit_noise, laws, 1e-3).simulate(p, window, start, out.data());
    return out;
  };
  const Eigen::VectorXd all = with(sms::ChamberLaw::polytropic), energy = with(sms::ChamberLaw::energy);
  CHECK((all - energy).norm() < 1e-9 * energy.norm());
}

TEST_CASE("which way a signal went last: by more than its noise, as far back as it takes") {
  Eigen::VectorXd signal(8);
  signal << 0.0, 1.0, 2.0, 1.9, 2.1, 2.0, 0.5, 0.6;
  CHECK(est::detail::moved_last(signal, 0, 0.5) == 0.0);
  CHECK(est::detail::moved_last(signal, 2, 0.5) == 1.0);
  CHECK(est::detail::moved_last(signal, 5, 0.5) == 1.0);
  CHECK(est::detail::moved_last(signal, 7, 0.5) == -1.0);
  CHECK(est::detail::moved_last(signal, 7, 5.0) == 0.0);
}

TEST_CASE("a command that is held: what arrives in a step is its mean, and a delay moves it smoothly") {
  Eigen::VectorXd volts(4);
  volts << 1.0, 2.0, 4.0, 3.0;
  const auto arriving = [&](double at, double late) {
    est::RecordedVoltage<double> command(volts, est::Hold::previous, late);
    command.begin_step(at, {10, 1});
    return command.at(at);
  };
  CHECK(arriving(1.0, 0.0) == doctest::Approx(2.0));
  CHECK(arriving(1.9, 0.0) == doctest::Approx(2.0));
  CHECK(arriving(2.0, 0.0) == doctest::Approx(4.0));
  CHECK(arriving(2.0, 0.025) == doctest::Approx(0.25 * 2.0 + 0.75 * 4.0));
  CHECK(arriving(2.0, 0.1) == doctest::Approx(2.0));
  CHECK(arriving(2.0, 1.0) == doctest::Approx(2.0));
  CHECK(arriving(9.0, 0.0) == doctest::Approx(3.0));
  CHECK(arriving(0.0, 2.0) == doctest::Approx(1.0));
}

TEST_CASE("a stepped command: straight, and held until the sample that shows a jump") {
  Eigen::VectorXd volts(7);
  volts << 1.0, 1.1, 1.2, 5.0, 5.1, 5.2, 5.3;
  CHECK(est::detail::jumps(volts, 2));
  for (const int sample : {-1, 0, 1, 3, 4, 5, 6, 7}) {
    CHECK_FALSE(est::detail::jumps(volts, sample));
  }
  const auto arriving = [&](double at, const est::Pace& pace, double late) {
    est::RecordedVoltage<double> command(volts, est::Hold::stepped, late);
    command.begin_step(at, pace);
    return command.at(at + double(pace.samples) / pace.parts);
  };
  CHECK(arriving(1.0, {10, 1}, 0.0) == doctest::Approx(1.11));
  CHECK(arriving(2.9, {10, 1}, 0.0) == doctest::Approx(1.2));
  CHECK(arriving(3.0, {10, 1}, 0.0) == doctest::Approx(5.005));
  CHECK(arriving(3.0, {10, 1}, 0.1) == doctest::Approx(1.2));
  CHECK(arriving(3.0, {10, 1}, 0.025) == doctest::Approx(0.25 * 1.2 + 0.75 * (5.0 + 0.1 * 0.0375)));
  CHECK(arriving(1.0, {1, 3}, 0.0) == doctest::Approx((1.15 + 1.2 + 5.05) / 3.0));
  CHECK(arriving(2.0, {1, 2}, 0.5) == doctest::Approx((0.5 * 1.175 + 1.2 + 0.5 * 5.025) / 2.0));
  est::RecordedVoltage<double> command(volts, est::Hold::stepped, 0.0);
  CHECK(command.begin_step(2.0, {1, 1}));
  CHECK(command.begin_step(3.0, {1, 1}));
  CHECK(command.begin_step(4.0, {1, 1}));  // a mean no more
  CHECK_FALSE(command.begin_step(5.0, {1, 1}));
}

TEST_CASE("a stepped command lags where it goes straight, and not beyond a jump") {
  Eigen::VectorXd volts(7);
  volts << 1.0, 1.1, 1.2, 5.0, 5.1, 5.2, 5.3;
  const auto arriving = [&](est::Hold hold, double at, const est::Pace& pace) {
    est::RecordedVoltage<double> command(volts, hold, 0.0, {}, 0.1);
    command.begin_step(at, pace);
    return command.at(at + double(pace.samples) / pace.parts);
  };
  CHECK(arriving(est::Hold::stepped, 1.0, {10, 1}) == doctest::Approx(1.1));
  CHECK(arriving(est::Hold::stepped, 2.4, {10, 1}) == doctest::Approx(1.2));  // until it jumps
  CHECK(arriving(est::Hold::stepped, 3.0, {20, 1}) == doctest::Approx(5.0));
  CHECK(arriving(est::Hold::stepped, 3.5, {10, 1}) == doctest::Approx(5.05));
  CHECK(arriving(est::Hold::stepped, 4.0, {1, 2}) == doctest::Approx((0.5 * 5.09 + 5.19 + 0.5 * 5.29) / 2.0));
  CHECK(arriving(est::Hold::linear, 1.0, {10, 1}) == doctest::Approx(1.11));
  sms::Params<double> p;
  p.control_period = 1e-3;
  CHECK(est::staircase_lag(p, 5e-3) == doctest::Approx(0.1));
  CHECK(est::staircase_lag(p, 0.5e-3) == doctest::Approx(0.5));
}

TEST_CASE("a jump further ahead of the sample that shows it adds its area to the step in which it comes") {
  Eigen::VectorXd volts(7), known = Eigen::VectorXd::Zero(7);
  volts << 1.0, 1.1, 1.2, 5.0, 5.1, 5.2, 5.3;
  constexpr double step = 5e-3, further[est::kJumps] = {1e-4};
  const Eigen::VectorXd none;
  const auto arriving = [&](est::Hold hold, double at, const est::Pace& pace, const Eigen::VectorXd& ahead,
                            const double* more) {
    est::RecordedVoltage<double> command(volts, hold, 0.0, {volts, ahead, 0, 7, step, more});
    command.begin_step(at, pace);
    return command.at(at);
  };
  const double area = 3.8 * further[0] / step;  // V, times samples
  for (const est::Hold hold : {est::Hold::stepped, est::Hold::previous}) {
    const double without = arriving(hold, 2.0, {1, 3}, none, nullptr);
    CHECK(arriving(hold, 2.9, {10, 1}, none, further) == doctest::Approx(1.2 + 10.0 * area));
    CHECK(arriving(hold, 2.0, {1, 3}, none, further) == doctest::Approx(without + area / 3.0));
    for (const double at : {2.8, 3.0}) {
      CHECK(same_bits(arriving(hold, at, {10, 1}, none, further), arriving(hold, at, {10, 1}, none, nullptr)));
    }
    // Known to come 0.42 samples ahead: in the step from 2.5.
    known[3] = 0.42 * step;
    CHECK(arriving(hold, 2.4, {10, 1}, known, nullptr) == doctest::Approx(1.2));
    CHECK(arriving(hold, 2.5, {10, 1}, known, nullptr) == doctest::Approx(0.8 * 1.2 + 0.2 * 5.0));
    CHECK(arriving(hold, 2.6, {10, 1}, known, nullptr) == doctest::Approx(5.0));
    CHECK(arriving(hold, 2.0, {1, 3}, known, nullptr) == doctest::Approx(without + 0.42 * 3.8 / 3.0));
    CHECK(arriving(hold, 2.5, {10, 1}, known, further) == doctest::Approx(0.8 * 1.2 + 0.2 * 5.0 + 10.0 * area));
    known[3] = 0.0;
    for (double at = 1.0; at < 5.0; at += 0.3) {
      CHECK(arriving(hold, at, {10, 1}, known, nullptr) == doctest::Approx(arriving(hold, at, {10, 1}, none, nullptr)));
    }
  }
  known[3] = 0.42 * step;
  CHECK(same_bits(arriving(est::Hold::linear, 2.0, {1, 3}, known, further),
                  arriving(est::Hold::linear, 2.0, {1, 3}, none, nullptr)));
}

TEST_CASE("of a window's jumps the largest are taken, in order of time") {
  constexpr int jumps = est::kJumps + 3, every = 4;
  Eigen::VectorXd volts(every * (jumps + 1));
  const auto size = [](int jump) { return 1.0 + (7 * jump) % jumps; };  // all different
  double level = 5.0;
  for (int k = 0; k < volts.size(); ++k) {
    level += k > 0 && k % every == 0 ? size(k / every - 1) : 0.0;
    volts[k] = level;
  }
  const Eigen::VectorXd none;
  double further[est::kJumps];
  std::fill(std::begin(further), std::end(further), 1.0);
  const est::CommandJumps<double> found(volts, none, 0, static_cast<int>(volts.size()), 1.0, further);
  for (int jump = 0; jump < jumps; ++jump) {
    const double added = found.mean(every * (jump + 1) - 1.0, 1.0);
    CHECK(added == doctest::Approx(size(jump) > 3.0 ? size(jump) : 0.0));
  }
  for (int i = 0; i < est::kJumps; ++i) {
    further[i] = i;
  }
  const est::CommandJumps<double> ordered(volts, none, 0, static_cast<int>(volts.size()), 1.0, further);
  double next = 0.0;
  for (int jump = 0; jump < jumps; ++jump) {
    if (size(jump) > 3.0) {
      CHECK(ordered.mean(every * (jump + 1) - 1.0, 1.0) == doctest::Approx(next * size(jump)));
      ++next;
    }
  }
  CHECK_FALSE(est::CommandJumps<double>(volts, none, 0, every, 1.0, further).further());  // none within
  CHECK_FALSE(est::CommandJumps<double>(volts, none, 0, 12, 1.0, nullptr).further());
}

TEST_CASE("the sensitivity to a jump's time is the change of a finer record whose command jumps earlier") {
  using Jet = est::ParameterJet;
  constexpr int samples = 80, finer = 25, jump_at = 15;
  const sms::Params<double> p;
  const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0};
  const auto plant_of = [&](int parts, int earlier, double ahead = 0.0) {
    Eigen::VectorXd volts(samples * parts);
    for (int k = 0; k < volts.size(); ++k) {
      volts[k] = k < jump_at * parts - earlier ? 5.4 : k < 40 * parts ? 6.3 : 4.6;
    }
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(volts.size());
    est::BenchRecord record{kStep / parts, volts, zero, zero, zero, {}, {}};
    record.hold = est::Hold::previous;
    est::BenchPlant plant({record}, unit_noise, sms::published_laws(), 1e-3);
    if (ahead > 0.0) {
      plant.ahead(0, 0) = Eigen::VectorXd::Zero(volts.size());
      plant.ahead(0, 0)[jump_at] = ahead;
    }
    return plant;
  };
  const auto fine = [&](int earlier) {
    constexpr int all = samples * finer;
    Eigen::VectorXd out(3 * all);
    plant_of(finer, earlier).simulate(p, est::Window{0, 0, all, 0, 3 * all, {}}, start, out.data());
    Eigen::MatrixXd kept(samples, 3);
    for (int k = 0; k < samples; ++k) {
      kept.row(k) = out.segment<3>(3 * k * finer).transpose();
    }
    return kept;
  };
  Jet ahead[est::kJumps], from[est::BenchPlant::kStart], readings[3 * samples];
  std::fill(std::begin(ahead), std::end(ahead), Jet(0.0));
  ahead[0].v[0] = 1.0;
  ahead[1].v[1] = 1.0;
  std::transform(std::begin(start), std::end(start), from, [](double value) { return Jet(value); });
  plant_of(1, 0).simulate(sms::cast<Jet>(p), est::Window{0, 0, samples, 0, 3 * samples, {}}, from, readings,
                          {nullptr, 0, ahead});
  const Eigen::MatrixXd change = (fine(1) - fine(0)) * (finer / kStep);
  for (int channel = 0; channel < 3; ++channel) {
    Eigen::VectorXd slope(samples);
    for (int k = 0; k < samples; ++k) {
      slope[k] = readings[3 * k + channel].v[0];
    }
    CAPTURE(channel);
    CHECK((change.col(channel) - slope).norm() < 0.1 * slope.norm());
  }
  // By three and a half milliseconds, known: as the finer record has it, far closer than the change itself.
  const int earlier = 17 * finer / 25 + 1;  // 3.6 ms
  Eigen::VectorXd coarse(3 * samples);
  plant_of(1, 0, earlier * kStep / finer)
      .simulate(p, est::Window{0, 0, samples, 0, 3 * samples, {}}, start, coarse.data());
  const Eigen::MatrixXd known = Eigen::Map<est::RowMatrix>(coarse.data(), samples, 3);
  plant_of(1, 0).simulate(p, est::Window{0, 0, samples, 0, 3 * samples, {}}, start, coarse.data());
  const Eigen::MatrixXd unknown = Eigen::Map<est::RowMatrix>(coarse.data(), samples, 3);
  const Eigen::MatrixXd true_one = fine(earlier), at_sample = fine(0);
  for (int channel = 0; channel < 3; ++channel) {
    CAPTURE(channel);
    const double change_of = (true_one - at_sample).col(channel).norm();
    CHECK(((known - unknown) - (true_one - at_sample)).col(channel).norm() < 0.05 * change_of);
  }
  for (int k = 0; k < samples; ++k) {
    CHECK((std::fabs(readings[3 * k + 1].v[0]) > 0.0) == (k >= jump_at));
    CHECK((std::fabs(readings[3 * k + 1].v[1]) > 0.0) == (k >= 40));
  }
}

TEST_CASE("a command that only jumps: stepped is held, whatever the delay and the steps") {
  Eigen::VectorXd jumping(80);
  for (int k = 0; k < jumping.size(); ++k) {
    jumping[k] = k < 15 ? 5.4 : k < 40 ? 6.3 : 4.6;
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(jumping.size());
  const est::Window window{0, 0, 80, 0, 240, {}};
  const double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0};
  const auto readings = [&](est::Hold hold, double late, double longest_step) {
    est::BenchRecord record{kStep, jumping, zero, zero, zero, {}, {}};
    record.hold = hold;
    const est::BenchPlant plant({record}, unit_noise, sms::published_laws(), longest_step);
    sms::Params<double> p;
    p.command_delay = late;
    Eigen::VectorXd out(240);
    plant.simulate(p, window, start, out.data());
    return Eigen::MatrixXd(Eigen::Map<est::RowMatrix>(out.data(), 80, 3));
  };
  for (const double late : {0.0, 0.3 * kStep, kStep, 2.7 * kStep}) {
    for (const double longest_step : {1e-3, kStep}) {
      CAPTURE(late);
      CAPTURE(longest_step);
      const Eigen::MatrixXd held = readings(est::Hold::previous, late, longest_step);
      const Eigen::MatrixXd stepped = readings(est::Hold::stepped, late, longest_step);
      CHECK((stepped - held).col(0).cwiseAbs().maxCoeff() < 1e-9);
      CHECK((stepped - held).rightCols(2).cwiseAbs().maxCoeff() < 1e-3);  // Pa
      const Eigen::MatrixXd straight = readings(est::Hold::linear, late, longest_step);
      CHECK((straight - held).rightCols(2).cwiseAbs().maxCoeff() > 1e3);
    }
  }
}

TEST_CASE("a clock that is late by whole samples is taken by the index") {
  const sms::Params<double> p;
  const int samples = 620, late = 4;
  const Eigen::MatrixXd y = simulated(p, samples, 1e-3);
  Eigen::VectorXd shifted = y.col(0);
  shifted.tail(samples - late) = y.col(0).head(samples - late);
  const est::BenchRecord record{kStep, command(samples), shifted, y.col(1), y.col(2), {}, {}};
  const est::ShootingProblem<est::BenchPlant> problem(
      est::BenchPlant({record}, {1e-4, 500.0, 500.0, 500.0}, sms::published_laws(), 1e-3), {});
  Eigen::VectorXd with, without;
  sms::Params<double> skewed = p;
  skewed.clock_skew_extension = late * kStep;
  problem.evaluate(p, {}, &without, nullptr);
  problem.evaluate(skewed, {}, &with, nullptr);
  CHECK(without.norm() > 50.0);
  CHECK(with.norm() < 5.0);
}

TEST_CASE("droop, deflection and heat are felt at the start by those machines only that are said to") {
  const sms::Params<double> p;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(40);
  const est::BenchPlant plant({{kStep, command(40), zero, zero, zero, {}, {}}}, unit_noise, sms::published_laws(),
                              1e-3);
  const est::Window window{0, 0, 40, 0, 120, {}};
  const auto moves = [&](const sms::Params<double>& with, int number) {
    double start[est::BenchPlant::kStart] = {0.2, 0.0, 2.6e5, 2.9e5, 4e5, 0.0, 0.0, 0.0};
    Eigen::VectorXd plain(120), moved(120);
    plant.simulate(with, window, start, plain.data());
    start[number] += est::BenchPlant::start_scale(number);
    plant.simulate(with, window, start, moved.data());
    return (moved - plain).cwiseAbs().maxCoeff() > 0.0;
  };
  CHECK_FALSE(plant.feels_all(p, window));
  for (int k = 0; k < est::BenchPlant::kStart; ++k) {
    CAPTURE(k);
    CHECK(moves(p, k) == (k < est::BenchPlant::kFelt));
  }
  for (const auto& one :
       {std::make_pair(sms::index_of_supply_line_resistance, 4), std::make_pair(sms::index_of_presliding_share, 5),
        std::make_pair(sms::index_of_heat_share, 6), std::make_pair(sms::index_of_heat_share, 7)}) {
    CAPTURE(one.second);
    sms::Params<double> more = p;
    sms::param(more, one.first) = one.first == sms::index_of_supply_line_resistance ? 1e6 : 0.5;
    CHECK(plant.feels_all(more, window));
    CHECK(moves(more, one.second));
  }
}

TEST_CASE("what cannot be a record is refused") {
  const Eigen::VectorXd good = Eigen::VectorXd::Constant(100, 5.0), bad = Eigen::VectorXd::Constant(99, 5.0);
  const auto make = [](const est::BenchRecord& record) {
    return est::BenchPlant({record}, unit_noise, sms::published_laws(), 1e-3);
  };
  CHECK_THROWS_AS(make({kStep, good, good, bad, good, {}, {}}), std::invalid_argument);
  CHECK_THROWS_AS(make({0.0, good, good, good, good, {}, {}}), std::invalid_argument);
  Eigen::VectorXd hole = good;
  hole[3] = std::nan("");
  CHECK_THROWS_AS(make({kStep, good, hole, good, good, {}, {}}), std::invalid_argument);
}
