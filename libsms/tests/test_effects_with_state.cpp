// Effects that add a state to bench and platform: seals that deform or whose film is late, air that is partly warm.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "random_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/integrate_stiff.hpp"
#include "sms/simulate.hpp"

namespace {

using Params = sms::Params<double>;
using Bench = sms::Bench<double>;
using BenchState = sms::BenchState<double>;

double wave(double t) { return 5.0 + 1.1 * std::sin(9.0 * t) + 0.4 * std::cos(31.0 * t); }

// A second of a bench, the command held a millisecond; `stiff` in steps of the same length, else adaptive.
BenchState run(const Params& p, sms::ChamberLaw chamber, double step, bool stiff, double tolerance = 1e-9) {
  sms::ActuatorLaws laws = sms::published_laws();
  laws.chamber = chamber;
  const Bench bench = sms::make_bench(p, laws);
  sms::Simulation<Bench> s(bench);
  REQUIRE(sms::begin_simulation(sms::bench_at_rest(bench, 0.2, 0.0, 333e3), {5.0, 0.0}, p,
                                sms::PositionControl::open_loop, false, false, tolerance, s) == SMS_OK);
  s.fixed_step = step;
  s.stiff = stiff;
  const double none = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double command = wave(1e-3 * k);
    REQUIRE(sms::take_sample(p, &command, &none, s) == SMS_OK);
    REQUIRE(sms::run_period(s) == SMS_OK);
  }
  return s.run.state;
}

double difference(const BenchState& a, const BenchState& b) {
  const BenchState scale = sms::state_scale(Bench{});
  return (sms::vector_of(a) - sms::vector_of(b)).cwiseQuotient(sms::vector_of(scale)).cwiseAbs().maxCoeff();
}

BenchState moving(sms_test::Random& random) {
  const Params p;
  BenchState state{random.uniform(0.05, 0.35), random.uniform(0.02, 0.5),
                   sms::actuator_at_rest<double>(p, random.uniform(1e5, 4.5e5), random.uniform(1e5, 4.5e5))};
  state.actuator.film = random.uniform(-0.5, 0.5);
  state.actuator.deflection = random.uniform(-3e-4, 3e-4);
  return state;
}

}  // namespace

TEST_CASE("a film that is late takes the speed of the piston as a lag of first order, and friction goes with it") {
  sms_test::Random random;
  for (int i = 0; i < 100; ++i) {
    const BenchState state = moving(random);
    Params p, late = p;
    late.friction_lag = random.uniform(1e-3, 0.2);
    sms::BenchTerms<double> t;
    BenchState plain, rate;
    REQUIRE(sms::derivative(sms::make_bench(p, sms::published_laws()), state, {5.0, 0.0}, t, plain) == SMS_OK);
    CHECK(plain.actuator.film == 0.0);
    const double by_law = t.balance.friction;
    REQUIRE(sms::derivative(sms::make_bench(late, sms::published_laws()), state, {5.0, 0.0}, t, rate) == SMS_OK);
    const double slip = state.actuator.film - state.velocity;
    CHECK(rate.actuator.film == doctest::Approx(-slip / late.friction_lag));
    CHECK(t.balance.friction == doctest::Approx(by_law + p.viscous_friction * slip));
    CHECK(rate.velocity == doctest::Approx(plain.velocity - p.viscous_friction * slip / p.moving_mass));
  }
}

TEST_CASE("a film that is hardly late is so to first order, and both descriptions meet") {
  Params short_of_it, beyond;
  short_of_it.friction_lag = 5e-4 * (1.0 - 1e-9);
  beyond.friction_lag = 5e-4;
  const auto end = [](const Params& p) { return run(p, sms::ChamberLaw::polytropic, 0.0, false, 1e-7); };
  const BenchState to_first_order = end(short_of_it), with = end(beyond), without = end(Params());
  CHECK(std::abs(to_first_order.extension - with.extension) < 0.1 * std::abs(with.extension - without.extension));
}

TEST_CASE("the stiff step takes every effect with a state where the adaptive one does") {
  using Effect = std::pair<int, double>;
  for (const Effect& effect :
       {Effect{sms::index_of_moving_mass, 4.0}, Effect{sms::index_of_presliding_share, 0.6},
        Effect{sms::index_of_friction_lag, 0.05}, Effect{sms::index_of_friction_lag, 6e-4},
        Effect{sms::index_of_heat_share, 0.7}, Effect{sms::index_of_supply_line_resistance, 1e6}}) {
    CAPTURE(sms_param_describe(effect.first)->name);
    Params p;
    sms::param(p, effect.first) = effect.second;
    const BenchState exact = run(p, sms::ChamberLaw::polytropic, 0.0, false);
    const double coarse = difference(run(p, sms::ChamberLaw::polytropic, 1e-3, true), exact);
    const double fine = difference(run(p, sms::ChamberLaw::polytropic, 2.5e-4, true), exact);
    CHECK(coarse < 1e-2);
    CHECK(fine < 0.5 * coarse + 1e-6);
  }
}

