// What drives the valve of one actuator over a window: its record, or a controller that is simulated
// (actuator_controller.hpp). A plant is compiled once for both.
#pragma once

#include "estimation/recorded.hpp"
#include "estimation/shooting.hpp"
#include "sms/plant_sensors.hpp"

namespace sms {
namespace estimation {

template <typename S>
class ValveDrive {
 public:
  virtual ~ValveDrive() = default;
  // Sets spool and drive where the window begins.
  virtual void begin(ActuatorState<S>& actuator) = 0;
  // V, `at` counted in samples from the window's first.
  virtual S at(double at) const = 0;
  // A step begins at this state, which its sensors see: a controller has its say now. Samples are the window's.
  virtual void step_begins(const Step& step, const BenchState<S>& y, const ActuatorSensors<S>& sensors,
                           BenchState<S>& rate) = 0;
  // Writes the whitened errors of what it reads itself and returns where the next begin.
  virtual S* readings(int sample, S* out) const = 0;
};

// `delay_to_chamber` late, straight from sample to sample or held.
template <typename S>
class RecordedCommand final : public ValveDrive<S> {
 public:
  // For a window from sample `first` on; the spool is run up in `parts` steps of h a sample. further: as
  // CommandJumps has it. Parameters, command and ahead have to last.
  RecordedCommand(const Params<S>& p, const ActuatorLaws& laws, const Eigen::VectorXd& command,
                  const Eigen::VectorXd& ahead, Hold hold, double record_step, const Window& window, int parts,
                  const S& h, const S* further = nullptr)
      : p_(p),
        laws_(laws),
        voltage_(command, hold, delay_to_chamber(p) / S(record_step),
                 {command, ahead, window.first, window.samples, record_step, further}, staircase_lag(p, record_step)),
        first_(window.first),
        parts_(parts),
        h_(h) {}

  void begin(ActuatorState<S>& actuator) override { actuator.spool = voltage_.spool(p_, first_, parts_, h_); }
  S at(double at) const override { return voltage_.at(first_ + at); }
  void step_begins(const Step& step, const BenchState<S>& y, const ActuatorSensors<S>&, BenchState<S>& rate) override {
    if (voltage_.begin_step(first_ + step.begins(), step.pace)) {
      drive_rates(p_, laws_, y.actuator, at(step.begins()), rate.actuator);
    }
  }
  S* readings(int, S* out) const override { return out; }

 private:
  const Params<S>& p_;
  ActuatorLaws laws_;
  RecordedVoltage<S> voltage_;
  int first_;
  int parts_;
  S h_;
};

}  // namespace estimation
}  // namespace sms
