// Dynamics: the identities that hold for any mechanism, checked on this one, and the facts known of it.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "mechanism_cases.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/end_stop.hpp"
#include "sms/linear_dynamics.hpp"
#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define SMS_TEST_JETS
#endif

using namespace sms_test;

namespace {

using Terms = sms::DynamicsTerms<double>;

const sms::Params<double> params;
const sms::Mechanism<double> mechanism = sms::make_mechanism(params, sms::MassModel::corrected);
constexpr sms::MassModel kModels[4] = {sms::MassModel::corrected, sms::MassModel::table, sms::MassModel::platform,
                                       sms::MassModel::lumped};

Terms terms_at(const sms::Mechanism<double>& m, const Vec& q, const Vec& rate) {
  Terms t;
  REQUIRE(sms::dynamics_at(m, q, rate, sms::rest_pose(m.geometry), t) == SMS_OK);
  return t;
}

// Rates up to what the machine does, a few times over.
Vec random_rate(Random& random) { return random_vector(random, -0.5, 0.5); }

}  // namespace

TEST_CASE("facts: masses, mass matrix and holding force level at 0.5 m") {
  const sms::Bodies<double>& b = mechanism.bodies;
  double moving = b.platform.mass, with_pistons = b.platform.mass;
  for (int i = 0; i < 6; ++i) moving += b.hung[i].mass;
  for (int i = 0; i < 3; ++i) {
    moving += b.sliding[i].mass;
    with_pistons += b.sliding[i].mass;
  }
  CHECK(moving == doctest::Approx(353.7).epsilon(1e-4));
  CHECK(with_pistons == doctest::Approx(318.6).epsilon(2e-4));

  const Terms t = terms_at(mechanism, Vec(0.0, 0.0, 0.5), Vec::Zero());
  CHECK(largest(t.mass_matrix.diagonal() - Vec(602.6, 623.6, 329.0)) < 0.05);
  CHECK(largest(sms::holding_force(t, Vec(Vec::Zero())) - Vec::Constant(1042.5)) < 1.0);
}

TEST_CASE("corrected and table: cylinder 2 differs by the 18 mm of its position sensor") {
  const sms::Mechanism<double> table = sms::make_mechanism(params, sms::MassModel::table);
  const Vec corrected_cog = mechanism.bodies.hung[1].cog, printed_cog = table.bodies.hung[1].cog;
  CHECK((corrected_cog - printed_cog).head<2>().norm() == doctest::Approx(0.018).epsilon(0.06));
  CHECK(largest(mechanism.bodies.hung[2].cog - table.bodies.hung[2].cog) < 2e-4);
  CHECK(largest(mechanism.bodies.hung[0].cog - table.bodies.hung[0].cog) < 1e-15);
}

TEST_CASE("M is symmetric and positive definite; forward and inverse dynamics are one another's inverse") {
  Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const sms::Mechanism<double> m = sms::make_mechanism(params, kModels[i % 4]);
    const Vec rate = random_rate(random);
    const Terms t = terms_at(m, coordinates_in_regime(i % 3, random, m.geometry), rate);
    CHECK(largest(t.mass_matrix - t.mass_matrix.transpose()) < 1e-12);
    CHECK(sms::symmetric_eigen<double, 3>(t.mass_matrix).values(0) > 200.0);

    const Vec force = random_vector(random, -500.0, 2500.0);
    const sms::Wrench<double> wrench = {random_vector(random, -200.0, 200.0), random_vector(random, -200.0, 200.0)};
    const Vec outside = sms::platform_load(t, wrench);
    const Vec acceleration = sms::acceleration(t, Vec(sms::actuator_load(t, force) + outside));
    CHECK(largest(sms::actuator_force(t, acceleration, outside) - force) < 2e-11);
  }
}

