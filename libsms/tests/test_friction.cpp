// Friction: what the equation says at its limits, and what its derivatives are there.
#include <doctest/doctest.h>

#include <cstring>
#include <utility>

#include "random_cases.hpp"
#include "sms/force_balance.hpp"
#include "sms/piston.hpp"
#include "sms/sensor.hpp"

namespace {

sms::Piston<double> piston_at(double velocity, double acceleration) {
  return {0.2, velocity, acceleration, 386.0e3, 281.0e3};
}

double friction_at(double velocity, double acceleration) {
  return sms::friction(sms::Params<double>(), piston_at(velocity, acceleration));
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

sms::Piston<double> random_piston(sms_test::Random& random) {
  return {random.uniform(0.0, 0.4), random.uniform(-0.3, 0.3), random.uniform(-3.0, 3.0), random.uniform(86e3, 5e5),
          random.uniform(86e3, 5e5)};
}

}  // namespace

TEST_CASE("friction is odd in velocity and acceleration") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double v = random.uniform(-0.3, 0.3), a = random.uniform(-3.0, 3.0);
    CHECK(friction_at(-v, -a) == doctest::Approx(-friction_at(v, a)).epsilon(1e-15));
  }
}

TEST_CASE("limits: no acceleration, no velocity, next to none") {
  CHECK(same_bits(friction_at(0.0, 0.0), 0.0));
  CHECK(friction_at(0.0, 1.0) == doctest::Approx(0.0));
  CHECK(friction_at(0.1, 0.0) == doctest::Approx(38.0 + 53.0));     // no Stribeck term at a = 0
  CHECK(friction_at(0.1, 1e-300) == doctest::Approx(38.0 + 53.0));  // nor next to it
  CHECK(friction_at(1e-8, 0.0) == doctest::Approx(38.0 * 3.14159265358979 / 0.01 * 1e-8));
  CHECK(friction_at(0.005, 1e9) == doctest::Approx(77.27 + 530.0 * 0.005));  // a -> inf: the whole static force
}

TEST_CASE("peak inside the stiction limit: 44 N at slow break-away, 78 N at 1 m/s^2") {
  const auto peak = [](double acceleration) {
    double largest = 0.0;
    for (int i = 0; i <= 1000; ++i) largest = std::max(largest, friction_at(5e-6 * i, acceleration));
    return largest;
  };
  CHECK(peak(0.05) == doctest::Approx(44.0).epsilon(0.03));
  CHECK(peak(1.0) == doctest::Approx(78.1).epsilon(0.01));
}

TEST_CASE("friction takes energy at any speed and acceleration") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double v = random.uniform(-0.5, 0.5);
    CHECK(friction_at(v, random.uniform(-5.0, 5.0)) * v >= 0.0);
  }
}

TEST_CASE("a neutral effect is absent to the bit, an active one is not") {
  // Each effect's parameter at its neutral value against the equation written without it.
  sms_test::Random random;
  sms::Params<double> p;
  for (int i = 0; i < sms_test::count; ++i) {
    const sms::Piston<double> s = random_piston(random);
    const double ramp = sms::friction_ramp(s.velocity, p.stiction_velocity);
    const bool up = s.velocity * s.acceleration > 0.0;
    const double width = std::abs(s.acceleration) * p.stribeck_acceleration_factor * p.stribeck_velocity;
    const double fall = up ? sms::stribeck_fall(s.velocity, width, p.stribeck_exponent) : 0.0;
    const double plain = ramp * (p.coulomb_force + (p.stiction_force - p.coulomb_force) * fall) +
                         std::abs(ramp) * (p.viscous_friction * s.velocity);
    CHECK(same_bits(sms::friction(p, s), plain));
    CHECK(same_bits(sms::sensor_reading(plain, 0.0, 0.0), plain));
    CHECK(same_bits(sms::sensor_truth(plain, 0.0, 0.0), plain));
  }
  const sms::Piston<double> sliding = {0.35, 0.1, 0.0, 386.0e3, 281.0e3};
  const double neutral = sms::friction(p, sliding);
  for (double sms::Params<double>::*effect :
       {&sms::Params<double>::pressure_friction, &sms::Params<double>::direction_friction,
        &sms::Params<double>::position_friction, &sms::Params<double>::exponential_friction_force}) {
    sms::Params<double> q;
    q.*effect = 1e-3;
    CHECK(!same_bits(sms::friction(q, sliding), neutral));
  }
}

TEST_CASE("effects act as they say") {
  sms::Params<double> p;
  p.viscous_friction = 0.0;
  p.pressure_friction = 1e-5;
  sms::Piston<double> s = {0.2, 0.1, 0.0, 286.0e3, 186.0e3};  // 2 and 1 bar above ambient
  CHECK(sms::friction(p, s) == doctest::Approx(38.0 + 3.0));
  sms::Piston<double> starting = {0.2, 0.1, 1e6, 286.0e3, 186.0e3};
  const double starts = sms::friction(p, starting);
  p.pressure_stiction = p.pressure_friction / p.coulomb_force;  // all dry friction grows alike: 38 N by 3 N
  CHECK(sms::friction(p, s) == doctest::Approx(38.0 + 3.0));
  CHECK(sms::friction(p, starting) == doctest::Approx(starts + 3.0 / 38.0 * (p.stiction_force - p.coulomb_force)));
  p.pressure_friction = p.pressure_stiction = 0.0;
  p.direction_friction = 5.0;
  CHECK(sms::friction(p, s) == doctest::Approx(43.0));
  s.velocity = -0.1;
  CHECK(sms::friction(p, s) == doctest::Approx(-33.0));
  p.direction_friction = 0.0;
  p.position_friction = 2.0;
  s.extension = 0.3;
  CHECK(sms::friction(p, s) == doctest::Approx(-38.0 * 1.2));
}

