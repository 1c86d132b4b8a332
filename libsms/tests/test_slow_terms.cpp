// Slow terms: the polynomial that carries them through a step, and the platform with its mechanism evaluated once a step.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "random_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/simulate.hpp"

namespace {

using Params = sms::Params<double>;
using Platform = sms::Platform<double>;
using State = sms::PlatformState<double>;
using Input = sms::PlatformInput<double>;
using Vec3 = sms::Vec3<double>;

struct Number {
  using Scalar = double;
  double value;
};

// The same platform, its mechanism evaluated in every stage.
struct EveryStage {
  using Slow = sms::NoSlowTerms;
  static constexpr int switch_count = sms::PlantSystem<Platform>::switch_count;
  sms::PlantSystem<Platform> system;
  sms_status operator()(const State& state, Slow&, State& rate) { return system(state, rate); }
  void switches(const State& state, double (&value)[switch_count]) const { system.switches(state, value); }
};

const Input& start_input() {
  static const Input input = {Vec3::Constant(5.0), {Vec3::Zero(), Vec3::Zero()}};
  return input;
}

// Where the platform is after `periods` of 1 ms, commands that never rest, and a load that jumps half-way.
template <typename System>
State path(const Platform& platform, System& f, Input& input, double tolerance, int periods) {
  State start;
  REQUIRE(sms::platform_at_rest<double>(platform, Vec3(0.02, -0.01, 0.5), 333e3, start) == SMS_OK);
  sms::Run<State, typename System::Slow> run;
  REQUIRE(sms::begin_run(f, 0.0, start, run) == SMS_OK);
  const auto control = sms::step_control(sms::state_scale(platform), tolerance);
  for (int k = 0; k < periods; ++k) {
    for (int i = 0; i < 3; ++i) {
      input.command(i) = 5.0 + 1.2 * std::sin(0.009 * k + i);
    }
    if (k == periods / 2) {
      input.wrench.force = Vec3(30.0, 0.0, 80.0);
      REQUIRE(sms::renew_rate(f, run) == SMS_OK);
    }
    sms::renew_command(platform, run.state, input, run.rate);
    while (run.time < 1e-3 * (k + 1)) {
      REQUIRE(sms::adaptive_step(f, control, 1e-3 * (k + 1), run) == SMS_OK);
    }
  }
  return run.state;
}

double difference(const Platform& platform, const State& a, const State& b) {
  const State scale = sms::state_scale(platform);
  return (sms::vector_of(a) - sms::vector_of(b)).cwiseQuotient(sms::vector_of(scale)).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a cubic is met exactly, whatever the steps; not far beyond its places") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double a = random.uniform(-1.0, 1.0), b = random.uniform(-1.0, 1.0), c = random.uniform(-1.0, 1.0);
    const auto cubic = [&](double t) { return 1.0 + t * (a + t * (b + t * c)); };
    sms::SlowPath<Number> path;
    path.count = 0;
    double t = 0.0;
    for (int k = 0; k < 6; ++k) {
      CHECK(sms::reaches(path, t) == (k >= 4));
      sms::add_place(path, Number{cubic(t)}, t);
      t += random.uniform(0.1, 1.0);
    }
    Number there;
    sms::slow_at(path, t, there);
    CHECK(there.value == doctest::Approx(cubic(t)).epsilon(1e-9));
    CHECK(!sms::reaches(path, t + 40.0));
  }
}

TEST_CASE("the platform goes where it goes with its mechanism evaluated in every stage") {
  for (const auto law : {sms::FrictionLaw::acceleration_dependent, sms::FrictionLaw::lugre}) {
    sms::ActuatorLaws laws = sms::published_laws();
    laws.friction = law;
    const Platform platform = sms::make_platform(Params(), laws, sms::MassModel::corrected);
    sms::PlantSystem<Platform> once = {platform, start_input(), {}};
    sms::prepare(platform, once.terms);
    EveryStage every = {{platform, start_input(), {}}};
    sms::prepare(platform, every.system.terms);
    const State a = path(platform, once, once.input, 1e-4, 400);
    const State b = path(platform, every, every.system.input, 1e-4, 400);
    MESSAGE("apart by ", difference(platform, a, b), " of the ranges");
    CHECK(difference(platform, a, b) < 1e-7);
    CHECK(difference(platform, a, b) > 0.0);
  }
}