#ifdef SMS_TEST_JETS
TEST_CASE("bias from the Christoffel symbols of M, weight from the slope of U, power in balance; three regimes") {
  using Jet = ceres::Jet<double, 3>;
  Random random;
  for (const sms::MassModel model : kModels) {
    const sms::Mechanism<Jet> by_jets = sms::make_mechanism(sms::Params<Jet>(), model);
    const sms::Mechanism<double> m = sms::make_mechanism(params, model);
    for (int i = 0; i < sms_test::count / 40; ++i) {
      const Vec q = coordinates_in_regime(i % 3, random, m.geometry), rate = random_rate(random);
      const Terms t = terms_at(m, q, rate);
      sms::DynamicsTerms<Jet> jets;
      const sms::Vec3<Jet> seeded(Jet(q(0), 0), Jet(q(1), 1), Jet(q(2), 2));
      const sms::Vec3<Jet> still = sms::Vec3<Jet>::Zero();
      REQUIRE(sms::dynamics_at(by_jets, seeded, still, sms::rest_pose(m.geometry), jets) == SMS_OK);

      // h_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) q'_j q'_k
      Vec christoffel = Vec::Zero();
      Mat change = Mat::Zero();  // dM/dt
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          change(a, b) = jets.mass_matrix(a, b).v.dot(rate);
          for (int c = 0; c < 3; ++c) {
            christoffel(a) += (jets.mass_matrix(a, b).v(c) - 0.5 * jets.mass_matrix(b, c).v(a)) * rate(b) * rate(c);
          }
        }
      }
      CHECK(largest(christoffel - t.inertial) < 4e-11);
      CHECK(largest(jets.potential_energy.v - t.weight) < 1e-10);

      const Vec force = random_vector(random, 0.0, 2000.0);
      const Vec acceleration = sms::acceleration(t, sms::actuator_load(t, force));
      const double gained = rate.dot(t.mass_matrix * acceleration + 0.5 * change * rate + t.weight);
      CHECK(std::abs(gained - force.dot(t.motion.extension_rate)) < 1e-10);
    }
  }
}
#endif

TEST_CASE("a heavier payload weighs as the wrench of its weight") {
  Random random;
  sms::Params<double> heavier = params;
  heavier.payload_mass += 100.0;
  const sms::Mechanism<double> loaded = sms::make_mechanism(heavier, sms::MassModel::corrected);
  const Vec cog = Vec(params.payload_cog_x, params.payload_cog_y, params.payload_cog_z) - mechanism.geometry.reference;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, mechanism.geometry);
    const Terms a = terms_at(mechanism, q, Vec::Zero()), b = terms_at(loaded, q, Vec::Zero());
    const sms::Wrench<double> weight = sms::force_at(a, cog, Vec(0.0, 0.0, 100.0 * params.gravity));
    CHECK(largest(b.weight - a.weight + sms::platform_load(a, weight)) < 1e-10);
  }
}

TEST_CASE("a wrench on the platform does the work of its velocities") {
  Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec rate = random_rate(random);
    const Terms t = terms_at(mechanism, coordinates_in_regime(i % 3, random, mechanism.geometry), rate);
    const Vec point = random_vector(random, -1.0, 1.0), force = random_vector(random, -100.0, 100.0);
    constexpr double h = 1e-5;
    const auto position = [&](double time) {
      const sms::Pose<double> pose = pose_at(mechanism.geometry, Vec(coordinates(t.pose) + time * rate));
      return Vec(Vec(pose.x, pose.y, -pose.height) + sms::attitude(pose.roll, pose.pitch, pose.yaw).rotation * point);
    };
    const double work = force.dot(position(h) - position(-h)) / (2 * h);
    CHECK(std::abs(rate.dot(sms::platform_load(t, sms::force_at(t, point, force))) - work) < 1e-6);
  }
}

TEST_CASE("links without mass leave the platform alone") {
  sms::Params<double> light = params;
  light.cylinder_mass = light.piston_mass = light.panhard_mass = 0.0;
  light.panhard_inertia_transverse = light.panhard_inertia_axial = 0.0;
  light.cylinder_inertia_xx = light.cylinder_inertia_yy = light.cylinder_inertia_zz = 0.0;
  light.cylinder_inertia_xy = light.cylinder_inertia_xz = 0.0;
  light.piston_inertia_xx = light.piston_inertia_yy = light.piston_inertia_zz = 0.0;
  light.piston_inertia_xy = light.piston_inertia_xz = 0.0;
  const sms::Mechanism<double> a = sms::make_mechanism(light, sms::MassModel::corrected);
  const sms::Mechanism<double> b = sms::make_mechanism(params, sms::MassModel::platform);
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, a.geometry), rate = random_rate(random);
    const Terms s = terms_at(a, q, rate), t = terms_at(b, q, rate);
    CHECK(largest(s.mass_matrix - t.mass_matrix) < 1e-12);
    CHECK(largest(s.inertial + s.weight - t.inertial - t.weight) < 1e-11);
  }
}

