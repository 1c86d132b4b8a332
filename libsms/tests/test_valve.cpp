// The valve: spool, orifices, both laws of flow, the measured tables, four edges.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "random_cases.hpp"
#include "sms/chamber.hpp"
#include "sms/valve.hpp"

namespace {

using Params = sms::Params<double>;
using Gas = sms::Gas<double>;
using Flow = sms::IsoFlow<double>;
using Table = sms::ValveTable<double>;
using sms::ValveLaw;

const sms::HeatRatios<double> ratios = {1.4, 1.0, 1.2};
const Table& at_0_4_mpa = sms::valve_table_0_4_mpa<double>();
const Table& at_0_2_mpa = sms::valve_table_0_2_mpa<double>();
const ValveLaw laws[] = {ValveLaw::iso_0_4_mpa, ValveLaw::iso_0_2_mpa, ValveLaw::classic};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

double column(const Table& table, int k, double opening) {
  return sms::valve_table_value(table, k, sms::valve_table_place(table, opening));
}

Flow random_component(sms_test::Random& random) {
  return {random.uniform(1e-10, 5e-8), random.uniform(0.0, 0.6), random.uniform(0.5, 3.0)};
}

sms::ValvePorts<double> ports_at(double lower, double upper) {
  return {{486e3, 293.0}, {lower, 293.0}, {upper, 293.0}, {86e3, 293.0}};
}

sms::ValvePorts<double> random_ports(sms_test::Random& random) {
  return ports_at(random.uniform(50e3, 600e3), random.uniform(50e3, 600e3));
}

}  // namespace

TEST_CASE("spool and area: the shape of eq. 4.1 to 4.4") {
  const Params p;
  CHECK(sms::spool_cubic(p, 5.0) == doctest::Approx(-1e-7).epsilon(1e-9));
  CHECK(sms::spool_linear(p, 10.0) == doctest::Approx(1.9556e-3));
  CHECK(same_bits(sms::orifice_area(p, 0.0), 0.0));
  CHECK(same_bits(sms::orifice_area(p, 0.2e-3), 0.0));  // inside the overlap
  CHECK(sms::orifice_area(p, 0.215e-3 + 1e-8) == doctest::Approx(3 * 1.59 * 7.5e-3 * 1e-8).epsilon(1e-6));
  const double largest = 3 * 1.59 * 7.5e-3 * (1.9e-3 - 0.215e-3);
  CHECK(sms::orifice_area(p, -1.9e-3) == doctest::Approx(largest));
  CHECK(sms::orifice_area(p, 5.0e-3) == doctest::Approx(largest));  // the spool has stopped
}

TEST_CASE("either law: odd, in proportion to pressure, falling with the pressure downstream") {
  const Params p;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const Flow component = random_component(random);
    const double area = random.uniform(1e-7, 6e-5), p1 = random.uniform(1e4, 1e6), p2 = random.uniform(1e4, 1e6);
    const double scale = random.uniform(0.1, 10.0);
    const Gas a = {p1, 293.0}, b = {p2, 293.0}, c = {p2 * 1.001, 293.0};
    const double iso = sms::iso_mass_flow(p, component, a, b), classic = sms::classic_mass_flow(p, area, a, b);
    CHECK(same_bits(sms::iso_mass_flow(p, component, b, a), -iso));
    CHECK(same_bits(sms::classic_mass_flow(p, area, b, a), -classic));
    const Gas as = {scale * p1, 293.0}, bs = {scale * p2, 293.0};
    CHECK(sms::iso_mass_flow(p, component, as, bs) == doctest::Approx(scale * iso).epsilon(1e-11));
    CHECK(sms::classic_mass_flow(p, area, as, bs) == doctest::Approx(scale * classic).epsilon(1e-10));
    CHECK(sms::iso_mass_flow(p, component, a, c) <= iso);
    CHECK(sms::classic_mass_flow(p, area, a, c) <= classic);
    CHECK(iso * (p1 - p2) >= 0.0);
  }
}

