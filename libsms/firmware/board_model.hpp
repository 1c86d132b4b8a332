// What converters and pulse widths of a board make of a plant: for tests, the virtual rig and the processor in the loop.
// The inverse of sensing.hpp.
#pragma once

#include <cmath>

#include "hardware.h"
#include "settings.hpp"
#include "sms/limit.hpp"

namespace sms {
namespace firmware {

inline Word counts_of_extension(const Parameters& p, int leg, double extension) {
  const Settings& s = p.settings;
  const double retracted[SMS_LEGS] = {double(s.calibration_retracted_1), double(s.calibration_retracted_2),
                                      double(s.calibration_retracted_3)};
  const double extended[SMS_LEGS] = {double(s.calibration_extended_1), double(s.calibration_extended_2),
                                     double(s.calibration_extended_3)};
  const double n = retracted[leg] + (extended[leg] - retracted[leg]) * extension / double(p.machine.stroke);
  return Word(limited<double>(std::floor(n + 0.5), 0.0, 4095.0));
}

inline Word counts_of_pressure(const Parameters& p, double pressure) {
  const double n = 4095.0 * (pressure - double(p.machine.ambient_pressure)) / double(p.settings.pressure_sensor_range);
  return Word(limited<double>(std::floor(n + 0.5), 0.0, 4095.0));
}

// The mean voltage of the pulses.
inline double voltage_of(const Parameters& p, Word pulse_width) {
  return 10.0 * double(pulse_width) / double(p.machine.pwm_steps);
}

}  // namespace firmware
}  // namespace sms
