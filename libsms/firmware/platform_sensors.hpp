// The pressure sensors of a simulated platform on the channels of the board's converters: for the virtual rig and the
// processor in the loop.
#pragma once

#include <cstring>

#include "sensing.hpp"
#include "sms/simulate.hpp"

namespace sms {
namespace firmware {

// What the pressure sensors of a simulated platform say, Pa absolute: use(channel of the converter, reading) for each.
template <typename Use>
void each_pressure(const Simulation<Platform<double>>& s, const Use& use) {
  const auto visit = [&use](const char* name, int leg, const Sensor<double>& sensor, double value, double rate) {
    const int channel = std::strcmp(name, "chamber_pressure_lower") == 0   ? lower_chambers + leg - 1
                        : std::strcmp(name, "chamber_pressure_upper") == 0 ? upper_chambers + leg - 1
                        : std::strcmp(name, "supply_pressure") == 0        ? int(supply_channel)
                                                                           : -1;
    if (channel >= 0) {
      use(channel, sensor.reading(value, rate));
    }
  };
  s.sensors.each(s.plant, s.run.state, s.run.rate, s.system.terms, visit);
}

}  // namespace firmware
}  // namespace sms
