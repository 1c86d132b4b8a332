/* A C99 program that links libsms: a header of another version is refused, and valve, chambers and controllers do in C
 * what the plant of plant.h does with them, in both precisions. Bit by bit against the templates: test_c_abi.cpp. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sms/sms.h"

static int failures = 0;

static int close_to(double a, double b, double tolerance) { return fabs(a - b) <= tolerance; }

static void check(int ok, const char *what) {
  if (!ok) {
    printf("FAILED: %s\n", what);
    ++failures;
  }
}

/* Every function that takes parameters says so when they are not of its headers, and writes nothing. */
static void check_refusals(const sms_params *params, const char *what) {
  static const double q[3] = {0.0, 0.0, 0.5};
  const sms_piston piston = {0.2, 0.1, 0.3, 386.0e3, 281.0e3};
  const sms_gas air = {486.0e3, 293.0}, outside = {86.0e3, 293.0};
  const sms_iso_flow component = {1e-8, 0.3, 0.5};
  const sms_lag spool = {5.0, 0.0};
  const sms_edge_flows edges = {1e-3, 0.0, 0.0, 1e-3};
  const sms_chamber_space space = {1e-3, 0.0, 0.1};
  const sms_chamber_flow flow = {1e-3, 0.3, 0.0};
  sms_valve_ports ports;
  sms_actuator_laws laws;
  sms_geometry geometry, geometry_before;
  sms_mechanism mechanism;
  sms_bench bench;
  sms_platform platform;
  sms_lag rate;
  sms_edge_flows flows;
  sms_chamber_space lower, upper;
  sms_actuator_flows sorted;
  sms_gas gas_rate;
  sms_pid_settings pid;
  sms_state_feedback_settings feedback;
  sms_dead_band dead_band;
  double push = 7.0, pull = 7.0;
  int index = -1;

  ports.supply = ports.lower = air;
  ports.upper = ports.exhaust = outside;
  sms_published_laws(&laws);
  memset(&geometry, 7, sizeof geometry);
  geometry_before = geometry;
  check(sms_params_check(params, &index) == SMS_WRONG_ABI && index == -1, what);
  check(sms_geometry_from_params(params, &geometry) == SMS_WRONG_ABI, what);
  check(memcmp(&geometry, &geometry_before, sizeof geometry) == 0, what);
  check(sms_mechanism_from_params(params, SMS_MASSES_CORRECTED, &mechanism) == SMS_WRONG_ABI, what);
  check(sms_bench_from_params(params, &laws, &bench) == SMS_WRONG_ABI, what);
  check(sms_platform_from_params(params, &laws, SMS_MASSES_CORRECTED, &platform) == SMS_WRONG_ABI, what);
  check(sms_force_range(params, &push, &pull) == SMS_WRONG_ABI && push == 7.0 && pull == 7.0, what);
  check(sms_spool_rate(params, &spool, 6.0, &rate) == SMS_WRONG_ABI, what);
  check(sms_valve_flows(params, SMS_VALVE_CLASSIC, SMS_CHAMBER_ENERGY, 6.0, &ports, &flows) == SMS_WRONG_ABI, what);
  check(sms_chamber_spaces(params, 0.1, 0.0, &lower, &upper) == SMS_WRONG_ABI, what);
  check(sms_chamber_flows(params, &edges, &ports, &sorted) == SMS_WRONG_ABI, what);
  check(sms_chamber_rate(params, SMS_CHAMBER_ENERGY, &air, &space, &flow, &gas_rate) == SMS_WRONG_ABI, what);
  check(sms_pid_from_params(params, &pid) == SMS_WRONG_ABI, what);
  check(sms_state_feedback_from_params(params, &feedback) == SMS_WRONG_ABI, what);
  check(sms_dead_band_from_params(params, &dead_band) == SMS_WRONG_ABI, what);
  check(isnan(sms_friction(params, &piston)) && isnan(sms_friction_stribeck(params, 0.1)), what);
  check(isnan(sms_rod_force(params, &piston)) && isnan(sms_end_stop_force(params, 0.1, 0.0)), what);
  check(isnan(sms_force_share(params, q)) && isnan(sms_orifice_area(params, 1e-3)), what);
  check(isnan(sms_spool_cubic(params, 6.0)) && isnan(sms_spool_linear(params, 6.0)), what);
  check(isnan(sms_valve_opening(params, 6.0)) && isnan(sms_sonic_conductance(params, 1e-6)), what);
  check(isnan(sms_classic_mass_flow(params, 1e-6, &air, &outside)), what);
  check(isnan(sms_iso_mass_flow(params, &component, &air, &outside)), what);
  check(isnan(sms_air_mass(params, &air, 1e-3)), what);
}

