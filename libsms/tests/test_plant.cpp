// Bench, platform and tank as plants, and the integrators that take them through time.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "random_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/plant.hpp"
#include "sms/simulate.hpp"

namespace {

using Params = sms::Params<double>;
using Bench = sms::Bench<double>;
using BenchState = sms::BenchState<double>;
using Platform = sms::Platform<double>;
using PlatformState = sms::PlatformState<double>;
using Vec3 = sms::Vec3<double>;
using sms::ActuatorLaws;

template <typename State>
bool same_bits(const State& a, const State& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

ActuatorLaws laws(sms::ChamberLaw chamber, sms::FrictionLaw friction = sms::FrictionLaw::acceleration_dependent) {
  ActuatorLaws l = sms::published_laws();
  l.chamber = chamber;
  l.friction = friction;
  return l;
}

// The bench under a valve command that never rests.
double wave(double t) { return 5.0 + 1.1 * std::sin(9.0 * t) + 0.4 * std::cos(31.0 * t); }

int milliseconds(double seconds) { return static_cast<int>(std::lround(1e3 * seconds)); }

// `seconds` of a bench with a held command every millisecond.
template <typename Step>
BenchState run_bench(const Bench& bench, double seconds, const Step& step) {
  BenchState state = sms::bench_at_rest(bench, 0.2, 0.0, 333e3);
  for (int k = 0; k < milliseconds(seconds); ++k) {
    REQUIRE(step(sms::BenchInput<double>{wave(1e-3 * k), 0.0}, state) == SMS_OK);
  }
  return state;
}

BenchState run_fixed(const Bench& bench, double seconds, int steps_per_period) {
  sms::BenchTerms<double> terms;
  return run_bench(bench, seconds, [&](const sms::BenchInput<double>& input, BenchState& state) {
    sms_status status = SMS_OK;
    for (int i = 0; i < steps_per_period && status == SMS_OK; ++i) {
      const auto f = [&](double, const BenchState& x, BenchState& rate) {
        return sms::derivative(bench, x, input, terms, rate);
      };
      status = sms::runge_kutta_step(f, 0.0, 1e-3 / steps_per_period, state);
    }
    return status;
  });
}

std::unique_ptr<sms::Simulation<Bench>> simulation(const Bench& bench, sms::PositionControl control, bool electronics,
                                                   double tolerance) {
  std::unique_ptr<sms::Simulation<Bench>> s(new sms::Simulation<Bench>(bench));
  REQUIRE(sms::begin_simulation(sms::bench_at_rest(bench, 0.2, 0.0, 333e3), sms::BenchInput<double>{5.0, 0.0},
                                bench.params, control, true, electronics, tolerance, *s) == SMS_OK);
  return s;
}

BenchState run_adaptive(const Bench& bench, double seconds, double tolerance) {
  const auto s = simulation(bench, sms::PositionControl::open_loop, false, tolerance);
  const double noise = 0.0;
  for (int k = 0; k < milliseconds(seconds); ++k) {
    const double command = wave(1e-3 * k);
    REQUIRE(sms::take_sample(bench.params, &command, &noise, *s) == SMS_OK);
    REQUIRE(sms::run_period(*s) == SMS_OK);
  }
  return s->run.state;
}

double difference(const Bench& bench, const BenchState& a, const BenchState& b) {
  const BenchState scale = sms::state_scale(bench);
  return (sms::vector_of(a) - sms::vector_of(b)).cwiseQuotient(sms::vector_of(scale)).cwiseAbs().maxCoeff();
}

PlatformState some_state(const Platform& platform, sms_test::Random& random) {
  PlatformState state;
  REQUIRE(sms::platform_at_rest<double>(
              platform, Vec3(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(0.46, 0.54)),
              random.uniform(2.5e5, 4e5), state) == SMS_OK);
  for (int i = 0; i < 3; ++i) {
    state.rate(i) = random.uniform(-0.1, 0.1);
    state.actuator[i].lower.pressure *= random.uniform(0.8, 1.2);
    state.actuator[i].upper.pressure *= random.uniform(0.8, 1.2);
    state.actuator[i].spool.value = random.uniform(0.0, 10.0);
    state.actuator[i].deflection = random.uniform(-3e-4, 3e-4);
  }
  return state;
}

sms::PlatformInput<double> some_input(sms_test::Random& random) {
  return {Vec3(random.uniform(0.0, 10.0), random.uniform(0.0, 10.0), random.uniform(0.0, 10.0)),
          {Vec3(random.uniform(-100.0, 100.0), 0.0, random.uniform(-100.0, 100.0)),
           Vec3(random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), 0.0)}};
}

}  // namespace

