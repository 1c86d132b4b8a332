// Friction with a memory, and the force balance that has to be solved for the acceleration.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "random_cases.hpp"
#include "sms/coupled_balance.hpp"

namespace {

using Params = sms::Params<double>;
using Piston = sms::Piston<double>;
using sms::FrictionLaw;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Piston at(double velocity, double acceleration = 0.0) { return {0.2, velocity, acceleration, 386e3, 281e3}; }

// One explicit step of a piston on its bristles.
struct Sliding {
  double position, velocity, deflection;
};

void step(const Params& p, Sliding& s, double drive, double dt) {
  const sms::ForceBalance<double> b =
      sms::force_balance(p, FrictionLaw::lugre, at(s.velocity), s.deflection, p.moving_mass, drive);
  s.velocity += dt * b.acceleration;
  s.deflection += dt * b.deflection_rate;
  s.position += dt * s.velocity;
}

double drift(const Params& p) {  // of a piston that sticks under a load that trembles below break-away
  Sliding s = {0.0, 0.0, 0.0};
  const double dt = 2e-5;
  double settled = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const double time = i * dt;
    step(p, s, std::min(1.0, time) * 25.0 + 12.0 * std::sin(20.0 * 3.14159265358979 * time), dt);
    if (i == 100000) settled = s.position;
  }
  return s.position - settled;
}

}  // namespace

TEST_CASE("eq. 6.2: eq. 6.1 while speeding up, a straight line while slowing down") {
  Params p;
  p.coulomb_force_deceleration_change = -6.0;
  p.viscous_friction_deceleration_change = 40.0;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double v = random.uniform(0.005, 0.5), a = random.uniform(1e-6, 5.0);
    CHECK(sms::friction_two_branch(p, at(v, a)) == doctest::Approx(sms::friction_stribeck(p, v)).epsilon(1e-14));
    CHECK(sms::friction_two_branch(p, at(v, -a)) == doctest::Approx(32.0 + 570.0 * v).epsilon(1e-14));
    CHECK(sms::friction_two_branch(p, at(-v, -a)) == doctest::Approx(-sms::friction_two_branch(p, at(v, a))));
  }
}

TEST_CASE("steady sliding on bristles is the static law") {
  const Params p;
  for (const double v : {1e-9, 1e-4, 0.003, 0.05, 0.2, 1.0}) {
    for (const double direction : {1.0, -1.0}) {
      const double z = direction * sms::stribeck_force(p, v) / p.bristle_stiffness;
      const sms::BristleFriction<double> lugre = sms::lugre_friction(p, at(direction * v), z);
      CHECK(lugre.deflection_rate == doctest::Approx(0.0).scale(v));
      CHECK(lugre.force == doctest::Approx(sms::friction_stribeck(p, direction * v)).epsilon(1e-12));
      const sms::BristleFriction<double> dahl =
          sms::dahl_friction(p, at(direction * v), direction * p.coulomb_force / p.bristle_stiffness);
      CHECK(dahl.deflection_rate == doctest::Approx(0.0).scale(v));
      CHECK(dahl.force == doctest::Approx(direction * 38.0));
    }
  }
}

TEST_CASE("pulled at constant speed the bristles reach the static law, from any deflection") {
  const Params p;
  for (const double start : {-7e-4, 0.0, 7e-4}) {
    double z = start;
    for (int i = 0; i < 200000; ++i) z += 1e-6 * sms::lugre_friction(p, at(0.05), z).deflection_rate;
    CHECK(sms::lugre_friction(p, at(0.05), z).force == doctest::Approx(sms::friction_stribeck(p, 0.05)).epsilon(1e-6));
  }
}

