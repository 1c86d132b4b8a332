// Chambers, tubes, tank, reservoir: mass and energy add up, the limits are the textbook's.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "random_cases.hpp"
#include "sms/chamber.hpp"
#include "sms/vessel.hpp"

namespace {

using Params = sms::Params<double>;
using Gas = sms::Gas<double>;
using Space = sms::ChamberSpace<double>;
using Flow = sms::ChamberFlow<double>;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Gas random_gas(sms_test::Random& random) { return {random.uniform(5e4, 7e5), random.uniform(250.0, 350.0)}; }

sms::ValvePorts<double> random_ports(sms_test::Random& random) {
  return {random_gas(random), random_gas(random), random_gas(random), random_gas(random)};
}

struct Case {
  Gas gas;
  Space space;
  Flow flow;
};

Case random_case(sms_test::Random& random) {
  const double in = random.uniform(0.0, 0.02), temperature = random.uniform(250.0, 350.0);
  return {random_gas(random),
          {random.uniform(1e-4, 4e-3), random.uniform(-3e-3, 3e-3), random.uniform(0.01, 0.2)},
          {in, in * temperature, random.uniform(0.0, 0.02)}};
}

}  // namespace

TEST_CASE("volumes: eq. 4.31, and rates of opposite sign") {
  const Params p;
  const sms::PistonAreas<double> area = sms::piston_areas(p);
  for (const double x : {0.0, 0.13, 0.2, 0.4}) {
    const Space lower = sms::lower_space(p, x, 0.3), upper = sms::upper_space(p, x, 0.3);
    CHECK(lower.volume == doctest::Approx(1e-4 + area.lower * x));
    CHECK(upper.volume == doctest::Approx(1e-4 + area.upper * (0.4 - x)));
    CHECK(lower.rate == doctest::Approx(0.3 * area.lower));
    CHECK(upper.rate == doctest::Approx(-0.3 * area.upper));
    const double h = 1e-6;
    CHECK((sms::lower_space(p, x + h, 0.3).wall_area - sms::lower_space(p, x - h, 0.3).wall_area) / (2 * h) ==
          doctest::Approx(3.14159265358979 * 0.1));
  }
}

TEST_CASE("the energy equation: p V = m R T stays, and energy is neither made nor lost") {
  sms_test::Random random;
  Params p;
  for (int i = 0; i < sms_test::count; ++i) {
    const Case c = random_case(random);
    p.heat_transfer_coefficient = random.uniform(0.0, 200.0);
    const sms::GasRate<double> rate = sms::energy_rates(p, c.gas, c.space, c.flow);
    const double m = sms::air_mass(p, c.gas, c.space.volume), R = 288.0, cv = R / 0.4, cp = 1.4 * cv;
    const double pv = rate.pressure * c.space.volume + c.gas.pressure * c.space.rate;
    const double mrt = R * (rate.mass * c.gas.temperature + m * rate.temperature);
    CHECK(pv == doctest::Approx(mrt).epsilon(1e-11).scale(1e4));
    const double heat = p.heat_transfer_coefficient * c.space.wall_area * (293.0 - c.gas.temperature);
    const double power = cp * (c.flow.in_heat - c.flow.out * c.gas.temperature) - c.gas.pressure * c.space.rate + heat;
    CHECK(cv * mrt / R == doctest::Approx(power).epsilon(1e-11).scale(1e4));
    CHECK(sms::internal_energy(p, c.gas, c.space.volume) == doctest::Approx(m * cv * c.gas.temperature));
  }
}

TEST_CASE("three equal ratios are the energy equation without heat, at the chamber's temperature") {
  sms_test::Random random;
  Params p;
  p.heat_transfer_coefficient = 0.0;
  for (int i = 0; i < 1000; ++i) {
    Case c = random_case(random);
    c.flow.in_heat = c.flow.in * c.gas.temperature;
    CHECK(sms::polytropic_pressure_rate(p, sms::adiabatic_ratios(p), c.gas, c.space, c.flow) ==
          doctest::Approx(sms::energy_rates(p, c.gas, c.space, c.flow).pressure).epsilon(1e-12).scale(1e6));
  }
}

TEST_CASE("a closed chamber: adiabatic without heat, isothermal with much") {
  for (const double h : {0.0, 1e4}) {
    Params p;
    p.heat_transfer_coefficient = h;
    const double dt = 1e-5, v0 = sms::lower_space(p, 0.1, 0.0).volume;
    Gas gas = {3e5, 293.0};
    const Flow none = {0.0, 0.0, 0.0};
    for (int i = 0; i < 20000; ++i) {  // 0.2 s, 0.1 m, by the midpoint rule
      const double x = 0.1 + 0.5 * dt * i;
      const sms::GasRate<double> k = sms::energy_rates(p, gas, sms::lower_space(p, x, 0.5), none);
      const Gas middle = {gas.pressure + 0.5 * dt * k.pressure, gas.temperature + 0.5 * dt * k.temperature};
      const sms::GasRate<double> rate = sms::energy_rates(p, middle, sms::lower_space(p, x + 0.25 * dt, 0.5), none);
      gas = {gas.pressure + dt * rate.pressure, gas.temperature + dt * rate.temperature};
    }
    const double ratio = v0 / sms::lower_space(p, 0.2, 0.0).volume;
    if (h > 0.0) {
      CHECK(gas.pressure == doctest::Approx(3e5 * ratio).epsilon(0.02));
      CHECK(gas.temperature == doctest::Approx(293.0).epsilon(0.02));
    } else {
      CHECK(gas.pressure == doctest::Approx(3e5 * std::pow(ratio, 1.4)).epsilon(1e-7));
      CHECK(gas.temperature == doctest::Approx(293.0 * std::pow(ratio, 0.4)).epsilon(1e-7));
    }
  }
}

