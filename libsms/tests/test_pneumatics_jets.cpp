// Exact derivatives of valve, chamber, friction and force balance, against differences and at the places where they are
// easily lost: equal pressures, rest, effects at their neutral value.
#include <ceres/jet.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "random_cases.hpp"
#include "sms/coupled_balance.hpp"
#include "sms/vessel.hpp"

namespace {

using Jet = ceres::Jet<double, 1>;
using Params = sms::Params<double>;
using sms::FrictionLaw;
using sms::ValveLaw;

Jet variable(double x) { return Jet(x, 0); }

// d model / d argument[k] by Jets against a central difference, for a model over an array of arguments. A difference is
// trusted no further than it knows itself. Where flow begins to choke, ((r - b) / (1 - b))^m with a measured m near 1
// bends within microvolts: the differences to both sides disagree. At a row of the valve's table the curvature jumps by
// J, and a difference over 2 h whose middle is d away from the row errs by J (h - d)^2 / (4 h), though both sides may
// agree; half as wide it errs by no more than it then changes.
template <int N, typename Model>
void check_derivatives(const Model& model, const double (&argument)[N], double tolerance) {
  double largest = 0.0, error[N];
  for (int k = 0; k < N; ++k) {
    Jet jets[N];
    for (int i = 0; i < N; ++i) jets[i] = i == k ? variable(argument[i]) : Jet(argument[i]);
    const Jet value = model(jets);
    const double h = 1e-6 * (std::abs(argument[k]) + 1e-12);
    const auto at = [&](double step) {
      double moved[N];
      std::copy_n(argument, N, moved);
      moved[k] += step;
      return model(static_cast<const double*>(moved));
    };
    const double right = (at(h) - value.a) / h, left = (value.a - at(-h)) / h, wide = (left + right) / 2;
    const double central = (at(h / 2) - at(-h / 2)) / h;
    const double doubt = std::abs(right - left) + std::abs(wide - central);
    error[k] = (std::abs(value.v[0] - central) - doubt) * std::abs(argument[k]);
    largest = std::max({largest, std::abs(central * argument[k]), std::abs(value.a)});
  }
  for (int k = 0; k < N; ++k) {
    INFO("argument ", k, " of value ", argument[k]);
    CHECK(error[k] <= tolerance * largest);
  }
}

template <typename S>
sms::ValvePorts<S> ports_at(const S& lower, const S& upper) {
  const S T(293.0);
  return {{S(486e3), T}, {lower, T}, {upper, T}, {S(86e3), T}};
}

// What a plant needs of one actuator, as one number that all of it enters.
template <typename S>
S pressure_rates(const sms::Params<S>& p, ValveLaw law, const S& voltage, const S& lower, const S& upper) {
  const sms::ValvePorts<S> ports = ports_at(lower, upper);
  const auto ratios = sms::polytropic_ratios(p);
  const auto edges = sms::through_tubes(p, sms::valve_flows(p, law, ratios, voltage, ports), ports);
  const auto flow = sms::actuator_flows(p, edges, ports);
  const S x(0.15), v(0.1);
  return sms::polytropic_pressure_rate(p, ratios, ports.lower, sms::lower_space(p, x, v), flow.lower) +
         S(2.0) * sms::polytropic_pressure_rate(p, ratios, ports.upper, sms::upper_space(p, x, v), flow.upper);
}

}  // namespace

TEST_CASE("flow through one orifice, by everything it depends on") {
  sms_test::Random random;
  for (int i = 0; i < 500; ++i) {
    const double p1 = random.uniform(1e5, 6e5), b = random.uniform(0.05, 0.5), m = random.uniform(0.9, 2.0);
    const double ratio = random.uniform(0.02, 0.998);
    if (std::abs(ratio - b) < 0.01 || std::abs(ratio - 0.528) < 0.01) continue;
    const auto iso = [](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      return sms::iso_mass_flow<S>(sms::Params<S>(), {x[0], x[1], x[2]}, {x[3], S(293.0)}, {x[4], S(290.0)});
    };
    const auto classic = [](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      return sms::classic_mass_flow<S>(sms::Params<S>(), x[0], {x[1], x[2]}, {x[3], S(290.0)});
    };
    const auto leak = [](const auto* x) { return sms::leak_flow(x[0], x[1], x[2], x[3]); };
    for (const double n : {random.uniform(0.3, 0.99), 1.0}) {
      check_derivatives<4>(leak, {2e-8, n, p1, ratio * p1}, 1e-5);
      check_derivatives<4>(leak, {2e-8, n, ratio * p1, p1}, 1e-5);
      check_derivatives<4>(leak, {2e-8, n, p1, 0.9995 * p1}, 1e-5);
    }
    check_derivatives<5>(iso, {2e-8, b, m, p1, ratio * p1}, 1e-5);
    check_derivatives<5>(iso, {2e-8, b, m, ratio * p1, p1}, 1e-5);
    check_derivatives<4>(classic, {1e-5, p1, 293.0, ratio * p1}, 1e-5);
  }
}