TEST_CASE("the lumped model: error of the accelerations and of the holding force over the workspace") {
  const sms::Mechanism<double> lumped = sms::make_mechanism(params, sms::MassModel::lumped);
  Random random;
  Vec acceleration = Vec::Zero();
  double holding = 0.0;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec q = coordinates(random_pose(random, mechanism.geometry)), rate = random_vector(random, -0.15, 0.15);
    const Vec force = random_vector(random, 500.0, 1600.0);
    const Terms full = terms_at(mechanism, q, rate), cheap = terms_at(lumped, q, rate);
    const Vec error = sms::acceleration(cheap, sms::actuator_load(cheap, force)) -
                      sms::acceleration(full, sms::actuator_load(full, force));
    acceleration = acceleration.cwiseMax(error.cwiseAbs());
    const Terms full_still = terms_at(mechanism, q, Vec::Zero()), cheap_still = terms_at(lumped, q, Vec::Zero());
    holding = std::max(holding, largest(sms::holding_force(full_still, Vec(Vec::Zero())) -
                                        sms::holding_force(cheap_still, Vec(Vec::Zero()))));
  }
  MESSAGE("lumped: " << acceleration.transpose() << " rad/s^2, rad/s^2, m/s^2; holding force " << holding << " N");
  CHECK(acceleration(0) < 0.05);
  CHECK(acceleration(1) < 0.05);
  CHECK(acceleration(2) < 0.05);
  CHECK(holding < 10.0);
}

TEST_CASE("free swinging on springs for 60 s keeps its energy") {
  const Vec middle(0.0, 0.0, 0.5), stiffness = Vec::Constant(35e3);
  const Terms still = terms_at(mechanism, middle, Vec::Zero());
  const Vec holding = sms::holding_force(still, Vec(Vec::Zero())), rest = extension_at(mechanism.geometry, middle);
  sms::Pose<double> last = still.pose;
  Terms t;
  const auto evaluate = [&](const Vec& q, const Vec& rate, Vec& deflection) {
    REQUIRE(sms::dynamics_at(mechanism, q, rate, last, t) == SMS_OK);
    last = t.pose;
    for (int k = 0; k < 3; ++k) {
      deflection(k) = t.motion.length[k] - mechanism.geometry.actuator_length(k) - rest(k);
    }
  };
  const auto energy = [&](const Vec& q, const Vec& rate) {
    Vec deflection;
    evaluate(q, rate, deflection);
    return sms::kinetic_energy(t, rate) + t.potential_energy +
           deflection.dot(0.5 * stiffness.cwiseProduct(deflection) - holding);
  };
  const auto acceleration = [&](const Vec& q, const Vec& rate) {
    Vec deflection;
    evaluate(q, rate, deflection);
    return sms::acceleration(t, sms::actuator_load(t, Vec(holding - stiffness.cwiseProduct(deflection))));
  };

  Vec q(0.06, -0.04, 0.53), rate(0.1, -0.1, 0.1);
  const double start = energy(q, rate), swing = start - energy(middle, Vec::Zero());
  REQUIRE(swing > 50.0);
  double drift = 0.0;
  constexpr double h = 3e-4;
  const int steps = static_cast<int>(60.0 / h);
  for (int i = 0; i < steps; ++i) {  // the classical Runge-Kutta method; its own loss is 8e-11 here
    const Vec k1 = acceleration(q, rate);
    const Vec r2 = rate + 0.5 * h * k1, k2 = acceleration(q + 0.5 * h * rate, r2);
    const Vec r3 = rate + 0.5 * h * k2, k3 = acceleration(q + 0.5 * h * r2, r3);
    const Vec r4 = rate + h * k3, k4 = acceleration(q + h * r3, r4);
    q += h / 6.0 * (rate + 2.0 * r2 + 2.0 * r3 + r4);
    rate += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    if (i % 100 == 99) drift = std::max(drift, std::abs(energy(q, rate) - start));
  }
  MESSAGE("energy drift " << drift / swing << " of the swing's " << swing << " J");
  CHECK(drift < 1e-9 * swing);
}