static void check_abi(void) {
  sms_params params, untouched;
  sms_paramsf paramsf;
  sms_actuator_laws laws;
  sms_bench bench;
  sms_bench_input input = {6.0, 0.0};
  sms_bench_state state, rate;
  sms_stepping stepping;

  check(sms_params_default(&params) == SMS_OK && sms_params_defaultf(&paramsf) == SMS_OK, "the headers are its own");
  check(params.abi == SMS_ABI && params.size == sizeof params && paramsf.size == sizeof paramsf, "and it says so");

  memset(&untouched, 7, sizeof untouched);
  params = untouched;
  check(sms_params_init(SMS_ABI + 1, sizeof params, &params) == SMS_WRONG_ABI, "a later number");
  check(sms_params_init(SMS_ABI, sizeof params - sizeof(double), &params) == SMS_WRONG_ABI, "a parameter less");
  check(sms_params_init(SMS_ABI, sizeof params + sizeof(double), &params) == SMS_WRONG_ABI, "a parameter more");
  check(sms_params_init(SMS_ABI, sizeof paramsf, &params) == SMS_WRONG_ABI, "the other precision");
  check(memcmp(&params, &untouched, sizeof params) == 0, "and nothing was written");
  check_refusals(&params, "parameters that were never initialised");
  memset(&params, 0, sizeof params);
  check_refusals(&params, "parameters of zeros");
  sms_params_default(&params);
  params.abi = SMS_ABI + 1;
  check_refusals(&params, "parameters of a later header");
  sms_params_default(&params);
  params.size -= (uint_least32_t)sizeof(double);
  check_refusals(&params, "parameters of a header with one less");

  sms_params_default(&params);
  sms_published_laws(&laws);
  check(sms_bench_from_params(&params, &laws, &bench) == SMS_OK, "a bench");
  check(sms_bench_at_rest(&bench, 0.1, 0.0, 333.0e3, &state) == SMS_OK, "at rest");
  sms_stepping_begin(1e-6, &stepping);
  bench.params.abi = 0;
  check(sms_bench_at_rest(&bench, 0.1, 0.0, 333.0e3, &state) == SMS_WRONG_ABI, "a plant is asked too");
  check(sms_bench_derivative(&bench, &state, &input, &rate) == SMS_WRONG_ABI, "at every call");
  check(sms_bench_step(&bench, &input, 1e-4, &state) == SMS_WRONG_ABI, "step");
  check(sms_bench_advance(&bench, &input, 1e-3, &stepping, &state) == SMS_WRONG_ABI, "advance");
  laws.drive = 2;
  check(sms_bench_from_params(&params, &laws, &bench) == SMS_OUT_OF_RANGE, "there is no third drive");
}