TEST_CASE("at equal pressures the slope is finite, and the same from both sides") {
  const sms::Params<Jet> p;
  const sms::IsoFlow<Jet> component = {Jet(2e-8), Jet(0.3), Jet(1.1)};
  const auto iso = [&](double shift) {
    return sms::iso_mass_flow(p, component, {Jet(4e5), Jet(293.0)}, {variable(4e5 + shift), Jet(293.0)}).v[0];
  };
  const auto classic = [&](double shift) {
    return sms::classic_mass_flow(p, Jet(1e-5), {Jet(4e5), Jet(293.0)}, {variable(4e5 + shift), Jet(293.0)}).v[0];
  };
  for (const double shift : {0.0, 1e-9, -1e-9, 1e-3, -1e-3}) {
    CHECK(iso(shift) == doctest::Approx(iso(0.0)).epsilon(1e-7));
    CHECK(classic(shift) == doctest::Approx(classic(0.0)).epsilon(1e-7));
  }
  CHECK(iso(0.0) < 0.0);
  CHECK(classic(0.0) < 0.0);
}

TEST_CASE("the whole of one actuator's air, by command, pressures and parameters") {
  sms_test::Random random;
  for (int i = 0; i < 300; ++i) {
    const ValveLaw law = i % 2 == 0 ? ValveLaw::iso_0_4_mpa : ValveLaw::classic;
    const auto model = [law](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      sms::Params<S> p;
      p.mass_flow_gain = x[3];
      p.inflow_heat_ratio = x[4];
      p.dead_volume_lower = x[5];
      p.valve_leakage = x[6];
      p.piston_leakage = x[7];
      p.piston_leakage_index = x[12];
      p.leakage_index = x[13];
      p.tube_length = x[8];
      p.exhaust_flow_change = x[9];
      p.bore_diameter = x[10];
      p.valve_centre = x[11];
      return pressure_rates<S>(p, law, x[0], x[1], x[2]);
    };
    const double voltage = random.uniform(0.3, 9.7);
    if (std::abs(voltage - 5.0) < 0.6) continue;
    check_derivatives<14>(model,
                          {voltage, random.uniform(9e4, 4.8e5), random.uniform(9e4, 4.8e5), 1.5, 1.4, 1e-4, 1e-10,
                           1e-10, 0.3, 0.1, 0.1, 5.0, random.uniform(0.3, 1.0), random.uniform(0.6, 3.0)},
                          2e-5);
  }
}

TEST_CASE("an effect at its neutral value has its slope, on the side to which it can go") {
  Params plain;
  const double lower = 3.86e5, upper = 2.81e5, h = 1e-13;
  for (double Params::*effect : {&Params::valve_leakage, &Params::piston_leakage, &Params::chamber_leakage_lower,
                                 &Params::chamber_leakage_upper}) {
    Params more = plain;
    more.*effect = h;
    const double difference = (pressure_rates(more, ValveLaw::iso_0_4_mpa, 5.0, lower, upper) -
                               pressure_rates(plain, ValveLaw::iso_0_4_mpa, 5.0, lower, upper)) /
                              h;
    sms::Params<Jet> jets = sms::cast<Jet>(plain);
    for (int i = 0; i < sms::param_count; ++i) {
      if (&sms::param(plain, i) == &(plain.*effect)) sms::param(jets, i).v[0] = 1.0;
    }
    const Jet rate = pressure_rates(jets, ValveLaw::iso_0_4_mpa, Jet(5.0), Jet(lower), Jet(upper));
    CHECK(std::abs(rate.v[0]) > 0.0);
    CHECK(rate.v[0] == doctest::Approx(difference).epsilon(1e-3));
  }
}

TEST_CASE("full energy equation") {
  sms_test::Random random;
  for (int i = 0; i < 300; ++i) {
    const auto model = [](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      sms::Params<S> p;
      p.heat_transfer_coefficient = x[5];
      const auto space = sms::lower_space<S>(p, x[2], S(0.1));
      const auto rate = sms::energy_rates<S>(p, {x[0], x[1]}, space, {x[3], x[3] * S(293.0), x[4]});
      return rate.pressure + S(1e3) * rate.temperature;
    };
    check_derivatives<6>(model,
                         {random.uniform(1e5, 5e5), random.uniform(260.0, 330.0), random.uniform(0.01, 0.4), 0.01,
                          random.uniform(0.0, 0.01), 30.0},
                         1e-5);
  }
}

