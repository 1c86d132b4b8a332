// The valve of one actuator driven by its record. A controller that is simulated (actuator_controller.hpp) has the same
// members.
#pragma once

#include "estimation/recorded.hpp"
#include "sms/plant_sensors.hpp"

namespace sms {
namespace estimation {

// `command_delay` late, straight from sample to sample or held.
template <typename S>
class RecordedCommand {
 public:
  // For a window from sample `first` on, in `steps` steps of h a sample. Parameters and command have to last.
  RecordedCommand(const Params<S>& p, const ActuatorLaws& laws, const Eigen::VectorXd& command, Hold hold,
                  double record_step, int first, int steps, const S& h)
      : p_(p),
        laws_(laws),
        voltage_(command, hold, steps, p.command_delay / S(record_step)),
        first_(first),
        steps_(steps),
        h_(h) {}

  // The spool where the window begins.
  void begin(ActuatorState<S>& actuator) { actuator.spool = voltage_.spool(p_, first_, h_); }
  // V, `at` counted in samples from the window's first.
  S at(double at) const { return voltage_.at(first_ + at); }
  // Step i after sample k of the window begins at this state, which its sensors see: a controller would have its say now.
  void step_begins(int k, int i, const BenchState<S>& y, const ActuatorSensors<S>&, BenchState<S>& rate) {
    if (voltage_.is_held()) {
      voltage_.begin_step(first_ + (k + double(i) / steps_));
      drive_rates(p_, laws_, y.actuator, at(0.0), rate.actuator);
    }
  }
  S* readings(int, S* out) const { return out; }

 private:
  const Params<S>& p_;
  ActuatorLaws laws_;
  RecordedVoltage<S> voltage_;
  int first_;
  int steps_;
  S h_;
};

}  // namespace estimation
}  // namespace sms
