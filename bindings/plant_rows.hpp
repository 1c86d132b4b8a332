// What a row of a plant's answer holds: its state, the terms of its equations, and what its loggers read.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "sms/simulate.hpp"

namespace sms_python {

// ---- state ----

inline void add_actuator_names(const std::string& leg, std::vector<std::string>& names) {
  for (const char* name :
       {"chamber_pressure_lower", "chamber_temperature_lower", "chamber_pressure_upper", "chamber_temperature_upper",
        "spool_voltage", "spool_rate", "drive_voltage", "drive_rate", "seal_deflection", "supply_pressure"}) {
    names.push_back(name + leg);
  }
}

inline std::vector<std::string> state_names(const sms::Bench<double>&) {
  std::vector<std::string> names = {"extension", "velocity"};
  add_actuator_names("", names);
  names.push_back("film_velocity");
  return names;
}

inline std::vector<std::string> state_names(const sms::Platform<double>&) {
  std::vector<std::string> names = {"roll", "pitch", "height", "roll_rate", "pitch_rate", "height_rate"};
  for (const char* leg : {"_1", "_2", "_3"}) {
    add_actuator_names(leg, names);
  }
  for (const char* leg : {"_1", "_2", "_3"}) {
    names.push_back(std::string("film_velocity") + leg);
  }
  return names;
}

inline std::vector<std::string> state_names(const sms::Tank<double>&) {
  return {"tank_pressure", "tank_temperature", "spool_voltage", "spool_rate", "supply_pressure"};
}

// A state as a row has it, and back: as it lies in memory but for the films of a platform's seals, which come last.
template <typename State>
constexpr int place_in_row(const State&, int number) {
  return number;
}

inline int place_in_row(const sms::PlatformState<double>&, int number) {
  constexpr int of_platform = 6, of_leg = sms::StateVector<sms::PlatformState<double>>::size / 3 - 2;
  const int leg = (number - of_platform) / of_leg, within = (number - of_platform) % of_leg;
  if (number < of_platform) {
    return number;
  }
  return within == of_leg - 1 ? of_platform + 3 * (of_leg - 1) + leg : of_platform + (of_leg - 1) * leg + within;
}

template <typename State>
void write_state(const State& state, double* row) {
  const auto x = sms::vector_of(state);
  for (int i = 0; i < int(x.size()); ++i) {
    row[place_in_row(state, i)] = x(i);
  }
}

template <typename State>
void read_state(const double* row, State& state) {
  auto x = sms::vector_of(state);
  for (int i = 0; i < int(x.size()); ++i) {
    x(i) = row[place_in_row(state, i)];
  }
}

// ---- terms ----

inline std::vector<std::string> term_names(const sms::Tank<double>&) { return {"mass_flow", "valve_command"}; }

inline std::vector<std::string> term_names(const sms::Bench<double>&) {
  return {"acceleration", "friction", "measured_extension", "valve_command"};
}

inline std::vector<std::string> term_names(const sms::Platform<double>&) {
  std::vector<std::string> names = {"yaw", "x", "y", "roll_acceleration", "pitch_acceleration", "height_acceleration"};
  for (const char* leg : {"_1", "_2", "_3"}) {
    for (const char* name : {"extension", "velocity", "friction", "measured_extension", "valve_command"}) {
      names.push_back(std::string(name) + leg);
    }
  }
  return names;
}

inline void write_terms(const sms::Simulation<sms::Tank<double>>& s, double* row) {
  const sms::TankTerms<double>& t = s.system.terms;
  *row++ = t.flow.in - t.flow.out;
  *row++ = s.command[0];
}

inline void write_terms(const sms::Simulation<sms::Bench<double>>& s, double* row) {
  const sms::BenchTerms<double>& t = s.system.terms;
  *row++ = t.balance.acceleration;
  *row++ = t.balance.friction;
  *row++ = s.measured[0];
  *row++ = s.command[0];
}

inline void write_terms(const sms::Simulation<sms::Platform<double>>& s, double* row) {
  const sms::PlatformTerms<double>& t = s.system.terms;
  for (const double value : {t.dynamics.pose.yaw, t.dynamics.pose.x, t.dynamics.pose.y}) {
    *row++ = value;
  }
  for (int i = 0; i < 3; ++i) {
    *row++ = t.acceleration(i);
  }
  for (int i = 0; i < 3; ++i) {
    for (const double value : {t.extension(i), t.velocity(i), t.friction(i), s.measured[i], s.command[i]}) {
      *row++ = value;
    }
  }
}

// ---- readings ----

// visit(name, leg, sensor, value, rate) for every sensor of the plant.
template <typename Plant, typename Visit>
void each_sensor(const sms::Simulation<Plant>& s, const Visit& visit) {
  s.sensors.each(s.plant, s.run.state, s.run.rate, s.system.terms, visit);
}

using DoubleSensor = sms::Sensor<double>;

template <typename Plant>
std::vector<std::string> reading_names(const sms::Simulation<Plant>& s) {
  std::vector<std::string> names;
  each_sensor(s, [&](const char* name, int leg, const DoubleSensor&, double, double) {
    names.push_back("reading_" + std::string(name) + (leg > 0 ? "_" + std::to_string(leg) : ""));
  });
  return names;
}

// By how many whole periods the clock of each reading's logger is late.
template <typename Plant>
std::vector<int> late_periods(const sms::Simulation<Plant>& s) {
  std::vector<int> late;
  double rest;
  each_sensor(s, [&](const char*, int, const DoubleSensor& sensor, double, double) {
    late.push_back(sms::whole_samples(s.period, sensor.errors().clock, &rest));
  });
  return late;
}

// As the loggers have them, but for whole periods of their clocks. noise: of the extension of each leg, m.
template <typename Plant>
void write_readings(const sms::Simulation<Plant>& s, const double* noise, double* row) {
  each_sensor(s, [&](const char* name, int leg, const DoubleSensor& sensor, double value, double rate) {
    double rest;
    sms::whole_samples(s.period, sensor.errors().clock, &rest);
    const bool of_extension = std::strcmp(name, "extension") == 0;
    *row++ = sensor.reading(value, rate, rest) + (of_extension ? noise[leg > 0 ? leg - 1 : 0] : 0.0);
  });
}

}  // namespace sms_python