TEST_CASE("bristles") {
  sms_test::Random random;
  for (int i = 0; i < 300; ++i) {
    const double v = random.uniform(0.001, 0.3), z = random.uniform(1e-5, 6e-4);
    const auto model = [](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      sms::Params<S> p;
      p.bristle_stiffness = x[2];
      p.stiction_force = x[3];
      const auto b = sms::lugre_friction<S>(p, {S(0.2), x[0], S(0.0), S(386e3), S(281e3)}, x[1]);
      return b.force + S(1e3) * b.deflection_rate;
    };
    check_derivatives<4>(model, {v, z, 1e5, 77.27}, 1e-4);
  }
}

TEST_CASE("the solved acceleration carries the derivatives of the equation that it solves") {
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double v = random.uniform(0.006, 0.3) * (i % 2 == 0 ? 1.0 : -1.0), drive = random.uniform(-400.0, 400.0);
    for (const FrictionLaw law : {FrictionLaw::acceleration_dependent, FrictionLaw::two_branch, FrictionLaw::lugre}) {
      const auto model = [law](const auto* x) {
        using S = std::decay_t<decltype(*x)>;
        sms::Params<S> p;
        p.coulomb_force = x[3];
        p.stiction_force = x[4];
        p.stribeck_exponent = x[5];
        p.stribeck_acceleration_factor = x[6];
        p.coulomb_force_deceleration_change = x[7];
        return sms::force_balance<S>(p, law, {S(0.2), x[0], S(0.0), S(386e3), S(281e3)}, S(1e-4), x[1], x[2])
            .acceleration;
      };
      const double arguments[8] = {v, 3.639, drive, 38.0, 77.27, 1.4, 0.9, -4.0};
      // Within a difference's reach of a branch the two sides differ.
      const Params p;
      const double dry = 530.0 * std::abs(v) + 36.0;
      if (std::abs(std::abs(drive) - dry) < 3.0 || std::abs(std::abs(drive) - dry - 40.0) < 3.0) continue;
      check_derivatives<8>(model, arguments, 1e-4);
    }
  }
}

TEST_CASE("and so do three coupled ones") {
  sms_test::Random random;
  for (int run = 0; run < 300; ++run) {
    const double v[3] = {random.uniform(0.01, 0.2), random.uniform(-0.2, -0.01), random.uniform(0.01, 0.2)};
    const auto model = [&v](const auto* x) {
      using S = std::decay_t<decltype(*x)>;
      sms::Params<S> p;
      p.stiction_force = x[4];
      sms::Piston<S> piston[3];
      for (int i = 0; i < 3; ++i) piston[i] = {S(0.2), x[0] * S(v[i]), S(0.0), S(386e3), S(281e3)};
      sms::Mat3<S> mass = sms::Mat3<S>::Constant(S(-56.0));
      mass.diagonal().setConstant(x[3]);
      sms::Vec3<S> a(S(0.0), S(0.0), S(0.0));
      REQUIRE(sms::coupled_accelerations<S>({p, p, p}, sms::FrictionLaw::acceleration_dependent, piston, mass,
                                            sms::Vec3<S>(x[1], x[2], S(140.0)), a) == SMS_OK);
      return a(0) + S(2.0) * a(1) + S(3.0) * a(2);
    };
    check_derivatives<5>(model, {1.0, random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0), 223.0, 77.27},
                         1e-4);
  }
}

TEST_CASE("at rest, at start-up, in the middle of the valve: all finite") {
  sms::Params<Jet> p;
  p.valve_leakage = variable(0.0);
  for (const ValveLaw law : {ValveLaw::iso_0_4_mpa, ValveLaw::iso_0_2_mpa, ValveLaw::classic}) {
    for (const double voltage : {0.0, 5.0, 5.559, 10.0}) {
      for (const double pressure : {86e3, 486e3, 3e5}) {
        const Jet rate = pressure_rates(p, law, variable(voltage), variable(pressure), variable(pressure));
        CHECK(std::isfinite(rate.a));
        CHECK(std::isfinite(rate.v[0]));
      }
    }
  }
  for (const FrictionLaw law : {FrictionLaw::acceleration_dependent, FrictionLaw::two_branch, FrictionLaw::stribeck,
                                FrictionLaw::dahl, FrictionLaw::lugre}) {
    for (const double drive : {-100.0, 0.0, 1e-300, 100.0}) {
      for (const double v : {0.0, 1e-300, -1e-9}) {
        const sms::ForceBalance<Jet> b = sms::force_balance(
            p, law, {Jet(0.2), variable(v), Jet(0.0), Jet(386e3), Jet(281e3)}, Jet(0.0), Jet(4.0), variable(drive));
        CHECK(std::isfinite(b.acceleration.v[0]));
        CHECK(std::isfinite(b.deflection_rate.v[0]));
      }
    }
  }
}