TEST_CASE("no pressure, no difference, no flow") {
  const Params p;
  const Flow component = {1e-8, 0.3, 1.0};
  for (const double pressure : {0.0, 1.0, 486e3}) {
    const Gas gas = {pressure, 293.0};
    CHECK(sms::iso_mass_flow(p, component, gas, gas) == doctest::Approx(0.0));
    CHECK(sms::classic_mass_flow(p, 1e-6, gas, gas) == doctest::Approx(0.0));
  }
  const Gas vacuum = {0.0, 293.0}, air = {486e3, 293.0};
  CHECK(sms::iso_mass_flow(p, component, air, vacuum) == doctest::Approx(1e-8 * 1.185 * 486e3).epsilon(1e-3));
}

TEST_CASE("both sides meet at the critical ratio, at 0.999, and in the classic law's last 1e-5") {
  const Params p;
  sms_test::Random random;
  const double p1 = 486e3, step = 1e-12;
  const auto jump = [&](const auto& flow, double ratio) {
    const double before = flow(ratio * (1 - step)), after = flow(ratio * (1 + step));
    return std::abs(after - before) / (std::abs(before) + 1e-15);
  };
  const auto classic = [&](double ratio) { return sms::classic_mass_flow(p, 1e-6, {p1, 293.0}, {ratio * p1, 293.0}); };
  CHECK(jump(classic, sms::critical_pressure_ratio(p.heat_capacity_ratio)) < 1e-10);
  CHECK(jump(classic, 1 - 1e-5) < 1e-6);
  for (int i = 0; i < 200; ++i) {
    Flow component = random_component(random);
    component.subsonic_index = random.uniform(1.0, 3.0);
    const auto iso = [&](double ratio) { return sms::iso_mass_flow(p, component, {p1, 293.0}, {ratio * p1, 293.0}); };
    CHECK(jump(iso, component.critical_ratio) < 1e-10);
    CHECK(jump(iso, 0.999) < 1e-8);
  }
}

TEST_CASE("the linear piece of eq. 5.8 is twice as steep as the root that it meets") {
  const Params p;
  const double p1 = 486e3, h = 1e-7;
  for (int row = 0; row < sms::valve_row_count(); ++row) {
    const Flow flow = sms::charge_flow(at_0_4_mpa, ratios, at_0_4_mpa.opening[row]);
    const auto at = [&](double ratio) { return sms::iso_mass_flow(p, flow, {p1, 293.0}, {ratio * p1, 293.0}); };
    const double before = (at(0.999 - h) - at(0.999 - 2 * h)) / h, after = (at(0.999 + 2 * h) - at(0.999 + h)) / h;
    CHECK(after / before == doctest::Approx(2.0).epsilon(0.01));
  }
}

TEST_CASE("eq. 5.10: equal flows when choked, at any temperature") {
  const Params p;
  sms_test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double area = random.uniform(1e-7, 6e-5);
    const Gas from = {random.uniform(3e5, 1e6), random.uniform(250.0, 330.0)}, to = {86e3, 293.0};
    const Flow component = {sms::sonic_conductance(p, area), 0.5, 2.0};
    CHECK(sms::iso_mass_flow(p, component, from, to) ==
          doctest::Approx(sms::classic_mass_flow(p, area, from, to)).epsilon(1e-13));
  }
}

TEST_CASE("a table: its rows to the bit, nothing beyond them in between, linear below, constant above") {
  for (const Table* table : {&at_0_4_mpa, &at_0_2_mpa}) {
    for (int k = 0; k < Table::columns; ++k) {
      for (int i = 0; i < sms::valve_row_count(); ++i) {
        const double value = table->curve[k][i][0];
        CHECK(same_bits(column(*table, k, table->opening[i]), value));
        if (i + 1 == sms::valve_row_count()) continue;
        const double next = table->curve[k][i + 1][0];
        CHECK(table->opening[i + 1] > table->opening[i]);
        double last = value;
        for (int j = 1; j <= 64; ++j) {
          const double x = table->opening[i] + j / 64.0 * (table->opening[i + 1] - table->opening[i]);
          const double y = column(*table, k, x);
          CHECK((y - last) * (next - value) >= -1e-14 * std::abs(value * value));  // monotone between two rows
          last = y;
        }
      }
      CHECK(same_bits(column(*table, k, 7.0), table->curve[k][sms::valve_row_count() - 1][0]));
    }
    const double first = table->opening[0];
    CHECK(first == doctest::Approx(0.559).epsilon(1e-12));
    const Flow full = sms::charge_flow(*table, ratios, first), half = sms::charge_flow(*table, ratios, 0.5 * first);
    CHECK(half.sonic_conductance == doctest::Approx(0.5 * full.sonic_conductance));
    CHECK(same_bits(half.subsonic_index, full.subsonic_index));
    CHECK(same_bits(sms::discharge_flow(*table, ratios, 0.0).sonic_conductance, 0.0));
  }
}