TEST_CASE("a friction curve that is off by so much at the speeds of its knots, by all laws, each direction its own") {
  sms_test::Random random;
  sms::Params<double> p;
  p.friction_map_extend_1 = 0.1;
  p.friction_map_extend_2 = -0.2;
  p.friction_map_extend_3 = 0.3;
  p.friction_map_retract_2 = 0.5;
  for (const auto& [velocity, error] : {std::pair{0.006, 0.1},
                                        {0.03, 0.1},
                                        {0.075, -0.05},
                                        {0.12, -0.2},
                                        {0.3, 0.3},
                                        {2.0, 0.3},
                                        {-0.12, 0.5},
                                        {-0.3, 0.0}}) {
    CHECK(sms::friction_map(p, velocity) == doctest::Approx(1.0 + error));
    for (int i = 0; i < 100; ++i) {
      sms::Piston<double> s = random_piston(random);
      s.velocity = velocity;
      const sms::Params<double> exact;
      CHECK(sms::friction(p, s) == doctest::Approx((1.0 + error) * sms::friction(exact, s)));
      CHECK(sms::friction_two_branch(p, s) == doctest::Approx((1.0 + error) * sms::friction_two_branch(exact, s)));
      // Bristles that are bent as far as they are in steady sliding, where they carry all of the dry friction.
      const double dry = sms::stribeck_force(exact, velocity), stiffness = p.bristle_stiffness;
      const double bent = (velocity < 0.0 ? -1.0 : 1.0) * dry / stiffness, coulomb = bent * p.coulomb_force / dry;
      const auto lugre = sms::lugre_friction(p, s, (1.0 + error) * bent),
                 lugre_exact = sms::lugre_friction(exact, s, bent);
      const auto dahl = sms::dahl_friction(p, s, (1.0 + error) * coulomb),
                 dahl_exact = sms::dahl_friction(exact, s, coulomb);
      for (const auto& [off, of_curve] : {std::pair{lugre, lugre_exact}, {dahl, dahl_exact}}) {
        CHECK(off.force == doctest::Approx((1.0 + error) * of_curve.force));
        CHECK(std::abs(off.deflection_rate) < 1e-12);
        CHECK(std::abs(of_curve.deflection_rate) < 1e-12);
      }
      const double drive = random.uniform(-300.0, 300.0);
      for (const sms::FrictionLaw law :
           {sms::FrictionLaw::acceleration_dependent, sms::FrictionLaw::two_branch, sms::FrictionLaw::stribeck}) {
        const auto balance = sms::force_balance(p, law, s, 0.0, p.moving_mass, drive);
        s.acceleration = balance.acceleration;
        const double wanted = law == sms::FrictionLaw::acceleration_dependent ? sms::friction(p, s)
                              : law == sms::FrictionLaw::two_branch           ? sms::friction_two_branch(p, s)
                                                                              : sms::friction_stribeck(p, s.velocity);
        if (std::abs(balance.acceleration) > 1e-9 && std::abs(velocity) >= p.stiction_velocity) {
          CHECK(balance.friction == doctest::Approx(wanted).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_CASE("force balance: single acting, at rest, and Newton's second law") {
  sms::Params<double> p;
  const sms::Piston<double> rest = {0.2, 0.0, 0.0, 286.0e3, p.ambient_pressure};
  CHECK(sms::rod_force(p, rest) == doctest::Approx(200.0e3 * sms::circle_area(p.bore_diameter)).epsilon(1e-15));

  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const sms::Piston<double> s = random_piston(random);
    const sms::PistonAreas<double> area = sms::piston_areas(p);
    const double balance = s.pressure_lower * area.lower - s.pressure_upper * area.upper -
                           p.ambient_pressure * area.rod - sms::friction(p, s) - sms::rod_force(p, s);
    CHECK(balance == doctest::Approx(p.moving_mass * s.acceleration).epsilon(1e-9));
  }
}

TEST_CASE("float follows double") {
  sms_test::Random random;
  const sms::Params<double> p;
  const sms::Params<float> pf;
  for (int i = 0; i < sms_test::count; ++i) {
    const sms::Piston<double> s = random_piston(random);
    const sms::Piston<float> sf = {float(s.extension), float(s.velocity), float(s.acceleration),
                                   float(s.pressure_lower), float(s.pressure_upper)};
    CHECK(double(sms::friction(pf, sf)) == doctest::Approx(sms::friction(p, s)).epsilon(2e-4).scale(1.0));
  }
}

TEST_CASE("cast keeps every parameter") {
  sms::Params<double> p;
  for (int i = 0; i < sms::param_count; ++i) sms::param(p, i) = 1.0 + i;
  const sms::Params<float> f = sms::cast<float>(p);
  for (int i = 0; i < sms::param_count; ++i) CHECK(sms::param(f, i) == 1.0f + float(i));
}