TEST_CASE("at rest nothing moves: bench and platform, closed valves") {
  const Params p;
  const Bench bench = sms::make_bench(p, sms::published_laws());
  const BenchState state = sms::bench_at_rest(bench, 0.15, 300.0, 320e3);
  CHECK(state.actuator.lower.pressure + state.actuator.upper.pressure == doctest::Approx(640e3));
  sms::BenchTerms<double> terms;
  BenchState rate;
  REQUIRE(sms::derivative(bench, state, {5.0, 300.0}, terms, rate) == SMS_OK);
  CHECK(std::abs(rate.velocity) < 1e-11);
  CHECK(rate.actuator.lower.pressure == doctest::Approx(0.0));
  CHECK(rate.actuator.upper.pressure == doctest::Approx(0.0));

  const Platform platform = sms::make_platform(p, sms::published_laws(), sms::MassModel::corrected);
  PlatformState at;
  REQUIRE(sms::platform_at_rest<double>(platform, Vec3(0.03, -0.02, 0.49), 333e3, at) == SMS_OK);
  sms::PlatformTerms<double> t;
  sms::prepare(platform, t);
  PlatformState moving;
  const sms::PlatformInput<double> input = {Vec3(5.0, 5.0, 5.0), {Vec3::Zero(), Vec3::Zero()}};
  REQUIRE(sms::derivative(platform, at, input, t, moving) == SMS_OK);
  CHECK(sms::vector_of(moving).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("the platform's balance: M q'' + h + g = J^T (F - F_f) + Q under every law") {
  sms_test::Random random;
  Params p;
  p.panhard_friction = 12.0;
  for (int i = 0; i < sms_test::count / 10 + 5; ++i) {
    const auto law = static_cast<sms::FrictionLaw>(i % 5);
    const Platform platform = sms::make_platform(p, laws(sms::ChamberLaw::polytropic, law), sms::MassModel::corrected);
    const PlatformState state = some_state(platform, random);
    const sms::PlatformInput<double> input = some_input(random);
    sms::PlatformTerms<double> t;
    sms::prepare(platform, t);
    PlatformState rate;
    REQUIRE(sms::derivative(platform, state, input, t, rate) == SMS_OK);
    Vec3 force;
    for (int k = 0; k < 3; ++k) {
      force(k) = t.actuator[k].force - t.friction(k);
    }
    const Vec3 left = t.dynamics.mass_matrix * rate.rate + t.dynamics.inertial + t.dynamics.weight;
    const Vec3 right = sms::actuator_load(t.dynamics, force) + sms::platform_load(t.dynamics, input.wrench) +
                       sms::panhard_load(p, t.dynamics.motion);
    CHECK((left - right).norm() < 1e-9 * (left.norm() + 1e3));
    // and each piston's friction is the law's, at the acceleration that came out
    const Vec3 along = sms::extension_acceleration(t.dynamics.motion, rate.rate);
    for (int k = 0; k < 3 && law == sms::FrictionLaw::acceleration_dependent; ++k) {
      sms::Piston<double> piston = t.actuator[k].piston;
      piston.acceleration = along(k);
      if (std::abs(along(k)) > 1e-9) {
        CHECK(t.friction(k) == doctest::Approx(sms::friction(p, piston)).epsilon(1e-7));
      }
    }
  }
}

TEST_CASE("a Panhard rod's friction takes exactly c |omega|^2 a rod") {
  sms_test::Random random;
  Params p;
  p.panhard_friction = 7.0;
  const Platform platform = sms::make_platform(p, sms::published_laws(), sms::MassModel::corrected);
  const PlatformState state = some_state(platform, random);
  sms::DynamicsTerms<double> t;
  REQUIRE(sms::dynamics_at(platform.mechanism, state.q, state.rate, sms::rest_pose(platform.mechanism.geometry), t) ==
          SMS_OK);
  double power = 0.0;
  for (int i = 3; i < 6; ++i) {
    const Vec3 turning = sms::cross(t.motion.direction[i], t.motion.joint_velocity[i]) * t.motion.reciprocal_length[i];
    power += 7.0 * turning.squaredNorm();
  }
  CHECK(-sms::panhard_load(p, t.motion).dot(state.rate) == doctest::Approx(power));
}

TEST_CASE("order of the fixed step: halved, the error falls by 2^4") {
  // Friction without kinks and a spool that stays on one side of the dead zone, so that order is a matter of the method.
  Params p;
  p.coulomb_force = p.stiction_force = 0.0;
  const Bench bench = sms::make_bench(p, laws(sms::ChamberLaw::polytropic, sms::FrictionLaw::stribeck));
  const auto run = [&](int steps) {
    sms::BenchTerms<double> terms;
    BenchState state = sms::bench_at_rest(bench, 0.1, 0.0, 333e3);
    state.actuator.spool.value = 6.0;
    const auto f = [&](double t, const BenchState& x, BenchState& rate) {
      return sms::derivative(bench, x, {6.0 + 0.1 * std::sin(20.0 * t), 0.0}, terms, rate);
    };
    for (int i = 0; i < steps; ++i) {
      REQUIRE(sms::runge_kutta_step(f, 0.2 * i / steps, 0.2 / steps, state) == SMS_OK);
    }
    return state;
  };
  const BenchState exact = run(6400);
  const double coarse = difference(bench, run(200), exact), fine = difference(bench, run(400), exact);
  MESSAGE("error with 1 ms ", coarse, ", with 0.5 ms ", fine, ", order ", std::log2(coarse / fine));
  CHECK(std::log2(coarse / fine) > 3.7);
  CHECK(std::log2(coarse / fine) < 4.6);
}

TEST_CASE("adaptive and fixed steps reach the same state; a tighter tolerance comes nearer") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  const BenchState reference = run_adaptive(bench, 2.0, 1e-12);
  const double loose = difference(bench, run_adaptive(bench, 2.0, 1e-5), reference);
  const double usual = difference(bench, run_adaptive(bench, 2.0, 1e-7), reference);
  const double fixed = difference(bench, run_fixed(bench, 2.0, 20), reference);
  MESSAGE("off the reference: tolerance 1e-5 ", loose, ", 1e-7 ", usual, "; 50 us fixed ", fixed);
  CHECK(loose < 1e-4);
  CHECK(usual < 1e-6);
  CHECK(usual < loose);
  CHECK(fixed < 1e-5);
}

TEST_CASE("same input, same bits") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  CHECK(same_bits(run_adaptive(bench, 0.5, 1e-7), run_adaptive(bench, 0.5, 1e-7)));
}

