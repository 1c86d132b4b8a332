// From counts to extensions and pressures, and what a sensor or a valve can do wrong (docs/faults.md).
//
// Position: two-point calibration, extension = stroke (n - n_retracted) / (n_extended - n_retracted), as in section
// 7.3.2. A reading outside the counts that the potentiometer can give is a broken wire, a step that no piston makes is
// a jump: either is replaced by the last good reading, and the third in a row is a fault.
//
// Stuck: while a command lets air in, something has to change. When extension and pressures both stand still the valve
// does not move; when only the extension does, the sensor. A piston that for the whole time runs against the command
// has a valve that is stuck open. A piston that rests on an end of its stroke is given the time to fill: there only
// standing pressures tell, and nothing does while the command holds it there.
#pragma once

#include "faults.hpp"
#include "hardware.h"
#include "settings.hpp"
#include "sms/limit.hpp"

namespace sms {
namespace firmware {

enum { samples_to_fault = 3 };

struct Sensed {
  float extension[SMS_LEGS];       // m
  float pressure_lower[SMS_LEGS];  // Pa, absolute
  float pressure_upper[SMS_LEGS];  // Pa, absolute
  float supply_pressure;           // Pa, absolute
};

// Since when a command has been on one side, and what has happened since.
struct StuckWatch {
  bool watching;
  bool upwards;
  Long since;  // ms
  float first, least, most;
  float pressure_least[2], pressure_most[2];
};

struct LegSensing {
  bool started;
  Word broken, jumped;  // readings in a row
  StuckWatch watch;
};

struct Sensing {
  LegSensing leg[SMS_LEGS];
  Word supply_low;  // ms
};

inline float calibrated_extension(const Parameters& p, int leg, Word counts) {
  const float retracted[SMS_LEGS] = {p.settings.calibration_retracted_1, p.settings.calibration_retracted_2,
                                     p.settings.calibration_retracted_3};
  const float extended[SMS_LEGS] = {p.settings.calibration_extended_1, p.settings.calibration_extended_2,
                                    p.settings.calibration_extended_3};
  return p.machine.stroke * (float(counts) - retracted[leg]) / (extended[leg] - retracted[leg]);
}

inline float converted_pressure(const Parameters& p, Word counts) {
  return p.machine.ambient_pressure + p.settings.pressure_sensor_range * float(counts) * (1.0f / 4095.0f);
}

inline void sense_extension(const Parameters& p, int leg, Word counts, LegSensing& state, float& extension,
                            Faults& faults) {
  using std::abs;
  const float reading = calibrated_extension(p, leg, counts);
  const float n = float(counts);
  const bool broken = n < p.settings.sensor_count_least || n > p.settings.sensor_count_most;
  const bool jumped = !broken && state.started && abs(reading - extension) > p.settings.sensor_jump;
  state.broken = broken ? Word(state.broken + (state.broken < samples_to_fault ? 1 : 0)) : Word(0);
  state.jumped = jumped ? Word(state.jumped + 1) : Word(0);
  if (state.broken >= samples_to_fault) {
    raise(faults, of_leg(Fault::sensor_broken_1, leg));
  }
  if (state.jumped >= samples_to_fault) {
    raise(faults, of_leg(Fault::sensor_jump_1, leg));
    state.jumped = 0;
  } else if (broken || jumped) {
    return;  // the last good one
  }
  extension = reading;
  state.started = true;
}

inline void watch_anew(StuckWatch& w, bool upwards, float extension, float lower, float upper, Long now) {
  w = {true, upwards, now, extension, extension, extension, {lower, upper}, {lower, upper}};
}

inline void stretch(float value, float& least, float& most) {
  least = value < least ? value : least;
  most = value > most ? value : most;
}

// After the commands of the last period; `voltage` is that at the valve less the centre's.
inline void watch_stuck(const Parameters& p, const Sensed& s, int leg, float voltage, Long now, LegSensing& state,
                        Faults& faults) {
  using std::abs;
  StuckWatch& w = state.watch;
  const float x = s.extension[leg], lower = s.pressure_lower[leg], upper = s.pressure_upper[leg];
  const bool low = x<p.settings.stroke_margin, high = x> p.machine.stroke - p.settings.stroke_margin;
  const bool against_end = (low && voltage < 0.0f) || (high && voltage > 0.0f);
  if (against_end || !(abs(voltage) > p.settings.stuck_command)) {
    w.watching = false;
    return;
  }
  if (!w.watching || w.upwards != (voltage > 0.0f)) {
    watch_anew(w, voltage > 0.0f, x, lower, upper, now);
    return;
  }
  stretch(x, w.least, w.most);
  stretch(lower, w.pressure_least[0], w.pressure_most[0]);
  stretch(upper, w.pressure_least[1], w.pressure_most[1]);
  if (float(now - w.since) < 1000.0f * p.settings.stuck_time) {
    return;
  }
  const float two_counts = 2.0f * p.machine.potentiometer_range / 4096.0f;
  const bool still = w.most - w.least < two_counts;
  const bool air_moves = w.pressure_most[0] - w.pressure_least[0] > p.settings.stuck_pressure ||
                         w.pressure_most[1] - w.pressure_least[1] > p.settings.stuck_pressure;
  const float run = w.upwards ? w.first - x : x - w.first;  // against the command
  const bool runs_away = !still && run > 10.0f * two_counts && run > 0.9f * (w.most - w.least);
  if (runs_away || (still && !air_moves)) {
    raise(faults, of_leg(Fault::valve_stuck_1, leg));
  } else if (still && !low && !high) {
    raise(faults, of_leg(Fault::sensor_stuck_1, leg));
  }
  watch_anew(w, w.upwards, x, lower, upper, now);
}

enum { supply_time = 50 /* ms */ };
enum { lower_chambers = SMS_LEGS, upper_chambers = 2 * SMS_LEGS, supply_channel = 3 * SMS_LEGS };  // in converted

// All sensors of one period. Supply lost: low for 50 ms.
inline void sense(const Parameters& p, const sms_hardware_inputs& in, Sensing& state, Sensed& s, Faults& faults) {
  for (int i = 0; i < SMS_LEGS; ++i) {
    sense_extension(p, i, in.converted[i], state.leg[i], s.extension[i], faults);
    s.pressure_lower[i] = converted_pressure(p, in.converted[lower_chambers + i]);
    s.pressure_upper[i] = converted_pressure(p, in.converted[upper_chambers + i]);
  }
  s.supply_pressure = converted_pressure(p, in.converted[supply_channel]);
  const bool low = s.supply_pressure < p.settings.supply_pressure_least;
  state.supply_low = low ? Word(state.supply_low + (state.supply_low < supply_time ? 1 : 0)) : Word(0);
}

}  // namespace firmware
}  // namespace sms
