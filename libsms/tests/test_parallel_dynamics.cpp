// Dynamics of a platform on massless legs, given by data: power, energy, and the built-in platform's own equations.
#include <doctest/doctest.h>

#include <cmath>

#include "parallel_cases.hpp"
#include "sms/compiled_mechanism.hpp"

using namespace sms_test;

namespace {

const sms::PlatformBody<double> body = {40.0, Vec(0.02, -0.03, 0.1), sms::symmetric(3.0, 2.5, 4.0, 0.1, -0.2, 0.15),
                                        Vec(0.0, 0.0, -9.81)};
const V6 level = 1.0 * V6::Unit(2);

// A twist that keeps rods and planes: J twist = (rates of the actuated legs, 0).
V6 possible_twist(const sms::Mat6<double>& jacobian, int freedoms, Random& random) {
  V6 rates = V6::Zero();
  for (int k = 0; k < freedoms; ++k) rates(k) = random.uniform(-0.3, 0.3);
  sms::Factors<double> factors;
  sms::factorize(jacobian, factors);
  return sms::solution(factors, rates);
}

struct Case {
  Parallel mechanism;
  sms::LegEquation equation[6];
  int freedoms;
  V6 coordinates;
  explicit Case(const Parallel& m) : mechanism(m), freedoms(sms::actuated_count(m)), coordinates(level) {
    REQUIRE(sms::equations_of(m, equation) == 6);
  }
  void draw(Random& random, double size) {
    coordinates = level;
    for (int k = 0; k < 6; ++k) coordinates(k) += size * random.uniform(-1.0, 1.0) * (k < 3 ? 0.1 : 0.2);
    sms::Search<double> search;
    REQUIRE(sms::complete_coordinates(mechanism, coordinates, search) == SMS_OK);
  }
  sms::ParallelTerms<double> terms(const V6& twist, const V6& wrench = V6::Zero()) const {
    sms::ParallelTerms<double> t;
    sms::evaluate_parallel(mechanism, equation, body, sms::pose_of(coordinates), twist, wrench, t);
    return t;
  }
};

double kinetic_energy(const sms::ParallelTerms<double>& t, const V6& twist) {
  return 0.5 * twist.dot(t.mass_matrix * twist);
}

}  // namespace

TEST_CASE("parallel dynamics: forces of a motion give that motion back, in three regimes") {
  Random random;
  for (const Parallel& m : {hexapod(), three_rps()}) {
    Case c(m);
    for (int i = 0; i < sms_test::count / 10; ++i) {
      c.draw(random, i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-8 : 1.0);
      const V6 twist = possible_twist(c.terms(V6::Zero()).jacobian, c.freedoms, random);
      V6 wrench;
      for (int k = 0; k < 6; ++k) wrench(k) = random.uniform(-50.0, 50.0);
      const sms::ParallelTerms<double> t = c.terms(twist, wrench);
      V6 s = V6::Zero(), acceleration, force, again;
      for (int k = 0; k < c.freedoms; ++k) s(k) = random.uniform(-2.0, 2.0);
      sms::Factors<double> factors;
      sms::factorize(t.jacobian, factors);
      acceleration = sms::solution(factors, V6(s - t.bias));
      REQUIRE(sms::leg_forces(t, acceleration, force) == SMS_OK);
      REQUIRE(sms::platform_acceleration(t, c.freedoms, force.data(), again) == SMS_OK);
      CHECK(largest(again - acceleration) < 1e-10);
    }
  }
}

TEST_CASE("parallel dynamics: the legs' power is the change of energy") {
  Random random;
  for (const Parallel& m : {hexapod(), three_rps()}) {
    Case c(m);
    for (int i = 0; i < sms_test::count / 10; ++i) {
      c.draw(random, 1.0);
      const V6 twist = possible_twist(c.terms(V6::Zero()).jacobian, c.freedoms, random);
      const sms::ParallelTerms<double> t = c.terms(twist);
      V6 force = V6::Zero(), acceleration;
      for (int k = 0; k < c.freedoms; ++k) force(k) = random.uniform(0.0, 200.0);
      REQUIRE(sms::platform_acceleration(t, c.freedoms, force.data(), acceleration) == SMS_OK);
      // d/dt of 0.5 m |v_c|^2 + 0.5 w.I w + weight, by the cog's own velocity and acceleration: not by M and h.
      const Mat r = sms::pose_of(c.coordinates).rotation;
      const Vec w = twist.tail<3>(), alpha = acceleration.tail<3>(), arm = r * body.cog;
      const Vec v = Vec(twist.head<3>()) + sms::cross(w, arm);
      const Vec a = Vec(acceleration.head<3>()) + sms::cross(alpha, arm) + sms::cross(w, sms::cross(w, arm));
      const Mat inertia = r * body.inertia * r.transpose();
      const double change = body.mass * v.dot(a) + w.dot(inertia * alpha) - body.mass * body.gravity.dot(v);
      const double power = (t.jacobian * twist).dot(force);
      CHECK(std::abs(power - change) < 1e-9 * (1.0 + std::abs(power)));
    }
  }
}