TEST_CASE("within a step the polynomial meets both ends, and the integrator between") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  sms::PlantSystem<Bench> system{bench, {5.9, 0.0}, {}};
  sms::Run<BenchState> run;
  REQUIRE(sms::begin_run(system, 0.0, sms::bench_at_rest(bench, 0.2, 0.0, 333e3), run) == SMS_OK);
  const auto control = sms::step_control(sms::state_scale(bench), 1e-8);
  while (run.time < 0.05) {
    REQUIRE(sms::adaptive_step(system, control, 0.05, run) == SMS_OK);
  }
  const sms::Run<BenchState> before = run;
  REQUIRE(sms::adaptive_step(system, control, 0.1, run) == SMS_OK);
  CHECK(difference(bench, sms::state_at(run, run.began), before.state) < 1e-13);
  CHECK(difference(bench, sms::state_at(run, run.time), run.state) < 1e-13);
  const double middle = 0.5 * (run.began + run.time);
  sms::Run<BenchState> half = before;
  sms::PlantSystem<Bench> again{bench, {5.9, 0.0}, {}};
  BenchState rate;
  REQUIRE(again(half.state, rate) == SMS_OK);
  while (half.time < middle) {
    REQUIRE(sms::adaptive_step(again, control, middle, half) == SMS_OK);
  }
  CHECK(difference(bench, sms::state_at(run, middle), half.state) < 1e-6);
}