TEST_CASE("a table's curves have no kink, at the first and at the last row neither") {
  const double h = 1e-6;
  for (const Table* table : {&at_0_4_mpa, &at_0_2_mpa}) {
    for (const bool charge : {true, false}) {
      const auto at = [&](double opening) {
        const Flow f =
            charge ? sms::charge_flow(*table, ratios, opening) : sms::discharge_flow(*table, ratios, opening);
        return f;
      };
      for (int i = 0; i < sms::valve_row_count(); ++i) {
        const double x = table->opening[i];
        const Flow lower = at(x - h), here = at(x), upper = at(x + h);
        const auto kink = [&](double a, double b, double c) { return std::abs(c - 2 * b + a) / h; };
        CHECK(kink(lower.sonic_conductance, here.sonic_conductance, upper.sonic_conductance) <
              1e-11);  // a missed slope would show as 1e-9
        CHECK(kink(lower.critical_ratio, here.critical_ratio, upper.critical_ratio) < 1e-2);
        CHECK(kink(lower.subsonic_index, here.subsonic_index, upper.subsonic_index) < 2e-2);
      }
    }
  }
}

TEST_CASE("other heat ratios leave the measured rate of pressure as it was") {
  const Table& table = at_0_4_mpa;
  const sms::HeatRatios<double> kappa = {1.3, 1.4, 1.4};
  CHECK(1.3 * sms::charge_flow(table, kappa, 1.7).sonic_conductance ==
        doctest::Approx(1.4 * sms::charge_flow(table, ratios, 1.7).sonic_conductance));
  CHECK(1.4 * sms::discharge_flow(table, kappa, 1.7).sonic_conductance ==
        doctest::Approx(1.0 * sms::discharge_flow(table, ratios, 1.7).sonic_conductance));
}

TEST_CASE("four edges: two open, mirrored in the centre, the tables in proportion to the gain") {
  Params p;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const ValveLaw law = laws[i % 3];
    const double voltage = random.uniform(5.0, 10.0);
    const sms::ValvePorts<double> ports = random_ports(random);
    const sms::ValvePorts<double> mirrored = {ports.supply, ports.upper, ports.lower, ports.exhaust};
    const sms::EdgeFlows<double> flow = sms::valve_flows(p, law, ratios, voltage, ports);
    CHECK(same_bits(flow.lower_exhaust, 0.0));
    CHECK(same_bits(flow.supply_upper, 0.0));
    CHECK(flow.supply_lower * (ports.supply.pressure - ports.lower.pressure) >= 0.0);
    CHECK(flow.upper_exhaust * (ports.upper.pressure - ports.exhaust.pressure) >= 0.0);
    if (law != ValveLaw::classic) {  // the cubic is not symmetric
      const sms::EdgeFlows<double> other = sms::valve_flows(p, law, ratios, 10.0 - voltage, mirrored);
      CHECK(other.supply_upper == doctest::Approx(flow.supply_lower).epsilon(1e-10));
      CHECK(other.lower_exhaust == doctest::Approx(flow.upper_exhaust).epsilon(1e-10));
    }
    Params doubled = p;
    doubled.mass_flow_gain *= 2.0;
    CHECK(same_bits(sms::valve_flows(doubled, law, ratios, voltage, ports).supply_lower,
                    (law == ValveLaw::classic ? 1.0 : 2.0) * flow.supply_lower));
  }
}