TEST_CASE("parallel dynamics: energy stays in free fall of the platform under constant leg forces' potential") {
  // A constant force on a leg has the potential -f l: kinetic energy + weight - sum f l is constant.
  for (const Parallel& m : {hexapod(), three_rps()}) {
    Case c(m);
    const double share = 40.0 * 9.81 / c.freedoms;
    const double force[6] = {1.1 * share, share, 0.95 * share, share, 1.05 * share, share};
    using State = Eigen::Matrix<double, 12, 1>;
    const auto energy = [&](const State& state) {
      c.coordinates = state.head<6>();
      double length[6], sum = 0.0;
      const sms::PlatformPose<double> pose = sms::pose_of(c.coordinates);
      sms::leg_lengths(c.mechanism, pose, length);
      for (int k = 0; k < c.freedoms; ++k) sum -= force[k] * length[k];
      return kinetic_energy(c.terms(state.tail<6>()), state.tail<6>()) + sum -
             body.mass * body.gravity.dot(pose.position + pose.rotation * body.cog);
    };
    const auto derivative = [&](const State& state) {
      c.coordinates = state.head<6>();
      V6 acceleration;
      REQUIRE(sms::platform_acceleration(c.terms(state.tail<6>()), c.freedoms, force, acceleration) == SMS_OK);
      State rate;
      const Mat e = sms::angle_rates_to_angular_velocity(state(4), state(5));
      rate << state.segment<3>(6), sms::inverse(e) * Vec(state.tail<3>()), acceleration;
      return rate;
    };
    State state = State::Zero();
    state.head<6>() = level;
    const double before = energy(state);
    double most_kinetic = 0.0;
    constexpr double h = 1e-3;
    for (int i = 0; i < 250; ++i) {
      const State k1 = derivative(state), k2 = derivative(state + 0.5 * h * k1), k3 = derivative(state + 0.5 * h * k2),
                  k4 = derivative(state + h * k3);
      state += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
      c.coordinates = state.head<6>();
      most_kinetic = std::max(most_kinetic, kinetic_energy(c.terms(state.tail<6>()), state.tail<6>()));
    }
    CHECK(most_kinetic > 0.1);
    CHECK(std::abs(energy(state) - before) < 1e-9 * (1.0 + std::abs(before)));
  }
}

TEST_CASE("parallel dynamics: the built-in platform without its links, by its own equations") {
  const sms::Params<double> p;
  const sms::Mechanism<double> machine = sms::make_mechanism(p, sms::MassModel::platform);
  const Parallel m = built_in(machine.geometry);
  const sms::Body<double>& platform = machine.bodies.platform;
  const sms::PlatformBody<double> same = {platform.mass, platform.cog, platform.inertia, Vec(0.0, 0.0, p.gravity)};
  sms::LegEquation equation[6];
  REQUIRE(sms::equations_of(m, equation) == 6);
  Random random;
  double worst = 0.0;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, machine.geometry);
    const Vec rate = random_vector(random, -0.3, 0.3), force = random_vector(random, 900.0, 1100.0);
    const sms::Pose<double> pose = pose_at(machine.geometry, q);
    sms::DynamicsTerms<double> terms;
    sms::evaluate_dynamics(machine, pose, rate, terms);
    const Vec expected = sms::acceleration(terms, sms::actuator_load(terms, force));
    V6 twist;
    twist << terms.motion.parasitic_rate(1), terms.motion.parasitic_rate(2), -rate(2), terms.motion.angular_velocity;
    sms::ParallelTerms<double> t;
    sms::evaluate_parallel(m, equation, same, sms::pose_of(coordinates_in_parallel(pose)), twist, V6(V6::Zero()), t);
    V6 acceleration;
    REQUIRE(sms::platform_acceleration(t, 3, force.data(), acceleration) == SMS_OK);
    // Height by its sign; the angular acceleration through the machine's own map.
    worst = std::max(worst, std::abs(-acceleration(2) - expected(2)));
    worst = std::max(
        worst, largest(Vec(acceleration.tail<3>()) - (terms.motion.angular * expected + terms.motion.angular_bias)));
  }
  MESSAGE("worst difference of accelerations " << worst << " rad/s^2 or m/s^2");
  CHECK(worst < 1e-11);
}

TEST_CASE("parallel dynamics: no forces are enough at a singular pose") {
  Case c(hexapod());
  c.coordinates(5) = 0.5 * 3.14159265358979323846;
  V6 force = V6::Constant(7.0);
  const sms_status status = sms::leg_forces(c.terms(V6::Zero()), V6(V6::Zero()), force);
  CHECK((status == SMS_NOT_CONVERGED || largest(force) > 1e9));
}