TEST_CASE("what flows is kept: air and energy of both chambers over a run of the bench") {
  // With the energy equation: d(m)/dt = in - out and d(U)/dt = enthalpy in - enthalpy out - work + heat, integrated along.
  Params p;
  p.piston_leakage = 2e-9;
  p.valve_leakage = 1e-10;
  const Bench bench = sms::make_bench(p, laws(sms::ChamberLaw::energy));
  struct Booked {
    using Scalar = double;
    BenchState bench;
    double mass;
    double energy;
  };
  sms::BenchTerms<double> t;
  Booked now = {sms::bench_at_rest(bench, 0.2, 0.0, 333e3), 0.0, 0.0};
  const auto stored = [&](const BenchState& s) {
    const auto lower = sms::lower_space(p, s.extension, s.velocity),
               upper = sms::upper_space(p, s.extension, s.velocity);
    return std::array<double, 2>{
        {sms::air_mass(p, s.actuator.lower, lower.volume) + sms::air_mass(p, s.actuator.upper, upper.volume),
         sms::internal_energy(p, s.actuator.lower, lower.volume) +
             sms::internal_energy(p, s.actuator.upper, upper.volume)}};
  };
  const auto begin = stored(now.bench);
  const double cp = p.heat_capacity_ratio * p.gas_constant / (p.heat_capacity_ratio - 1.0);
  for (int k = 0; k < 2000; ++k) {
    const auto f = [&](double, const Booked& x, Booked& rate) {
      const sms_status status = sms::derivative(bench, x.bench, {wave(1e-3 * k), 0.0}, t, rate.bench);
      const auto& a = t.actuator;
      rate.mass = a.flow.lower.in - a.flow.lower.out + a.flow.upper.in - a.flow.upper.out;
      rate.energy = cp * (a.flow.lower.in_heat + a.flow.upper.in_heat - a.flow.lower.out * a.ports.lower.temperature -
                          a.flow.upper.out * a.ports.upper.temperature) -
                    a.ports.lower.pressure * a.lower.rate - a.ports.upper.pressure * a.upper.rate +
                    sms::wall_heat(p, a.ports.lower, a.lower) + sms::wall_heat(p, a.ports.upper, a.upper);
      return status;
    };
    for (int i = 0; i < 10; ++i) {
      REQUIRE(sms::runge_kutta_step(f, 0.0, 1e-4, now) == SMS_OK);
    }
  }
  const auto end = stored(now.bench);
  MESSAGE("of ", end[0], " kg missing ", end[0] - begin[0] - now.mass, " kg; of ", end[1], " J missing ",
          end[1] - begin[1] - now.energy, " J");
  CHECK(std::abs(end[0] - begin[0] - now.mass) < 1e-7 * end[0]);
  CHECK(std::abs(end[1] - begin[1] - now.energy) < 1e-6 * end[1]);
}

TEST_CASE("closed valves and no leak: the mass of air stays, to rounding of the step") {
  const Bench bench = sms::make_bench(Params(), laws(sms::ChamberLaw::energy));
  BenchState state = sms::bench_at_rest(bench, 0.2, 0.0, 333e3);
  state.velocity = 0.4;  // it swings on its air springs
  sms::PlantSystem<Bench> system{bench, {5.0, 0.0}, {}};
  sms::Run<BenchState> run;
  REQUIRE(sms::begin_run(system, 0.0, state, run) == SMS_OK);
  const auto mass = [&](const BenchState& s) {
    return sms::air_mass(bench.params, s.actuator.lower,
                         sms::lower_space(bench.params, s.extension, s.velocity).volume);
  };
  const double before = mass(run.state);
  const auto control = sms::step_control(sms::state_scale(bench), 1e-12);
  while (run.time < 1.0) {
    REQUIRE(sms::adaptive_step(system, control, 1.0, run) == SMS_OK);
  }
  CHECK(std::abs(mass(run.state) / before - 1.0) < 1e-11);
}

