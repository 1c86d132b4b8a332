// The valve of one actuator driven by its record. A controller that is simulated (actuator_controller.hpp) has the same
// members.
#pragma once

#include "estimation/actuator_sensors.hpp"

namespace sms {
namespace estimation {

// Straight from sample to sample, `command_delay` late.
template <typename S>
class RecordedCommand {
 public:
  // For a window from sample `first` on, in `steps` steps of h a sample. Parameters and command have to last.
  RecordedCommand(const Params<S>& p, const Eigen::VectorXd& command, double record_step, int first, int steps,
                  const S& h)
      : p_(p), command_(command), first_(first), steps_(steps), h_(h), late_(p.command_delay / S(record_step)) {}

  // The spool where the window begins.
  void begin(ActuatorState<S>& actuator) const {
    actuator.spool = detail::spool_at(p_, command_, first_, steps_, h_, late_);
  }
  // V, `at` counted in samples from the window's first.
  S at(double at) const { return detail::command_at<S>(command_, S(first_ + at) - late_); }
  // A step begins at this state, which its sensors see: a controller would have its say now.
  void step_begins(int, int, const BenchState<S>&, const ActuatorSensors<S>&, BenchState<S>&) const {}
  S* readings(int, S* out) const { return out; }

 private:
  const Params<S>& p_;
  const Eigen::VectorXd& command_;
  int first_;
  int steps_;
  S h_, late_;
};

}  // namespace estimation
}  // namespace sms