TEST_CASE("the published speed: about 0.1 m/s per volt at 5 V, 1042.5 N on the rod") {
  // Constant speed: what flows in is p_a A_a v / (R T) at constant pressure (alpha_i m' R T = alpha p A v).
  const Params p;
  const sms::PistonAreas<double> area = sms::piston_areas(p);
  const auto speed = [&](double lower) {  // of the lower chamber's filling
    const sms::EdgeFlows<double> flow = sms::valve_flows(p, ValveLaw::iso_0_4_mpa, ratios, 10.0, ports_at(lower, 3e5));
    return 1.4 * flow.supply_lower * 288.0 * 293.0 / (1.2 * lower * area.lower);
  };
  const auto venting = [&](double upper) {
    const sms::EdgeFlows<double> flow = sms::valve_flows(p, ValveLaw::iso_0_4_mpa, ratios, 10.0, ports_at(3e5, upper));
    return 1.0 * flow.upper_exhaust * 288.0 * 293.0 / (1.2 * upper * area.upper);
  };
  // Both chambers at one speed v carry the weight and the friction 38 N + 530 v.
  double low = 87e3, high = 480e3;
  double v = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double upper = 0.5 * (low + high);
    v = venting(upper);
    const double lower = 86e3 + (1042.5 + 38.0 + 530.0 * v + (upper - 86e3) * area.upper) / area.lower;
    (speed(lower) > v ? low : high) = upper;
  }
  CHECK(v / 5.0 == doctest::Approx(0.106).epsilon(0.02));
}

TEST_CASE("neutral effects are absent to the bit, active ones act") {
  const Params p;
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const double voltage = random.uniform(0.0, 10.0);
    const sms::ValvePorts<double> ports = random_ports(random);
    CHECK(same_bits(sms::valve_opening(p, voltage), voltage - 5.0));
    const double opening = std::abs(voltage - 5.0);
    const Flow feed = sms::charge_flow(at_0_4_mpa, ratios, opening);
    const Flow vent = sms::discharge_flow(at_0_4_mpa, ratios, opening);
    const sms::EdgeFlows<double> flow = sms::valve_flows(p, ValveLaw::iso_0_4_mpa, ratios, voltage, ports);
    const bool up = voltage >= 5.0;
    const Gas &fed = up ? ports.lower : ports.upper, &vented = up ? ports.upper : ports.lower;
    CHECK(same_bits(up ? flow.supply_lower : flow.supply_upper,
                    0.0 + 1.5 * sms::iso_mass_flow(p, feed, ports.supply, fed)));
    CHECK(same_bits(up ? flow.upper_exhaust : flow.lower_exhaust,
                    0.0 + 1.5 * sms::iso_mass_flow(p, vent, vented, ports.exhaust)));
  }
  const sms::ValvePorts<double> ports = ports_at(386e3, 281e3);
  Params leaking = p;
  leaking.valve_leakage = 1e-10;
  const sms::EdgeFlows<double> leak = sms::valve_flows(leaking, ValveLaw::iso_0_4_mpa, ratios, 5.0, ports);
  for (const double edge : {leak.supply_lower, leak.lower_exhaust, leak.supply_upper, leak.upper_exhaust}) {
    CHECK(edge > 0.0);
  }
  const double labyrinth = 1e-10 * 1.185 * std::sqrt(293.15 / 293.0) * std::sqrt(486e3 * 486e3 - 386e3 * 386e3);
  CHECK(leak.supply_lower == doctest::Approx(labyrinth));
  Params restricted = p;
  restricted.exhaust_flow_change = -0.2;
  CHECK(sms::valve_flows(restricted, ValveLaw::classic, ratios, 7.0, ports).upper_exhaust ==
        doctest::Approx(0.8 * sms::valve_flows(p, ValveLaw::classic, ratios, 7.0, ports).upper_exhaust));
}

