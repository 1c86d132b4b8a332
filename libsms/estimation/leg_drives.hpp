// What drives the valves of three legs: of each leg what drives one (recorded_command.hpp, actuator_controller.hpp).
#pragma once

#include <memory>

#include "estimation/path_sensors.hpp"
#include "estimation/platform_rates.hpp"
#include "estimation/recorded_command.hpp"

namespace sms {
namespace estimation {

template <typename S>
struct LegDrives {
  std::unique_ptr<ValveDrive<S>> leg[3];

  // Spools and drives where the window begins.
  void begin(Pistons<S>& y) {
    for (int i = 0; i < 3; ++i) {
      leg[i]->begin(y.leg[i].actuator);
    }
  }
  // V, `at` counted in samples from the window's first.
  Vec3<S> at(double at) const { return {leg[0]->at(at), leg[1]->at(at), leg[2]->at(at)}; }
  // A step begins at this state, which the sensors see.
  void step_begins(const Step& step, const Pistons<S>& y, const PathSensors<S>& sensors, Pistons<S>& rate) {
    for (int j = 0; j < 3; ++j) {
      leg[j]->step_begins(step, y.leg[j], sensors.leg[j], rate.leg[j]);
    }
  }
  S* readings(int sample, S* out) const {
    for (const auto& drive : leg) {
      out = drive->readings(sample, out);
    }
    return out;
  }
};

}  // namespace estimation
}  // namespace sms