TEST_CASE("neutral effects leave a trajectory unchanged to the bit") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  const BenchState plain = run_adaptive(bench, 0.3, 1e-7);
  // Far from neutral each of them does something, so that this test can fail.
  for (int index = 0; index < sms::param_count; ++index) {
    const sms_param_info* info = sms_param_describe(index);
    if (std::string(info->source) != "neutral" || sms::is_absent(info->upper)) {
      continue;
    }
    Bench other = bench;
    sms::param(other.params, index) = info->value;
    CHECK(same_bits(run_adaptive(other, 0.3, 1e-7), plain));
  }
  int acting = 0;
  for (double Params::*effect :
       {static_cast<double Params::*>(&Params::valve_leakage), static_cast<double Params::*>(&Params::piston_leakage),
        static_cast<double Params::*>(&Params::chamber_leakage_lower)}) {
    Bench other = bench;
    other.params.*effect = 1e-9;
    acting += same_bits(run_adaptive(other, 0.3, 1e-7), plain) ? 0 : 1;
  }
  CHECK(acting == 3);
}

TEST_CASE("never a pressure below zero, whatever the command does") {
  sms_test::Random random;
  const int runs = std::max(2, sms_test::count / 500);
  for (int i = 0; i < runs; ++i) {
    Params p;
    p.dead_volume_lower = p.dead_volume_upper = random.uniform(2e-5, 2e-4);
    p.supply_pressure = random.uniform(1e5, 1.1e6);
    p.mass_flow_gain = random.uniform(0.5, 3.0);
    p.moving_mass = random.uniform(0.5, 50.0);
    const Bench bench = sms::make_bench(p, laws(i % 2 == 0 ? sms::ChamberLaw::polytropic : sms::ChamberLaw::energy));
    const auto s = simulation(bench, sms::PositionControl::open_loop, i % 3 == 0, 1e-5);
    const double noise = 0.0;
    double command = 5.0;
    double lowest = 1e9;
    for (int k = 0; k < 400; ++k) {
      command = random.uniform(0.0, 1.0) < 0.05 ? random.uniform(0.0, 10.0) : command;
      s->system.input.load_force =
          random.uniform(0.0, 1.0) < 0.01 ? random.uniform(-3e3, 3e3) : s->system.input.load_force;
      REQUIRE(sms::take_sample(bench.params, &command, &noise, *s) == SMS_OK);
      REQUIRE(sms::run_period(*s) == SMS_OK);
      lowest = std::min({lowest, s->run.state.actuator.lower.pressure, s->run.state.actuator.upper.pressure});
    }
    CHECK(lowest > 0.0);
  }
}

TEST_CASE("a piston that leaves a chamber no room stops the run, and the status says so") {
  Params p;
  p.dead_volume_lower = p.dead_volume_upper = 1e-6;  // 0.13 mm of stroke; the end gives way by 0.6 mm
  const Bench bench = sms::make_bench(p, sms::published_laws());
  for (const double command : {2.5, 7.5}) {
    const auto s = simulation(bench, sms::PositionControl::open_loop, false, 1e-6);
    const double noise = 0.0;
    sms_status status = SMS_OK;
    for (int k = 0; k < 600 && status == SMS_OK; ++k) {
      REQUIRE(sms::take_sample(p, &command, &noise, *s) == SMS_OK);
      status = sms::run_period(*s);
    }
    CHECK(status == SMS_OUT_OF_RANGE);
    CHECK(s->run.state.actuator.lower.pressure > 0.0);
    CHECK(s->run.state.actuator.upper.pressure > 0.0);
  }
}

TEST_CASE("a step that ends with a period, however short, does not hold back the next") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  const auto s = simulation(bench, sms::PositionControl::pid, false, 1e-4);
  const int periods = 1000;
  for (int k = 0; k < periods; ++k) {
    const double setpoint = 0.2 + 0.05 * std::sin(2e-3 * k), noise = 0.0;
    REQUIRE(sms::take_sample(bench.params, &setpoint, &noise, *s) == SMS_OK);
    REQUIRE(sms::run_period(*s) == SMS_OK);
  }
  MESSAGE(s->run.steps, " steps in ", periods, " periods");
  CHECK(s->run.steps < 1.05 * periods);
}

