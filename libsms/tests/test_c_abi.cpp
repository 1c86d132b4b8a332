// The functions for C of valve, chambers and controllers against the templates they stand for: the same bits, in both
// precisions. What the C compiler sees of them is in c_pneumatics.c.
#include <doctest/doctest.h>

#include <cstring>

#include "random_cases.hpp"
#include "sms/chamber.hpp"
#include "sms/controller.hpp"
#include "sms/sms.h"

namespace {

// The names of one precision: C<float>::valve_flows is sms_valve_flowsf.
template <typename S>
struct C;
#define SMS_TEST_NAMES(S, NAME)                                                        \
  template <>                                                                          \
  struct C<S> {                                                                        \
    using Gas = NAME(sms_gas);                                                         \
    using Ports = NAME(sms_valve_ports);                                               \
    using Edges = NAME(sms_edge_flows);                                                \
    using Flows = NAME(sms_actuator_flows);                                            \
    using Space = NAME(sms_chamber_space);                                             \
    using Lag = NAME(sms_lag);                                                         \
    using IsoFlow = NAME(sms_iso_flow);                                                \
    using PidSettings = NAME(sms_pid_settings);                                        \
    using Pid = NAME(sms_pid);                                                         \
    using FeedbackSettings = NAME(sms_state_feedback_settings);                        \
    using Feedback = NAME(sms_state_feedback);                                         \
    using DeadBand = NAME(sms_dead_band);                                              \
    static constexpr auto classic_mass_flow = NAME(sms_classic_mass_flow);             \
    static constexpr auto iso_mass_flow = NAME(sms_iso_mass_flow);                     \
    static constexpr auto sonic_conductance = NAME(sms_sonic_conductance);             \
    static constexpr auto spool_cubic = NAME(sms_spool_cubic);                         \
    static constexpr auto spool_linear = NAME(sms_spool_linear);                       \
    static constexpr auto orifice_area = NAME(sms_orifice_area);                       \
    static constexpr auto valve_opening = NAME(sms_valve_opening);                     \
    static constexpr auto spool_rate = NAME(sms_spool_rate);                           \
    static constexpr auto valve_flows = NAME(sms_valve_flows);                         \
    static constexpr auto chamber_spaces = NAME(sms_chamber_spaces);                   \
    static constexpr auto chamber_flows = NAME(sms_chamber_flows);                     \
    static constexpr auto chamber_rate = NAME(sms_chamber_rate);                       \
    static constexpr auto air_mass = NAME(sms_air_mass);                               \
    static constexpr auto pid_from_params = NAME(sms_pid_from_params);                 \
    static constexpr auto pid_step = NAME(sms_pid_step);                               \
    static constexpr auto pid_follow = NAME(sms_pid_follow);                           \
    static constexpr auto pid_change_gains = NAME(sms_pid_change_gains);               \
    static constexpr auto feedback_from_params = NAME(sms_state_feedback_from_params); \
    static constexpr auto feedback_at = NAME(sms_state_feedback_at);                   \
    static constexpr auto feedback_step = NAME(sms_state_feedback_step);               \
    static constexpr auto dead_band_from_params = NAME(sms_dead_band_from_params);     \
    static constexpr auto over_dead_band = NAME(sms_over_dead_band);                   \
    static constexpr auto dead_band_gain = NAME(sms_dead_band_gain);                   \
    static constexpr auto valve_command = NAME(sms_valve_command);                     \
  };
#define SMS_TEST_DOUBLE(name) name
#define SMS_TEST_FLOAT(name) name##f
SMS_TEST_NAMES(double, SMS_TEST_DOUBLE)
SMS_TEST_NAMES(float, SMS_TEST_FLOAT)

// Of two structs of numbers alone.
template <typename A, typename B>
bool same_bits(const A& a, const B& b) {
  static_assert(sizeof(A) == sizeof(B), "one layout");
  return std::memcmp(&a, &b, sizeof(A)) == 0;
}

template <typename S>
S between(sms_test::Random& random, double lower, double upper) {
  return S(random.uniform(lower, upper));
}

template <typename S>
sms::Gas<S> random_gas(sms_test::Random& random) {
  return {between<S>(random, 50e3, 700e3), between<S>(random, 250.0, 350.0)};
}

// A machine with every effect of valve, chamber and controller.
template <typename S>
sms::Params<S> random_machine(sms_test::Random& random) {
  sms::Params<S> p;
  p.valve_leakage = between<S>(random, 0.0, 1e-10);
  p.dead_band_change = between<S>(random, -0.2, 0.2);
  p.exhaust_flow_change = between<S>(random, -0.3, 0.3);
  p.piston_leakage = between<S>(random, 0.0, 1e-9);
  p.chamber_leakage_lower = between<S>(random, 0.0, 1e-9);
  p.heat_share = random.uniform(0.0, 1.0) < 0.5 ? S(0) : between<S>(random, 0.1, 1.0);
  p.flow_map_feed_upper_3 = between<S>(random, -0.05, 0.05);
  p.integral_gain = between<S>(random, 0.0, 50.0);
  p.derivative_gain = between<S>(random, 0.0, 1.0);
  return p;
}

template <typename S>
void check_pneumatics(sms_test::Random& random) {
  using Names = C<S>;
  const sms::Params<S> p = random_machine<S>(random);
  const sms::ValvePorts<S> ports = {random_gas<S>(random), random_gas<S>(random), random_gas<S>(random),
                                    random_gas<S>(random)};
  const sms::IsoFlow<S> component = {between<S>(random, 1e-10, 5e-8), between<S>(random, 0.0, 0.6),
                                     between<S>(random, 0.3, 2.0)};
  const S voltage = between<S>(random, 0.0, 10.0), area = between<S>(random, 0.0, 1e-5);
  const auto law = static_cast<sms::ValveLaw>(int(random.uniform(0.0, 3.0)));
  const auto air = static_cast<sms::ChamberLaw>(int(random.uniform(0.0, 2.0)));
  typename Names::Ports c_ports;
  typename Names::IsoFlow c_component;
  std::memcpy(&c_ports, &ports, sizeof c_ports);
  std::memcpy(&c_component, &component, sizeof c_component);

  CHECK(same_bits(Names::classic_mass_flow(&p, area, &c_ports.supply, &c_ports.lower),
                  sms::classic_mass_flow(p, area, ports.supply, ports.lower)));
  CHECK(same_bits(Names::iso_mass_flow(&p, &c_component, &c_ports.supply, &c_ports.lower),
                  sms::iso_mass_flow(p, component, ports.supply, ports.lower)));
  CHECK(same_bits(Names::sonic_conductance(&p, area), sms::sonic_conductance(p, area)));
  CHECK(same_bits(Names::spool_cubic(&p, voltage), sms::spool_cubic(p, voltage)));
  CHECK(same_bits(Names::spool_linear(&p, voltage), sms::spool_linear(p, voltage)));
  CHECK(same_bits(Names::orifice_area(&p, S(1e-4) * voltage), sms::orifice_area(p, S(S(1e-4) * voltage))));
  CHECK(same_bits(Names::valve_opening(&p, voltage), sms::valve_opening(p, voltage)));

  const sms::Lag<S> spool = {between<S>(random, 0.0, 10.0), between<S>(random, -100.0, 100.0)};
  typename Names::Lag c_spool, c_rate;
  std::memcpy(&c_spool, &spool, sizeof c_spool);
  REQUIRE(Names::spool_rate(&p, &c_spool, voltage, &c_rate) == SMS_OK);
  CHECK(same_bits(c_rate, sms::spool_rate(p, spool, voltage)));

  typename Names::Edges c_edges;
  REQUIRE(Names::valve_flows(&p, sms_valve_law(law), sms_chamber_law(air), voltage, &c_ports, &c_edges) == SMS_OK);
  const sms::EdgeFlows<S> edges = sms::valve_flows(p, law, sms::heat_ratios(p, air), voltage, ports);
  CHECK(same_bits(c_edges, edges));

  typename Names::Flows c_flows;
  REQUIRE(Names::chamber_flows(&p, &c_edges, &c_ports, &c_flows) == SMS_OK);
  const sms::ActuatorFlows<S> flows = sms::actuator_flows(p, edges, ports);
  CHECK(same_bits(c_flows, flows));

  const S extension = between<S>(random, 0.0, 0.4), velocity = between<S>(random, -0.5, 0.5);
  typename Names::Space c_lower, c_upper;
  REQUIRE(Names::chamber_spaces(&p, extension, velocity, &c_lower, &c_upper) == SMS_OK);
  CHECK(same_bits(c_lower, sms::lower_space(p, extension, velocity)));
  CHECK(same_bits(c_upper, sms::upper_space(p, extension, velocity)));

  typename Names::Gas c_gas_rate;
  REQUIRE(Names::chamber_rate(&p, sms_chamber_law(air), &c_ports.lower, &c_lower, &c_flows.lower, &c_gas_rate) ==
          SMS_OK);
  const sms::ChamberSpace<S> space = sms::lower_space(p, extension, velocity);
  CHECK(same_bits(c_gas_rate,
                  sms::gas_rate(p, air, ports.lower, sms::seen_air(p, air, ports.lower), space, flows.lower)));
  CHECK(same_bits(Names::air_mass(&p, &c_ports.lower, space.volume), sms::air_mass(p, ports.lower, space.volume)));
}

template <typename S>
void check_controllers(sms_test::Random& random) {
  using Names = C<S>;
  const sms::Params<S> p = random_machine<S>(random);
  sms::PidSettings<S> settings = sms::pid_settings(p);
  typename Names::PidSettings c_settings;
  REQUIRE(Names::pid_from_params(&p, &c_settings) == SMS_OK);
  CHECK(same_bits(c_settings.limit, settings.limit));
  settings.anti_windup = static_cast<sms::AntiWindup>(int(random.uniform(0.0, 2.0)));
  c_settings.anti_windup = int(settings.anti_windup);
  sms::Pid<S> pid{};
  typename Names::Pid c_pid{};
  sms::StateFeedback<S> feedback = sms::state_feedback_at(S(0.1));
  const sms::StateFeedbackSettings<S> gains = sms::state_feedback_settings(p);
  typename Names::Feedback c_feedback;
  typename Names::FeedbackSettings c_gains;
  Names::feedback_at(S(0.1), &c_feedback);
  REQUIRE(Names::feedback_from_params(&p, &c_gains) == SMS_OK);
  CHECK(same_bits(c_gains, gains));
  const sms::DeadBand<S> dead_band = sms::make_dead_band(p.dead_band_step, p.dead_band_sharpness);
  typename Names::DeadBand c_dead_band;
  REQUIRE(Names::dead_band_from_params(&p, &c_dead_band) == SMS_OK);
  CHECK(same_bits(c_dead_band, dead_band));
  for (int i = 0; i < 8; ++i) {
    const S error = between<S>(random, -0.4, 0.4);
    const S u = sms::pid_step(settings, pid, error);
    CHECK(same_bits(Names::pid_step(&c_settings, &c_pid, error), u));
    CHECK(same_bits(c_pid, pid));
    CHECK(same_bits(Names::feedback_step(&c_gains, &c_feedback, S(0.2), error),
                    sms::state_feedback_step(gains, feedback, S(0.2), error)));
    CHECK(same_bits(c_feedback, feedback));
    CHECK(same_bits(Names::over_dead_band(&c_dead_band, u), sms::over_dead_band(dead_band, u)));
    CHECK(same_bits(Names::dead_band_gain(&c_dead_band, u), sms::dead_band_gain(dead_band, u)));
    CHECK(same_bits(Names::valve_command(&c_dead_band, S(5), u), sms::valve_command(dead_band, S(5), u)));
  }
  sms::pid_follow(settings, pid, S(0.01), S(2));
  Names::pid_follow(&c_settings, &c_pid, S(0.01), S(2));
  CHECK(same_bits(c_pid, pid));
  sms::PidSettings<S> wanted = settings;
  wanted.proportional *= S(1.5);
  auto c_wanted = c_settings;
  c_wanted.proportional *= S(1.5);
  sms::pid_change_gains(settings, pid, wanted);
  Names::pid_change_gains(&c_settings, &c_pid, &c_wanted);
  CHECK(same_bits(c_pid, pid));
  CHECK(same_bits(c_settings.proportional, settings.proportional));
}

}  // namespace

TEST_CASE("C: valve and chambers, the bits of the templates") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    check_pneumatics<double>(random);
    check_pneumatics<float>(random);
  }
}

TEST_CASE("C: controllers, the bits of the templates") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count; ++i) {
    check_controllers<double>(random);
    check_controllers<float>(random);
  }
}

TEST_CASE("C: the parameters carry the number and size of their headers, values one after the other") {
  sms_params p;
  sms_paramsf pf;
  REQUIRE(sms_params_default(&p) == SMS_OK);
  REQUIRE(sms_params_defaultf(&pf) == SMS_OK);
  const sms::Params<double> core;
  CHECK(same_bits(p, core));
  CHECK(same_bits(pf, sms::Params<float>()));
  for (int i = 0; i < sms_param_count(); ++i) {
    CHECK(same_bits(sms::param(core, i), sms_param_describe(i)->value));
    CHECK(same_bits(sms::cast<float>(core), pf));
  }
}
