#include "variables.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "describe.h"
#include "model.hpp"
#include "sms/params.hpp"

namespace sms_fmi {
namespace {

using sms::ParamIndex;

// ---- parameters ----

// The rows of params.def from one name to another, both included.
struct Rows {
  int first, last;
};

constexpr Rows kPiston[] = {
    {sms::index_of_ambient_pressure, sms::index_of_friction_lag},
    {sms::index_of_gas_constant, sms::index_of_tube_loss_factor},
    {sms::index_of_heat_share, sms::index_of_heat_share},
    {sms::index_of_bristle_stiffness, sms::index_of_breakaway_ratio},
    {sms::index_of_adc_bits, sms::index_of_command_delay},
    {sms::index_of_end_stop_stiffness, sms::index_of_cushion_damping},
};
constexpr Rows kMount[] = {{sms::index_of_frame_compliance, sms::index_of_backlash}};
constexpr Rows kMechanism[] = {{sms::index_of_base_joint_1_x, sms::index_of_panhard_friction}};
constexpr Rows kTank[] = {
    {sms::index_of_ambient_pressure, sms::index_of_ambient_pressure},
    {sms::index_of_gas_constant, sms::index_of_exhaust_flow_change},
    {sms::index_of_inflow_heat_ratio, sms::index_of_wall_temperature},
    {sms::index_of_chamber_leakage_lower, sms::index_of_chamber_leakage_index_lower},
    {sms::index_of_tube_length, sms::index_of_tank_wall_area},
    {sms::index_of_tank_initial_pressure, sms::index_of_tank_pressure_ceiling},
    {sms::index_of_thermocouple_time_constant, sms::index_of_heat_share},
    {sms::index_of_command_delay, sms::index_of_command_delay},
};
constexpr Rows kPeriod[] = {{sms::index_of_control_period, sms::index_of_command_offset}};
constexpr Rows kController[] = {{sms::index_of_control_period, sms::index_of_loop_gain}};

template <int N>
bool within(const Rows (&rows)[N], int index) {
  return std::any_of(rows, rows + N, [index](const Rows& r) { return index >= r.first && index <= r.last; });
}

// Whether a parameter is that of the sensor of one of these signals.
bool of_sensor(const std::string& name, const char* const* signals, int count) {
  for (int i = 0; i < count; ++i) {
    for (const char* error : {"sensor_gain_", "sensor_offset_", "sensor_linearity_", "sensor_lag_", "sensor_datum_"}) {
      if (name == std::string(error) + signals[i]) {
        return true;
      }
    }
  }
  return false;
}

constexpr const char* kLegSensors[] = {"extension", "chamber_pressure_lower", "chamber_pressure_upper",
                                       "supply_pressure"};
constexpr const char* kPoseSensors[] = {"roll", "pitch"};
constexpr const char* kTankSensors[] = {"tank_pressure", "tank_temperature", "supply_pressure"};

// What one actuator reads; of a platform each may have its own.
bool of_actuator(int index) {
  return within(kPiston, index) || within(kMount, index) || of_sensor(sms_param_describe(index)->name, kLegSensors, 4);
}

bool reads(Kind kind, int index) {
  const std::string name = sms_param_describe(index)->name;
  switch (kind) {
    case Kind::bench:
      return of_actuator(index) || within(kPeriod, index);
    case Kind::platform:
      return of_actuator(index) || within(kPeriod, index) || within(kMechanism, index) ||
             of_sensor(name, kPoseSensors, 2);
    case Kind::tank:
      return within(kTank, index) || within(kPeriod, index) || of_sensor(name, kTankSensors, 3);
    case Kind::controller:
      return within(kController, index);
  }
  return false;
}

Variable parameter(const std::string& name, const std::string& unit, const std::string& doc, double lower, double start,
                   double upper) {
  return {name, unit, doc, Type::real, Causality::parameter, false, start, lower, upper, ""};
}

Variable choice(const std::string& name, const std::string& choices, const std::string& doc) {
  const double count = 1.0 + double(std::count(choices.begin(), choices.end(), ' '));
  return {name, "1", doc, Type::enumeration, Causality::parameter, false, 1.0, 1.0, count, choices};
}

Variable option(const std::string& name, bool start, const std::string& doc) {
  return {name, "1", doc, Type::boolean, Causality::parameter, false, start ? 1.0 : 0.0, 0.0, 1.0, ""};
}

void add_rows_of_params(Kind kind, std::vector<Variable>& all) {
  for (int i = 0; i < sms_param_count(); ++i) {
    const sms_param_info& p = *sms_param_describe(i);
    if (reads(kind, i)) {
      all.push_back(parameter(p.name, p.unit, p.doc, p.lower, p.value, p.upper));
    }
  }
  for (int leg = 1; kind == Kind::platform && leg <= 3; ++leg) {
    const std::string number = std::to_string(leg);
    for (int i = 0; i < sms_param_count(); ++i) {
      const sms_param_info& p = *sms_param_describe(i);
      if (of_actuator(i)) {
        all.push_back(parameter("actuator_" + number + "." + p.name, p.unit,
                                "by how much that of actuator " + number + " is larger: " + p.doc, p.lower - p.value,
                                0.0, p.upper - p.value));
      }
    }
  }
}

void add_choices(Kind kind, std::vector<Variable>& all) {
  const bool piston = kind == Kind::bench || kind == Kind::platform;
  if (kind == Kind::controller) {
    all.push_back(choice("law", "pid state_feedback", "PID (eq. 7.4) or state feedback (Figure 8.3)"));
    all.push_back(option("compensated", true, "the output steps over the valve's dead band (eq. 7.5)"));
    return;
  }
  all.push_back(
      choice("valve_law", "iso_0_4_mpa iso_0_2_mpa classic", "table of the valve's flow, or the orifice law"));
  all.push_back(choice("chamber_law", "polytropic energy", "polytropic (eq. 4.30), or temperature a state"));
  if (piston) {
    all.push_back(choice("friction_law", "acceleration_dependent two_branch stribeck dahl lugre", "law of friction"));
    all.push_back(option("electronics", false, "converter, filters and pulse width of section 7.3.3"));
    all.push_back(
        parameter("start_mean_pressure", "Pa", "mean of both chambers at the beginning, absolute", 1e4, 333e3, 2e6));
  }
  if (kind == Kind::platform) {
    all.push_back(choice("masses", "corrected table platform lumped", "reading of the mass table"));
    all.push_back(parameter("start_roll", "rad", "roll at the beginning", -1.0, 0.0, 1.0));
    all.push_back(parameter("start_pitch", "rad", "pitch at the beginning", -1.0, 0.0, 1.0));
    all.push_back(parameter("start_height", "m", "height at the beginning", 0.0, 0.5, 20.0));
  }
  if (kind == Kind::bench) {
    all.push_back(parameter("start_extension", "m", "extension at the beginning", 0.0, 0.2, 5.0));
  }
  all.push_back(parameter("integrator_tolerance", "1",
                          "error of one step of the integrator over the range of each state", 1e-12, 1e-7, 1e-2));
}

// ---- inputs ----

Variable input(const std::string& name, const std::string& unit, const std::string& doc, double start) {
  return {name, unit, doc, Type::real, Causality::input, false, start, -1e300, 1e300, ""};
}

void add_inputs(Kind kind, std::vector<Variable>& all) {
  const double centre = sms::Params<double>().valve_centre;
  const std::string volts = "command at the valve, kept within 0 to 10 V";
  switch (kind) {
    case Kind::bench:
      all.push_back(input("valve_command", "V", volts, centre));
      all.push_back(input("load_force", "N", "on the rod, against extension", 0.0));
      return;
    case Kind::platform:
      for (const char* leg : {"1", "2", "3"}) {
        all.push_back(input(std::string("valve_command_") + leg, "V", volts, centre));
      }
      for (const char* axis : {"x", "y", "z"}) {
        all.push_back(input(std::string("force_") + axis, "N", "on the platform, world axes, z down", 0.0));
      }
      for (const char* axis : {"x", "y", "z"}) {
        all.push_back(input(std::string("moment_") + axis, "N m", "on the platform about its reference point", 0.0));
      }
      return;
    case Kind::tank:
      all.push_back(input("valve_command", "V", volts + "; above the centre the supply charges the tank", centre));
      return;
    case Kind::controller:
      all.push_back(input("setpoint", "m", "set-point of the extension", 0.0));
      all.push_back(input("measured_extension", "m", "reading of the position sensor", 0.0));
      return;
  }
}

// ---- outputs ----

struct Column {
  const char* name;
  const char* unit;
  const char* doc;
  bool output;
};

constexpr Column kColumns[] = {
    {"extension", "m", "extension of the rod, 0 retracted", true},
    {"velocity", "m/s", "velocity of the rod", true},
    {"acceleration", "m/s^2", "of the rod", false},
    {"friction", "N", "friction of the cylinder, positive against extension", false},
    {"measured_extension", "m", "what a controller takes for the extension", true},
    {"chamber_pressure_lower", "Pa", "pressure in the chamber that extends the rod, absolute", true},
    {"chamber_pressure_upper", "Pa", "pressure in the chamber that retracts it, absolute", true},
    {"chamber_temperature_lower", "K", "in the chamber that extends the rod; with the energy law", false},
    {"chamber_temperature_upper", "K", "in the chamber that retracts it; with the energy law", false},
    {"spool_voltage", "V", "position of the spool, as the command that would hold it there", false},
    {"spool_rate", "V/s", "of the spool", false},
    {"drive_voltage", "V", "behind the filter of the pulse width; with electronics", false},
    {"drive_rate", "V/s", "of that voltage", false},
    {"seal_deflection", "m", "of the seals before they slide", false},
    {"film_velocity", "m/s", "of the lubricant's film; with friction_lag", false},
    {"reservoir_pressure", "Pa", "pressure in the reservoir at the valve, absolute", true},
    {"supply_pressure", "Pa", "pressure in the reservoir at the valve, absolute", true},
    {"roll", "rad", "roll of the platform", true},
    {"pitch", "rad", "pitch of the platform", true},
    {"height", "m", "height of the platform's reference point", true},
    {"roll_rate", "rad/s", "roll rate of the platform", true},
    {"pitch_rate", "rad/s", "pitch rate of the platform", true},
    {"height_rate", "m/s", "rate of that height", true},
    {"yaw", "rad", "of the platform, which its rods let it have", false},
    {"x", "m", "of the reference point, which its rods let it have", false},
    {"y", "m", "of the reference point, which its rods let it have", false},
    {"roll_acceleration", "rad/s^2", "of the platform", false},
    {"pitch_acceleration", "rad/s^2", "of the platform", false},
    {"height_acceleration", "m/s^2", "of the platform", false},
    {"tank_pressure", "Pa", "pressure in the tank, absolute", true},
    {"tank_temperature", "K", "temperature of the air in the tank", true},
    {"mass_flow", "kg/s", "mass flow into the tank", true},
};

void add_column(const std::string& in_run, std::vector<Variable>& all) {
  const std::string column = name_of_column(in_run);
  const bool reading = column.compare(0, 8, "reading_") == 0;
  std::string base = reading ? column.substr(8) : column;
  const std::size_t end = base.size();
  const bool of_leg = end > 2 && base[end - 2] == '_' && base[end - 1] >= '1' && base[end - 1] <= '3';
  const std::string leg = of_leg ? std::string(", actuator ") + base[end - 1] : "";
  base = of_leg ? base.substr(0, end - 2) : base;
  for (const Column& known : kColumns) {
    if (base == known.name) {
      const bool output = reading || known.output;
      const std::string doc = (reading ? "reading of the sensor: " : "") + std::string(known.doc) + leg;
      const bool sampled = reading || base == "measured_extension";
      all.push_back({column, known.unit, doc, Type::real, output ? Causality::output : Causality::local, sampled, 0.0,
                     -1e300, 1e300, ""});
    }
  }
}

// ---- all of them ----

std::vector<Variable> make_variables(Kind kind) {
  std::vector<Variable> all;
  all.push_back({"time", "s", "time", Type::real, Causality::independent, false, 0.0, -1e300, 1e300, ""});
  add_inputs(kind, all);
  if (kind == Kind::controller) {
    all.push_back({"valve_command", "V", "command at the valve, of the sample at the beginning of the step", Type::real,
                   Causality::output, true, 0.0, -1e300, 1e300, ""});
  }
  for (const std::string& column : columns_of(kind)) {
    add_column(column, all);
  }
  add_choices(kind, all);
  add_rows_of_params(kind, all);
  return all;
}

// FNV-1a
std::string make_token(Kind kind) {
  std::uint64_t sum = 14695981039346656037ull;
  for (const Variable& v : variables_of(kind)) {
    for (const char c : v.name + "[" + v.unit + "]" + v.choices) {
      sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    }
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
  return std::string("sms ") + sms_version() + " " + kind_name(kind) + " " + text;
}

}  // namespace

const char* kind_name(Kind kind) {
  constexpr const char* names[] = {"bench", "platform", "tank", "controller"};
  return names[int(kind)];
}

const std::vector<Variable>& variables_of(Kind kind) {
  static const std::vector<Variable> all[] = {make_variables(Kind::bench), make_variables(Kind::platform),
                                              make_variables(Kind::tank), make_variables(Kind::controller)};
  return all[int(kind)];
}

int place_of(Kind kind, const std::string& name) {
  const std::vector<Variable>& all = variables_of(kind);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) {
      return int(i);
    }
  }
  return -1;
}