TEST_CASE("the tables' flow may be off at each of the four edges by itself") {
  double Params::*const at_knots[][6] = {
#define EDGE(name)                                                                           \
  {&Params::flow_map_##name##_1, &Params::flow_map_##name##_2, &Params::flow_map_##name##_3, \
   &Params::flow_map_##name##_4, &Params::flow_map_##name##_5, &Params::flow_map_##name##_6}
      EDGE(feed_lower), EDGE(vent_lower), EDGE(feed_upper), EDGE(vent_upper)};
#undef EDGE
  const auto in_order = [](const sms::EdgeFlows<double>& flow) {
    return std::array<double, 4>{flow.supply_lower, flow.lower_exhaust, flow.supply_upper, flow.upper_exhaust};
  };
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const Params exact;
    Params off;
    const int edge = int(random.uniform(0.0, 4.0));
    const double error = random.uniform(-0.1, 0.1);
    for (double Params::*knot : at_knots[edge]) {
      off.*knot = error;
    }
    const sms::ValvePorts<double> ports = random_ports(random);
    const double voltage = random.uniform(0.0, 10.0);
    for (const ValveLaw law : {ValveLaw::iso_0_4_mpa, ValveLaw::iso_0_2_mpa, ValveLaw::classic}) {
      const auto flow = in_order(sms::valve_flows(off, law, ratios, voltage, ports));
      const auto table = in_order(sms::valve_flows(exact, law, ratios, voltage, ports));
      for (int k = 0; k < 4; ++k) {
        CHECK(flow[k] == doctest::Approx((k == edge ? 1.0 + error : 1.0) * table[k]));
      }
    }
  }
}

TEST_CASE("a changed dead band shifts the tables without a step") {
  Params p;
  for (const double change : {-0.3, 0.1, 0.5}) {
    p.dead_band_change = change;
    const double first = at_0_4_mpa.opening[0];
    CHECK(sms::valve_opening(p, 5.0 + first + change) == doctest::Approx(first));
    CHECK(sms::valve_opening(p, 5.0 - 2.0 - change) == doctest::Approx(-2.0));
    const double border = 5.0 + first + change;
    CHECK(sms::valve_opening(p, border - 1e-9) == doctest::Approx(sms::valve_opening(p, border + 1e-9)).epsilon(1e-7));
    CHECK(same_bits(sms::valve_opening(p, 5.0), 0.0));
  }
}

TEST_CASE("the spool settles where it is told, within its electronics' range") {
  const Params p;
  for (const double command : {-3.0, 0.0, 4.2, 10.0, 12.0}) {
    const double within = std::min(10.0, std::max(0.0, command));
    const sms::Lag<double> rate = sms::spool_rate(p, {within, 0.0}, command);
    CHECK(rate.value == doctest::Approx(0.0));
    CHECK(rate.rate == doctest::Approx(0.0));
  }
  CHECK(sms::spool_rate(p, {5.0, 0.0}, 6.0).rate == doctest::Approx(std::pow(2 * 3.14159265358979 * 65.0, 2)));
}

TEST_CASE("float follows double") {
  const Params p;
  const sms::Params<float> pf;
  const sms::HeatRatios<float> ratiosf = sms::polytropic_ratios(pf);
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    const ValveLaw law = laws[i % 3];
    const double voltage = random.uniform(5.2, 10.0);
    const sms::ValvePorts<double> ports = ports_at(random.uniform(90e3, 480e3), random.uniform(90e3, 480e3));
    const auto narrow = [](const Gas& gas) { return sms::Gas<float>{float(gas.pressure), float(gas.temperature)}; };
    const sms::ValvePorts<float> portsf = {narrow(ports.supply), narrow(ports.lower), narrow(ports.upper),
                                           narrow(ports.exhaust)};
    const sms::EdgeFlows<double> flow = sms::valve_flows(p, law, ratios, voltage, ports);
    const sms::EdgeFlows<float> flowf = sms::valve_flows(pf, law, ratiosf, float(voltage), portsf);
    CHECK(double(flowf.supply_lower) == doctest::Approx(flow.supply_lower).epsilon(2e-3).scale(1e-4));
    CHECK(double(flowf.upper_exhaust) == doctest::Approx(flow.upper_exhaust).epsilon(2e-3).scale(1e-4));
  }
}