TEST_CASE("linear model: stiffness against differences of the forces, and the modes of the loaded machine") {
  Random random;
  for (int i = 0; i < sms_test::count / 100; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, mechanism.geometry);
    const sms::ActuatorLaw<double> law = {random_vector(random, 500.0, 1500.0), random_vector(random, 1e4, 4e4),
                                          random_vector(random, 100.0, 600.0)};
    const sms::Pose<double> pose = pose_at(mechanism.geometry, q);
    const sms::LinearModel<double> model = sms::linearise(mechanism, pose, law);
    const Vec here = extension_at(mechanism.geometry, q);
    const auto unbalanced = [&](const Vec& at) {
      const Terms t = terms_at(mechanism, at, Vec::Zero());
      const Vec force = law.force - law.stiffness.cwiseProduct(extension_at(mechanism.geometry, at) - here);
      return Vec(t.weight - sms::actuator_load(t, force));
    };
    for (int k = 0; k < 3; ++k) {
      const Vec step = 1e-5 * Vec::Unit(k);
      const Vec slope = (unbalanced(q + step) - unbalanced(q - step)) / 2e-5;
      CHECK(largest(slope - model.stiffness.col(k)) < 1e-3);  // of 1e5
    }
    const sms::StateSpace<double> s = sms::state_space(model);
    const Vec push = random_vector(random, -1.0, 1.0);
    const Terms t = terms_at(mechanism, q, Vec::Zero());
    const Vec kick = sms::acceleration(t, Vec(sms::actuator_load(t, push) + t.weight));
    CHECK(largest(s.b.bottomRows<3>() * push - kick) < 1e-14);
    CHECK(largest(s.a.topRightCorner<3, 3>() - Mat::Identity()) < 1e-300);
  }

  const Vec middle(0.0, 0.0, 0.5);
  const Terms t = terms_at(mechanism, middle, Vec::Zero());
  sms::ActuatorLaw<double> law = {sms::holding_force(t, Vec(Vec::Zero())), Vec::Zero(), Vec::Zero()};
  const sms::Modes<double> falling = sms::modes(sms::linearise(mechanism, t.pose, law));
  CHECK(sms::growth_rate(falling.lambda(0)) == doctest::Approx(2.4).epsilon(0.03));
  CHECK(sms::growth_rate(falling.lambda(1)) == doctest::Approx(2.3).epsilon(0.03));
  CHECK(sms::growth_rate(falling.lambda(2)) == doctest::Approx(1.4).epsilon(0.05));

  // Air springs at 333 kPa mean pressure, adiabatic: k = 1.4 p (A_a^2 / V_a + A_b^2 / V_b).
  const double lower = 7.854e-3, upper = 7.363e-3;
  law.stiffness.setConstant(1.4 * 333e3 * (lower / 0.2 + upper / 0.2));
  const sms::Modes<double> swinging = sms::modes(sms::linearise(mechanism, t.pose, law));
  CHECK(sms::natural_frequency(swinging.lambda(0)) == doctest::Approx(1.97).epsilon(0.02));
  CHECK(sms::natural_frequency(swinging.lambda(1)) == doctest::Approx(2.01).epsilon(0.02));
  CHECK(sms::natural_frequency(swinging.lambda(2)) == doctest::Approx(2.92).epsilon(0.02));
  CHECK(largest(swinging.shape.transpose() * t.mass_matrix * swinging.shape - Mat::Identity()) < 1e-12);
}