/* The rates of a bench's chambers and spool, put together from their terms. */
static void check_pneumatics(const sms_params *params, const sms_paramsf *paramsf) {
  const sms_bench_input input = {6.3, 20.0};
  sms_actuator_laws laws;
  sms_bench bench;
  sms_bench_state state, rate;
  sms_valve_ports ports;
  sms_valve_portsf portsf;
  sms_edge_flows edges, untouched = {7.0, 7.0, 7.0, 7.0};
  sms_edge_flowsf edgesf;
  sms_actuator_flows flows;
  sms_chamber_space lower, upper;
  sms_gas lower_rate, upper_rate, empty = {0.0, 293.0};
  sms_lag spool;
  int valve, chamber;

  for (valve = SMS_VALVE_ISO_0_4_MPA; valve <= SMS_VALVE_CLASSIC; ++valve) {
    for (chamber = SMS_CHAMBER_POLYTROPIC; chamber <= SMS_CHAMBER_ENERGY; ++chamber) {
      sms_published_laws(&laws);
      laws.valve = valve;
      laws.chamber = chamber;
      check(sms_bench_from_params(params, &laws, &bench) == SMS_OK, "a bench");
      check(sms_bench_at_rest(&bench, 0.1, 20.0, 333.0e3, &state) == SMS_OK, "at rest");
      state.velocity = 0.1;
      state.actuator.spool.value = 6.2;
      state.actuator.lower.temperature = chamber == SMS_CHAMBER_ENERGY ? 310.0 : params->air_temperature;
      check(sms_bench_derivative(&bench, &state, &input, &rate) == SMS_OK, "its derivative");

      ports.supply.pressure = state.actuator.supply_pressure;
      ports.exhaust.pressure = params->ambient_pressure;
      ports.supply.temperature = ports.exhaust.temperature = params->air_temperature;
      ports.lower = state.actuator.lower;
      ports.upper = state.actuator.upper;
      check(sms_spool_rate(params, &state.actuator.spool, input.command, &spool) == SMS_OK, "spool");
      check(spool.value == rate.actuator.spool.value && spool.rate == rate.actuator.spool.rate, "as in the plant");
      check(sms_valve_flows(params, (sms_valve_law)valve, (sms_chamber_law)chamber, state.actuator.spool.value, &ports,
                            &edges) == SMS_OK,
            "valve");
      check(edges.supply_lower > 0.0 && edges.upper_exhaust > 0.0 && edges.supply_upper == 0.0, "two edges are open");
      check(sms_chamber_flows(params, &edges, &ports, &flows) == SMS_OK, "flows by chamber");
      check(flows.drawn == edges.supply_lower && flows.lower.in == edges.supply_lower, "the supply feeds the lower");
      check(sms_chamber_spaces(params, state.extension, state.velocity, &lower, &upper) == SMS_OK, "room");
      check(lower.rate > 0.0 && upper.rate < 0.0, "one grows, one shrinks");
      check(
          sms_chamber_rate(params, (sms_chamber_law)chamber, &ports.lower, &lower, &flows.lower, &lower_rate) == SMS_OK,
          "lower chamber");
      check(
          sms_chamber_rate(params, (sms_chamber_law)chamber, &ports.upper, &upper, &flows.upper, &upper_rate) == SMS_OK,
          "upper chamber");
      check(close_to(lower_rate.pressure, rate.actuator.lower.pressure, 1e-9 * fabs(lower_rate.pressure)) &&
                close_to(upper_rate.pressure, rate.actuator.upper.pressure, 1e-9 * fabs(upper_rate.pressure)) &&
                close_to(lower_rate.temperature, rate.actuator.lower.temperature, 1e-9) &&
                close_to(upper_rate.temperature, rate.actuator.upper.temperature, 1e-9),
            "as in the plant, whose tubes are absent");
    }
  }

  portsf.supply.pressure = (float)ports.supply.pressure;
  portsf.lower.pressure = (float)ports.lower.pressure;
  portsf.upper.pressure = (float)ports.upper.pressure;
  portsf.exhaust.pressure = (float)ports.exhaust.pressure;
  portsf.supply.temperature = portsf.exhaust.temperature = (float)ports.supply.temperature;
  portsf.lower.temperature = (float)ports.lower.temperature;
  portsf.upper.temperature = (float)ports.upper.temperature;
  check(sms_valve_flowsf(paramsf, SMS_VALVE_CLASSIC, SMS_CHAMBER_ENERGY, 6.2f, &portsf, &edgesf) == SMS_OK, "in float");
  check(close_to((double)edgesf.supply_lower, edges.supply_lower, 1e-5 * edges.supply_lower), "float against double");
  check(close_to((double)sms_orifice_areaf(paramsf, 1e-3f), sms_orifice_area(params, 1e-3), 1e-10), "area in float");
  check(close_to(sms_iso_mass_flow(params, &(sms_iso_flow){sms_sonic_conductance(params, 2e-6), 0.5, 0.5},
                                   &ports.supply, &ports.exhaust),
                 sms_classic_mass_flow(params, 2e-6, &ports.supply, &ports.exhaust), 1e-12),
        "eq. 5.10: the two laws agree where the flow is choked");
  check(close_to(sms_air_mass(params, &ports.exhaust, 1e-3), 86.0 / (288.0 * 293.0), 1e-12), "a litre of air, in kg");
  check(close_to(sms_valve_opening(params, params->valve_centre), 0.0, 0.0), "closed at its centre");

  edges = untouched;
  check(sms_valve_flows(params, (sms_valve_law)3, SMS_CHAMBER_ENERGY, 6.0, &ports, &edges) == SMS_OUT_OF_RANGE,
        "valve");
  check(sms_valve_flows(params, SMS_VALVE_CLASSIC, (sms_chamber_law)2, 6.0, &ports, &edges) == SMS_OUT_OF_RANGE, "law");
  check(sms_chamber_rate(params, SMS_CHAMBER_ENERGY, &empty, &lower, &flows.lower, &lower_rate) == SMS_OUT_OF_RANGE,
        "a chamber without air");
  ports.lower.pressure = sqrt(-1.0);
  check(sms_valve_flows(params, SMS_VALVE_CLASSIC, SMS_CHAMBER_ENERGY, 6.0, &ports, &edges) == SMS_NOT_A_NUMBER, "NaN");
  check(memcmp(&edges, &untouched, sizeof edges) == 0, "and nothing was written");
}