TEST_CASE("at rest the bristles hold any load up to the static force, and give way beyond") {
  const Params p;
  for (const double load : {10.0, 60.0, 76.0, 78.5}) {
    Sliding s = {0.0, 0.0, 0.0};
    for (int i = 0; i < 200000; ++i) step(p, s, std::min(1.0, i * 1e-5) * load, 2e-5);
    if (load < p.stiction_force) {
      CHECK(s.position == doctest::Approx(load / p.bristle_stiffness).epsilon(0.01));
      CHECK(std::abs(s.velocity) < 1e-4);  // near the limit it settles ever slower
    } else {
      CHECK(s.position > 0.01);
    }
  }
}

TEST_CASE("a trembling load does not make an elasto-plastic piston creep; plain LuGre creeps") {
  Params p;
  CHECK(std::abs(drift(p)) < 1e-6);
  p.breakaway_ratio = 0.0;
  CHECK(std::abs(drift(p)) > 1e-5);
}

TEST_CASE("bristles are passive: they give back no more than they stored") {
  const Params p;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double v = random.uniform(-0.5, 0.5) * std::pow(10.0, random.uniform(-6.0, 0.0));
    const double z = random.uniform(-1.0, 1.0) * p.stiction_force / p.bristle_stiffness;
    const sms::BristleFriction<double> lugre = sms::lugre_friction(p, at(v), z);
    CHECK(lugre.force * v - p.bristle_stiffness * z * lugre.deflection_rate >= -1e-12);
    const double zd = random.uniform(-1.0, 1.0) * p.coulomb_force / p.bristle_stiffness;
    const sms::BristleFriction<double> dahl = sms::dahl_friction(p, at(v), zd);
    CHECK(dahl.force * v - p.bristle_stiffness * zd * dahl.deflection_rate >= -1e-12);
  }
}

TEST_CASE("the blend runs from elastic to sliding without a step") {
  const Params p;
  const double largest = 5e-4;
  CHECK(same_bits(sms::sliding_part(p, 0.1, 0.69 * largest, largest), 0.0));
  CHECK(same_bits(sms::sliding_part(p, 0.1, 1.01 * largest, largest), 1.0));
  CHECK(same_bits(sms::sliding_part(p, -0.1, 0.9 * largest, largest), 0.0));
  CHECK(sms::sliding_part(p, 0.1, (0.7 + 1e-9) * largest, largest) == doctest::Approx(0.0));
  CHECK(sms::sliding_part(p, 0.1, 0.85 * largest, largest) == doctest::Approx(0.5));
  CHECK(sms::sliding_part(p, 0.1, (1 - 1e-9) * largest, largest) == doctest::Approx(1.0));
}

TEST_CASE("effects on the seals reach the bristles, and are absent to the bit when neutral") {
  Params p;
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double v = random.uniform(-0.3, 0.3), dry = sms::stribeck_force(p, v);
    CHECK(same_bits(sms::bristle_strength(p, at(v), dry), dry));
  }
  p.direction_friction = 5.0;
  p.pressure_friction = 1e-5;
  CHECK(sms::bristle_strength(p, at(0.1), 40.0) == doctest::Approx(40.0 + 5.0 + 4.95));
  CHECK(sms::bristle_strength(p, at(-0.1), 40.0) == doctest::Approx(40.0 - 5.0 + 4.95));
  p.direction_friction = -500.0;
  CHECK(sms::bristle_strength(p, at(0.1), 40.0) > 0.0);
}