TEST_CASE("air is neither made nor lost between supply, chambers and exhaust, leaks and tubes included") {
  sms_test::Random random;
  Params p;
  for (int i = 0; i < sms_test::count; ++i) {
    p.valve_leakage = random.uniform(0.0, 1e-9);
    p.piston_leakage = random.uniform(0.0, 1e-9);
    p.piston_leakage_index = random.uniform(0.3, 1.0);
    p.tube_length = random.uniform(0.0, 3.0);
    const sms::ValvePorts<double> ports = random_ports(random);
    const sms::EdgeFlows<double> valve =
        sms::valve_flows(p, sms::ValveLaw::iso_0_4_mpa, sms::polytropic_ratios(p), random.uniform(0.0, 10.0), ports);
    const sms::EdgeFlows<double> edge = sms::through_tubes(p, valve, ports);
    const sms::ActuatorFlows<double> flow = sms::actuator_flows(p, edge, ports);
    const double gained = flow.lower.in - flow.lower.out + flow.upper.in - flow.upper.out;
    CHECK(gained == doctest::Approx(flow.drawn - edge.lower_exhaust - edge.upper_exhaust).epsilon(1e-12).scale(1e-3));
    for (const Flow& f : {flow.lower, flow.upper}) {
      CHECK(f.in >= 0.0);
      CHECK(f.out >= 0.0);
      CHECK(f.in_heat >= 250.0 * f.in * (1 - 1e-12));
      CHECK(f.in_heat <= 350.0 * f.in * (1 + 1e-12));
    }
    CHECK(std::abs(edge.supply_lower) <= std::abs(valve.supply_lower));
  }
}

TEST_CASE("leaks run from the higher pressure to the lower, and are absent to the bit when neutral") {
  sms_test::Random random;
  const Params neutral;
  Params p;
  p.piston_leakage = 1e-9;
  p.chamber_leakage_lower = 2e-9;
  p.chamber_leakage_upper = 3e-9;
  const sms::EdgeFlows<double> closed = {0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < 1000; ++i) {
    const sms::ValvePorts<double> ports = random_ports(random);
    const sms::ActuatorFlows<double> tight = sms::actuator_flows(neutral, closed, ports);
    for (const Flow& f : {tight.lower, tight.upper}) {
      CHECK(same_bits(f.in, 0.0));
      CHECK(same_bits(f.out, 0.0));
    }
    const sms::ActuatorFlows<double> flow = sms::actuator_flows(p, closed, ports);
    const double a = ports.lower.pressure, b = ports.upper.pressure, out = ports.exhaust.pressure;
    CHECK(flow.lower.in - flow.lower.out == doctest::Approx(1e-9 * (b - a) + 2e-9 * (out - a)).scale(1e-5));
    CHECK(flow.upper.in - flow.upper.out == doctest::Approx(1e-9 * (a - b) + 3e-9 * (out - b)).scale(1e-5));
  }
}

TEST_CASE("the power law of leaks: of a gas, one way as the other, whole where it becomes laminar") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double high = random.uniform(1e4, 1e6), ratio = random.uniform(0.0, 1.0), n = random.uniform(0.3, 1.0);
    const double flow = sms::leak_flow(1e-9, n, high, ratio * high), back = sms::leak_flow(1e-9, n, ratio * high, high);
    CHECK(same_bits(back, -flow));
    CHECK(sms::leak_flow(1e-9, n, 2.0 * high, 2.0 * ratio * high) == doctest::Approx(2.0 * flow).epsilon(1e-12));
    CHECK(flow >= sms::leak_flow(1e-9, n, high, (ratio + 1e-8) * high));
    CHECK(sms::leak_flow(1e-9, n, high, 0.5 * high) == doctest::Approx(1e-9 * 0.5 * high).epsilon(1e-12));
    CHECK(same_bits(sms::leak_flow(1e-9, 1.0, high, ratio * high), 1e-9 * (high - ratio * high)));
    CHECK(sms::leak_flow(1e-9, n, high, (0.999 - 1e-9) * high) ==
          doctest::Approx(sms::leak_flow(1e-9, n, high, (0.999 + 1e-9) * high)).epsilon(1e-5));
  }
}