std::string name_of_column(const std::string& column) {
  const std::string supply = "supply_pressure";
  return column.compare(0, supply.size(), supply) == 0 ? "reservoir_pressure" + column.substr(supply.size()) : column;
}

const std::string& token_of(Kind kind) {
  static const std::string all[] = {make_token(Kind::bench), make_token(Kind::platform), make_token(Kind::tank),
                                    make_token(Kind::controller)};
  return all[int(kind)];
}

}  // namespace sms_fmi

extern "C" {

const char* sms_fmu_token(int kind) {
  const bool known = kind >= 0 && kind < sms_fmi::kind_count();
  return known ? sms_fmi::token_of(sms_fmi::Kind(kind)).c_str() : nullptr;
}

int sms_fmu_describe(int kind, int place, sms_fmu_variable* to) {
  if (kind < 0 || kind >= sms_fmi::kind_count()) {
    return 0;
  }
  const std::vector<sms_fmi::Variable>& all = sms_fmi::variables_of(sms_fmi::Kind(kind));
  if (place < 0 || place >= int(all.size())) {
    return 0;
  }
  const sms_fmi::Variable& v = all[std::size_t(place)];
  *to = {v.name.c_str(),   v.unit.c_str(),    v.doc.c_str(), v.choices.c_str(), int(v.type),
         int(v.causality), v.sampled ? 1 : 0, v.start,       v.lower,           v.upper};
  return 1;
}

}  // extern "C"