TEST_CASE("the acceleration that is found fulfils Newton's law with its own friction") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    Params p;
    const int regime = i % 3;
    if (regime == 1) p.coulomb_force_deceleration_change = -1e-8;
    if (regime == 2) {
      p.coulomb_force_deceleration_change = random.uniform(-20.0, 0.0);
      p.viscous_friction_deceleration_change = random.uniform(-100.0, 0.0);
      p.pressure_friction = random.uniform(0.0, 1e-5);
      p.direction_friction = random.uniform(-5.0, 5.0);
      p.position_friction = random.uniform(-1.0, 1.0);
      p.exponential_friction_force = random.uniform(0.0, 5.0);
      p.stribeck_exponent = random.uniform(0.5, 4.0);
    }
    const double mass = std::pow(10.0, random.uniform(-1.0, 3.0));
    const double v = random.uniform(-0.3, 0.3) * (i % 2 == 0 ? 1.0 : 0.01);
    const double drive = random.uniform(-200.0, 200.0) * (i % 5 == 0 ? 10.0 : 1.0);
    const double a = sms::acceleration_against_friction(p, at(v), mass, drive);
    const double off = mass * a + sms::friction(p, at(v, a)) - drive;
    if (same_bits(a, 0.0)) {  // neither branch holds: friction takes up the drive
      const double direction = v < 0.0 ? -1.0 : 1.0;
      CHECK(direction * (drive - sms::friction(p, at(v, -direction))) >= -1e-9);
      CHECK(direction * (drive - sms::friction(p, at(v, direction * 1e-300))) <= 1e-9);
    } else {
      CHECK(std::abs(off) <= 1e-12 * (std::abs(drive) + 200.0));
    }
    CHECK(sms::acceleration_against_friction(p, at(v), mass, drive + 1.0) >= a);
  }
}

TEST_CASE("limits of the balance: at rest, without Stribeck, mirrored, between the branches") {
  Params p;
  CHECK(sms::acceleration_against_friction(p, at(0.0), 4.0, 10.0) == doctest::Approx(2.5));
  CHECK(sms::acceleration_against_friction(p, at(0.0), 4.0, -10.0) == doctest::Approx(-2.5));
  const double a = sms::acceleration_against_friction(p, at(0.03), 4.0, 100.0);
  CHECK(sms::acceleration_against_friction(p, at(-0.03), 4.0, -100.0) == doctest::Approx(-a).epsilon(1e-14));
  p.stribeck_acceleration_factor = 0.0;
  CHECK(sms::acceleration_against_friction(p, at(0.03), 4.0, 100.0) ==
        doctest::Approx((100.0 - 38.0 - 530.0 * 0.03) / 4.0));
  p.coulomb_force_deceleration_change = -8.0;  // 45.9 N slowing down, 53.9 N speeding up
  CHECK(same_bits(sms::acceleration_against_friction(p, at(0.03), 4.0, 50.0), 0.0));
  CHECK(same_bits(sms::acceleration_against_two_branches(Params(), at(0.03), 4.0, 60.0), 0.0));
  CHECK(sms::acceleration_against_friction(p, at(0.03), 4.0, 45.0) == doctest::Approx(-0.9 / 4.0));
}

TEST_CASE("every law through one door") {
  const Params p;
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double v = random.uniform(-0.3, 0.3), z = random.uniform(-3e-4, 3e-4), drive = random.uniform(-300.0, 300.0);
    for (const FrictionLaw law : {FrictionLaw::acceleration_dependent, FrictionLaw::two_branch, FrictionLaw::stribeck,
                                  FrictionLaw::dahl, FrictionLaw::lugre}) {
      const sms::ForceBalance<double> b = sms::force_balance(p, law, at(v), z, 3.639, drive);
      CHECK(3.639 * b.acceleration + b.friction == doctest::Approx(drive).epsilon(1e-12));
    }
    if (std::abs(v) >= p.stiction_velocity) {  // below it the ramp of eq. 6.7 leads through zero
      CHECK(sms::force_balance(p, FrictionLaw::stribeck, at(v), z, 3.639, drive).friction ==
            doctest::Approx(sms::friction_stribeck(p, v)));
    }
  }
}