TEST_CASE("float agrees with double") {
  const sms::Mechanism<float> single = sms::make_mechanism(sms::Params<float>(), sms::MassModel::corrected);
  Random random;
  double worst = 0.0;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Vec q = coordinates_in_regime(i % 3, random, mechanism.geometry), rate = random_rate(random);
    const Vec force = random_vector(random, 500.0, 1600.0);
    const Terms t = terms_at(mechanism, q, rate);
    sms::DynamicsTerms<float> f;
    REQUIRE(sms::dynamics_at(single, sms::Vec3<float>(q.cast<float>()), sms::Vec3<float>(rate.cast<float>()),
                             sms::rest_pose(single.geometry), f) == SMS_OK);
    const Vec error =
        sms::acceleration(f, sms::actuator_load(f, sms::Vec3<float>(force.cast<float>()))).cast<double>() -
        sms::acceleration(t, sms::actuator_load(t, force));
    worst = std::max(worst, largest(error));
  }
  MESSAGE("float against double: " << worst << " rad/s^2 or m/s^2");
  CHECK(worst < 1e-4);
}

TEST_CASE("what cannot be is refused, and leaves the terms as they were") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Terms t;
  t.potential_energy = 7.0;
  const sms::Pose<double> start = sms::rest_pose(mechanism.geometry);
  CHECK(sms::dynamics_at(mechanism, Vec(0.0, 0.0, 0.5), Vec(0.0, nan, 0.0), start, t) == SMS_NOT_A_NUMBER);
  CHECK(sms::dynamics_at(mechanism, Vec(nan, 0.0, 0.5), Vec(0.0, 0.0, 0.0), start, t) == SMS_NOT_A_NUMBER);
  CHECK(sms::dynamics_at(mechanism, Vec(0.0, 0.0, 2.5), Vec(0.0, 0.0, 0.0), start, t) == SMS_OUT_OF_WORKSPACE);
  CHECK(t.potential_energy == doctest::Approx(7.0).epsilon(1e-300));
}

TEST_CASE("end stops push only, touch without a jump, and take energy") {
  CHECK(std::abs(sms::end_stop_force(params, 0.2, 1.0)) < 1e-300);
  CHECK(std::abs(sms::end_stop_force(params, 0.0, -1.0)) < 1e-300);
  CHECK(sms::end_stop_force(params, -1e-3, 0.0) == doctest::Approx(5000.0));
  CHECK(sms::end_stop_force(params, 0.401, 0.0) == doctest::Approx(-5000.0));
  CHECK(std::abs(sms::end_stop_force(params, -1e-3, 10.0)) < 1e-300);  // leaving faster than the contact follows

  Random random;
  for (int i = 0; i < 100; ++i) {  // a mass thrown against the stop comes back slower
    const double mass = random.uniform(50.0, 400.0), speed = random.uniform(0.01, 1.0);
    double x = 0.0, v = -speed, h = 1e-6, stored = 0.0;
    do {
      v += h * sms::end_stop_force(params, x, v) / mass;
      x += h * v;
      stored = std::max(stored, sms::end_stop_energy(params, x));
    } while (x < 0.0);
    CHECK(v > 0.0);
    CHECK(v < speed * (1.0 + 1e-4));
    CHECK(stored <= 0.5 * mass * speed * speed * (1.0 + 1e-3));
    if (speed > 0.1) CHECK(v < speed * (1.0 - 0.4 * params.end_stop_damping * speed + speed * speed));
  }
}

TEST_CASE("cushioning brakes the approach to an end only, and is absent by default") {
  CHECK(std::abs(sms::end_stop_force(params, 0.01, -0.3)) < 1e-300);
  sms::Params<double> p;
  p.cushion_damping = 1000.0;
  CHECK(sms::end_stop_force(p, 0.016, -0.2) == doctest::Approx(100.0));
  CHECK(sms::end_stop_force(p, 0.4 - 0.016, 0.2) == doctest::Approx(-100.0));
  CHECK(std::abs(sms::end_stop_force(p, 0.016, 0.2)) < 1e-300);
  CHECK(std::abs(sms::end_stop_force(p, 0.033, -0.2)) < 1e-300);
}