/* Two controllers on a mass that moves as told, and the way out to the valve. */
static void check_controllers(const sms_params *params, const sms_paramsf *paramsf) {
  sms_pid_settings settings, wanted;
  sms_pid_settingsf settingsf;
  sms_pid pid = {0.0, {0.0, 0.0}}, other;
  sms_pidf pidf = {0.0f, {0.0f, 0.0f}};
  sms_state_feedback_settings gains;
  sms_state_feedback feedback;
  sms_dead_band dead_band;
  double output = 0.0, integral, slope;
  int i;

  check(sms_pid_from_params(params, &settings) == SMS_OK && sms_pid_from_paramsf(paramsf, &settingsf) == SMS_OK, "PID");
  check(settings.limit == 5.0 && settings.anti_windup == SMS_ANTI_WINDUP_NONE, "as published");
  for (i = 0; i < 100; ++i) {
    const double error = 0.02 * cos(0.1 * i);
    output = sms_pid_step(&settings, &pid, error);
    check(close_to((double)sms_pid_stepf(&settingsf, &pidf, (float)error), output, 1e-3), "float against double");
  }
  sms_pid_follow(&settings, &pid, 0.01, 1.25);
  check(close_to(sms_pid_step(&settings, &pid, 0.01), 1.25, 1e-12), "bumpless transfer");
  wanted = settings;
  wanted.proportional *= 2.0;
  other = pid;
  output = sms_pid_step(&settings, &other, 0.01);
  sms_pid_change_gains(&settings, &pid, &wanted);
  check(close_to(sms_pid_step(&settings, &pid, 0.01), output, 1e-12), "and other gains without a jump");

  settings.integral = 50.0;
  for (settings.anti_windup = 0; settings.anti_windup <= SMS_ANTI_WINDUP_CONDITIONAL_INTEGRATION;
       ++settings.anti_windup) {
    memset(&pid, 0, sizeof pid);
    for (i = 0; i < 5000; ++i) {
      output = sms_pid_step(&settings, &pid, 0.4);
    }
    integral = pid.integral;
    check(close_to(output, settings.limit, 0.03), "the output is at its limit");
    check((integral > settings.limit) == (settings.anti_windup == SMS_ANTI_WINDUP_NONE), "the integral is not");
  }

  check(sms_state_feedback_from_params(params, &gains) == SMS_OK, "state feedback");
  sms_state_feedback_at(0.2, &feedback);
  check(close_to(sms_state_feedback_step(&gains, &feedback, 0.21, 0.2), gains.loop * gains.position * 0.01, 1e-12),
        "at rest it is proportional");

  check(sms_dead_band_from_params(params, &dead_band) == SMS_OK, "dead band");
  check(close_to(sms_over_dead_band(&dead_band, 5.0), 5.0, 1e-12) && sms_over_dead_band(&dead_band, 0.0) == 0.0,
        "eq. 7.6: 5 V stay 5 V");
  slope = (sms_over_dead_band(&dead_band, 0.5 + 1e-5) - sms_over_dead_band(&dead_band, 0.5 - 1e-5)) / 2e-5;
  check(close_to(sms_dead_band_gain(&dead_band, 0.5), slope, 1e-6 * slope), "eq. 7.7 is the slope of eq. 7.5");
  check(sms_valve_command(&dead_band, 5.0, 9.0) == 10.0, "within 0 to 10 V");
}

int main(void) {
  sms_params params;
  sms_paramsf paramsf;

  check_abi();
  sms_params_default(&params);
  sms_params_defaultf(&paramsf);
  check_pneumatics(&params, &paramsf);
  check_controllers(&params, &paramsf);
  printf("%s\n", failures == 0 ? "ok" : "failed");
  return failures != 0;
}