TEST_CASE("three coupled pistons: Newton's law for each with its own friction, whatever the mass matrix") {
  sms_test::Random random;
  for (int run = 0; run < sms_test::count / 10; ++run) {
    Params p;
    if (run % 3 == 1) p.coulomb_force_deceleration_change = random.uniform(-10.0, 0.0);
    if (run % 3 == 2) p.stribeck_exponent = random.uniform(0.5, 4.0);
    sms::Mat3<double> root;
    Piston piston[3];
    sms::Vec3<double> drive;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) root(i, k) = random.uniform(-10.0, 10.0);
      piston[i] = at(random.uniform(-0.2, 0.2) * (run % 5 == 0 ? 0.01 : 1.0));
      drive(i) = random.uniform(-300.0, 300.0);
    }
    const sms::Mat3<double> mass = root * root.transpose() + 5.0 * sms::Mat3<double>::Identity();
    sms::Vec3<double> a(0.0, 0.0, 0.0);
    REQUIRE(sms::coupled_accelerations<double>({p, p, p}, sms::FrictionLaw::acceleration_dependent, piston, mass, drive,
                                               a) == SMS_OK);
    const sms::Vec3<double> left = drive - mass * a;  // what friction has to take up
    const double scale = 1e-10 * (mass.norm() * a.norm() + drive.norm());
    for (int i = 0; i < 3; ++i) {
      const double v = piston[i].velocity, direction = v < 0.0 ? -1.0 : 1.0;
      if (same_bits(a(i), 0.0)) {
        CHECK(direction * (left(i) - sms::friction(p, at(v, -direction))) >= -scale);
        CHECK(direction * (left(i) - sms::friction(p, at(v, direction * 1e-300))) <= scale);
      } else {
        CHECK(std::abs(left(i) - sms::friction(p, at(v, a(i)))) <= scale);
      }
    }
  }
}

TEST_CASE("three pistons that are not coupled are three single ones; a mass that is none is refused") {
  sms_test::Random random;
  const Params p;
  for (int run = 0; run < 1000; ++run) {
    const Piston piston[3] = {at(random.uniform(-0.2, 0.2)), at(random.uniform(-0.2, 0.2)), at(0.0)};
    const sms::Vec3<double> drive(random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0), 50.0);
    sms::Vec3<double> a(0.0, 0.0, 0.0);
    const double mass = 106.0;
    REQUIRE(sms::coupled_accelerations<double>({p, p, p}, sms::FrictionLaw::acceleration_dependent, piston,
                                               mass * sms::Mat3<double>::Identity(), drive, a) == SMS_OK);
    for (int i = 0; i < 3; ++i) {
      const double alone = sms::acceleration_against_friction(p, piston[i], mass, drive(i));
      CHECK(mass * std::abs(a(i) - alone) <= 1e-10 * (mass * std::abs(alone) + std::abs(drive(i))));  // as above
    }
  }
  const Piston piston[3] = {at(0.1), at(0.1), at(0.1)};
  sms::Vec3<double> untouched(1.0, 2.0, 3.0);
  CHECK(sms::coupled_accelerations<double>({p, p, p}, sms::FrictionLaw::acceleration_dependent, piston,
                                           sms::Mat3<double>::Zero(), sms::Vec3<double>(1e3, 0.0, 0.0),
                                           untouched) == SMS_NOT_CONVERGED);
  CHECK(same_bits(untouched(1), 2.0));
}

TEST_CASE("float follows double") {
  const Params p;
  const sms::Params<float> pf;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double v = random.uniform(-0.3, 0.3), drive = random.uniform(-300.0, 300.0);
    const sms::Piston<float> piston = {0.2f, float(v), 0.0f, 386e3f, 281e3f};
    const float a = sms::acceleration_against_friction(pf, piston, 3.639f, float(drive));
    CHECK(double(a) ==
          doctest::Approx(sms::acceleration_against_friction(p, at(v), 3.639, drive)).epsilon(1e-3).scale(0.1));
    const float f = sms::lugre_friction(pf, piston, 2e-4f).force;
    CHECK(double(f) == doctest::Approx(sms::lugre_friction(p, at(v), 2e-4).force).epsilon(1e-5).scale(10.0));
  }
}