// As mass_flow.hpp says of two laws by C, b and m.
TEST_CASE("what an exponent of a leak stands for") {
  const struct { double exponent, m, within; } law[] = {{0.5, 1.1, 0.02}, {0.45, 2.0, 0.09}};
  for (const auto& l : law) {
    double least = 1e9, most = 0.0;
    for (double r = 0.1; r < 0.99; r += 0.001) {
      const double other = sms::iso_subsonic_flow<double>({1.0, 0.0, l.m}, r);
      const double ratio = sms::leak_flow(1.0, l.exponent, 1.0, r) / other;
      least = std::min(least, ratio);
      most = std::max(most, ratio);
    }
    CHECK(std::sqrt(most / least) < 1.0 + l.within);
  }
}

TEST_CASE("the tube: nothing without length, 0.87 ms in 300 mm, a loss that grows with flow and length") {
  Params p;
  sms_test::Random random;
  const sms::ValvePorts<double> ports = random_ports(random);
  const sms::EdgeFlows<double> edge = {0.013, 0.0, 0.0, 0.009};
  const sms::EdgeFlows<double> through = sms::through_tubes(p, edge, ports);
  CHECK(same_bits(through.supply_lower, edge.supply_lower));
  CHECK(same_bits(sms::tube_transmission(p, 0.01, 3e5), 1.0));
  CHECK(same_bits(sms::lower_space(p, 0.2, 0.0).volume, 1e-4 + sms::piston_areas(p).lower * 0.2));
  p.tube_length = 0.3;
  CHECK(sms::tube_delay(p) == doctest::Approx(870e-6).epsilon(0.01));
  CHECK(sms::tube_volume(p) == doctest::Approx(1.1545e-5).epsilon(1e-3));
  double last = 1.0;
  for (const double flow : {0.0, 1e-4, 1.18e-4, 1.2e-4, 1e-3, 1e-2, 3e-2}) {
    const double part = sms::tube_transmission(p, flow, 3.3e5);
    CHECK(part <= last);
    CHECK(part > 0.9);
    CHECK(same_bits(sms::tube_transmission(p, -flow, 3.3e5), part));
    last = part;
  }
}

TEST_CASE("the tank of the flow test: eq. 5.5 while choked, at rest at equal pressure") {
  const Params p;
  const sms::IsoFlow<double> component = {3.05117e-9, 0.50252, 1.05};  // 0.3 mm, 0.2 MPa
  const Gas supply = {286e3, 293.0}, ambient = {86e3, 293.0};
  const double expected = 1.4 * 288.0 * 293.0 / 5e-3 * 3.05117e-9 * 286e3 * 1.185 * std::sqrt(293.15 / 293.0);
  CHECK(sms::tank_pressure_rate(p, component, ambient, supply) == doctest::Approx(expected).epsilon(1e-13));
  CHECK(sms::tank_pressure_rate(p, component, supply, ambient) == doctest::Approx(-expected / 1.4).epsilon(1e-13));
  CHECK(same_bits(sms::tank_pressure_rate(p, component, supply, supply), 0.0));
  // With temperature as a state, charging an adiabatic tank from vacuum heats the air to kappa T.
  Params tight = p;
  tight.heat_transfer_coefficient = 0.0;
  Gas tank = {1.0, 293.0};
  for (int i = 0; i < 200000; ++i) {
    const sms::GasRate<double> rate =
        sms::energy_rates(tight, tank, sms::tank_space(tight), sms::tank_flow(tight, component, tank, supply));
    tank = {tank.pressure + 1e-6 * rate.pressure, tank.temperature + 1e-6 * rate.temperature};
  }
  CHECK(tank.temperature == doctest::Approx(1.4 * 293.0).epsilon(0.01));
}

TEST_CASE("the reservoir: stiff without a line, droops by r m' with one") {
  Params p;
  CHECK(same_bits(sms::reservoir_pressure_rate(p, 4e5, 0.01), 0.0));
  p.supply_line_resistance = 1e6;
  CHECK(sms::reservoir_pressure_rate(p, p.supply_pressure - 1e4, 0.01) == doctest::Approx(0.0));
  CHECK(sms::reservoir_pressure_rate(p, p.supply_pressure, 0.01) ==
        doctest::Approx(-1.2 * 288.0 * 293.0 / 5e-3 * 0.01));
}

TEST_CASE("float follows double") {
  sms_test::Random random;
  const Params p;
  const sms::Params<float> pf;
  for (int i = 0; i < 1000; ++i) {
    const Case c = random_case(random);
    const sms::Gas<float> gas = {float(c.gas.pressure), float(c.gas.temperature)};
    const sms::ChamberSpace<float> space = {float(c.space.volume), float(c.space.rate), float(c.space.wall_area)};
    const sms::ChamberFlow<float> flow = {float(c.flow.in), float(c.flow.in_heat), float(c.flow.out)};
    CHECK(double(sms::polytropic_pressure_rate(pf, sms::polytropic_ratios(pf), gas, space, flow)) ==
          doctest::Approx(sms::polytropic_pressure_rate(p, sms::polytropic_ratios(p), c.gas, c.space, c.flow))
              .epsilon(1e-5)
              .scale(1e6));
    CHECK(double(sms::energy_rates(pf, gas, space, flow).temperature) ==
          doctest::Approx(sms::energy_rates(p, c.gas, c.space, c.flow).temperature).epsilon(1e-4).scale(1e2));
  }
}