TEST_CASE("all of the heat is the energy equation, none of it the polytropic law to the bit") {
  Params p;
  p.heat_share = 1.0;
  const BenchState all = run(p, sms::ChamberLaw::polytropic, 0.0, false);
  CHECK(difference(all, run(p, sms::ChamberLaw::energy, 0.0, false)) < 1e-6);
  p.heat_share = 0.0;
  const BenchState none = run(p, sms::ChamberLaw::polytropic, 0.0, false);
  const BenchState plain = run(Params(), sms::ChamberLaw::polytropic, 0.0, false);
  CHECK(std::memcmp(&none, &plain, sizeof none) == 0);
}

TEST_CASE("a piston under the platform has the seals of one on the bench") {
  // Far-apart pistons of a platform whose mass is diagonal: the balance of three is three balances.
  sms_test::Random random;
  for (int i = 0; i < 100; ++i) {
    Params p[3];
    sms::Piston<double> piston[3];
    sms::SealState<double> seals[3];
    sms::Vec3<double> drive, by_law = sms::Vec3<double>::Zero();
    sms::ForceBalance<double> together[3];
    const double mass = random.uniform(3.0, 200.0);
    for (int k = 0; k < 3; ++k) {
      p[k].presliding_share = random.uniform(0.0, 1.0);
      p[k].friction_lag = k == 0 ? 1e-4 : random.uniform(1e-3, 0.1);
      piston[k] = {0.2, random.uniform(-0.5, 0.5), 0.0, 3e5, 3e5};
      seals[k] = {random.uniform(-3e-4, 3e-4), random.uniform(-0.5, 0.5)};
      drive(k) = random.uniform(-500.0, 500.0);
    }
    for (const auto law : {sms::FrictionLaw::acceleration_dependent, sms::FrictionLaw::stribeck}) {
      REQUIRE(sms::balance_pistons<double>(p, law, piston, seals, mass * sms::Mat3<double>::Identity(), drive, by_law,
                                           together) == SMS_OK);
      for (int k = 0; k < 3; ++k) {
        const auto alone = sms::seal_balance<double>(p[k], law, piston[k], seals[k], mass, drive(k));
        CHECK(together[k].acceleration == doctest::Approx(alone.acceleration).epsilon(1e-9));
        CHECK(together[k].friction == doctest::Approx(alone.friction).epsilon(1e-9));
        CHECK(together[k].deflection_rate == doctest::Approx(alone.deflection_rate));
        CHECK(together[k].film_rate == doctest::Approx(alone.film_rate));
      }
    }
  }
}

TEST_CASE("a dead time is that of each leg") {
  const Params p;
  auto platform = sms::make_platform(p, sms::published_laws(), sms::MassModel::corrected);
  platform.params[1].command_delay = 0.0034;
  platform.params[2].command_delay = 0.0102;
  sms::PlatformState<double> state;
  REQUIRE(sms::platform_at_rest<double>(platform, {0.0, 0.0, 0.5}, 333e3, state) == SMS_OK);
  sms::PlatformInput<double> input{sms::Vec3<double>::Constant(5.0),
                                   {sms::Vec3<double>::Zero(), sms::Vec3<double>::Zero()}};
  sms::Simulation<sms::Platform<double>> s(platform);
  REQUIRE(sms::begin_simulation(state, input, p, sms::PositionControl::open_loop, false, false, 1e-4, s) == SMS_OK);
  const double command[3] = {7.0, 7.0, 7.0}, none[3] = {0.0, 0.0, 0.0};
  double moved[3] = {-1.0, -1.0, -1.0};  // when the spool of each leg began to
  for (int k = 0; k < 15; ++k) {
    REQUIRE(sms::take_sample(p, command, none, s) == SMS_OK);
    REQUIRE(sms::run_period(s) == SMS_OK);
    for (int i = 0; i < 3; ++i) {
      if (moved[i] < 0.0 && s.run.state.actuator[i].spool.value > 5.0 + 1e-9) {
        moved[i] = s.run.time;
      }
    }
  }
  CHECK(moved[0] == doctest::Approx(0.001));
  CHECK(moved[1] == doctest::Approx(0.004));
  CHECK(moved[2] == doctest::Approx(0.011));
}