TEST_CASE("a fixed load on a closed loop: the controller holds its setpoint") {
  Params p;
  p.proportional_gain = 20.0;
  p.integral_gain = 20.0;
  const Bench bench = sms::make_bench(p, sms::published_laws());
  for (const bool electronics : {false, true}) {
    const auto s = simulation(bench, sms::PositionControl::pid, electronics, 1e-6);
    s->system.input.load_force = 200.0;
    const double setpoint = 0.25, noise = 0.0;
    for (int k = 0; k < 8000; ++k) {
      REQUIRE(sms::take_sample(p, &setpoint, &noise, *s) == SMS_OK);
      REQUIRE(sms::run_period(*s) == SMS_OK);
    }
    CHECK(s->run.state.extension == doctest::Approx(0.25).epsilon(0.02));
  }
}

TEST_CASE("a dead time of any length delays the run by just that") {
  Params p;
  const auto path = [&](double delay, int first) {
    Params late = p;
    late.command_delay = delay;
    const Bench bench = sms::make_bench(late, sms::published_laws());
    const auto s = simulation(bench, sms::PositionControl::open_loop, false, 1e-9);
    const double noise = 0.0;
    for (int k = 0; k < 300; ++k) {
      const double command = k < first ? 5.0 : 6.5;
      REQUIRE(sms::take_sample(late, &command, &noise, *s) == SMS_OK);
      REQUIRE(sms::run_period(*s) == SMS_OK);
    }
    return s->run.state.extension;
  };
  CHECK(path(0.005, 10) == doctest::Approx(path(0.0, 15)).epsilon(1e-9));
  const double half = path(0.0055, 10);
  CHECK(half < path(0.005, 10));
  CHECK(half > path(0.006, 10));
}

TEST_CASE("bad input ends a run where it is, and says so") {
  const Bench bench = sms::make_bench(Params(), sms::published_laws());
  const auto s = simulation(bench, sms::PositionControl::open_loop, false, 1e-7);
  const double bad = std::nan(""), good = 5.0, noise = 0.0;
  const BenchState before = s->run.state;
  CHECK(sms::take_sample(bench.params, &bad, &noise, *s) == SMS_NOT_A_NUMBER);
  CHECK(sms::take_sample(bench.params, &good, &bad, *s) == SMS_NOT_A_NUMBER);
  CHECK(same_bits(before, s->run.state));
  s->control.smallest = 1.0;  // no step can be that large
  s->control.tolerance = 1e-30;
  const double open = 9.0;
  REQUIRE(sms::take_sample(bench.params, &open, &noise, *s) == SMS_OK);
  CHECK(sms::run_period(*s) == SMS_NOT_CONVERGED);
  CHECK(s->run.time == doctest::Approx(0.0));

  PlatformState state;
  const Platform platform = sms::make_platform(Params(), sms::published_laws(), sms::MassModel::corrected);
  CHECK(sms::platform_at_rest<double>(platform, Vec3(0.9, 0.0, 0.5), 333e3, state) != SMS_OK);
}

TEST_CASE("the tank: charged it ends at the supply, vented at ambient, and closed it keeps its pressure") {
  const Params p;
  const sms::Tank<double> tank = {p, sms::published_laws()};
  sms::TankTerms<double> t;
  const auto after = [&](double from, double command) {
    sms::TankState<double> state = sms::tank_at_rest(p, from);
    const auto f = [&](double, const sms::TankState<double>& x, sms::TankState<double>& rate) {
      return sms::derivative(tank, x, {command}, t, rate);
    };
    for (int i = 0; i < 20000; ++i) {
      REQUIRE(sms::runge_kutta_step(f, 0.0, 1e-3, state) == SMS_OK);
    }
    return state.gas.pressure;
  };
  CHECK(after(86e3, 8.0) == doctest::Approx(p.supply_pressure).epsilon(1e-6));
  CHECK(after(486e3, 2.0) == doctest::Approx(p.ambient_pressure).epsilon(1e-6));
  CHECK(after(300e3, 5.0) == doctest::Approx(300e3));
}
