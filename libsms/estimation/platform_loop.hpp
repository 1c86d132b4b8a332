// The rig "platform" in a closed loop as a plant of shooting.hpp: the controller of each leg is simulated with the machine
// (actuator_controller.hpp). The set-points of the three extensions are measured instead of the commands: those of a pose
// are its inverse kinematics. Where the commands are measured as well, they are held against what the controllers make of
// the measured extensions.
//
// The gains may be those of one leg, as any other parameter (leg_params.hpp); the period is common.
#pragma once

#include "estimation/actuator_controller.hpp"
#include "estimation/platform_plant.hpp"

namespace sms {
namespace estimation {

class PlatformLoopPlant : public PlatformPlant {
 public:
  static constexpr int kStart = PlatformPlant::kStart + 3;  // and the integral of each controller, V
  static constexpr int kFelt = kStart;
  static constexpr int kHidden = PlatformPlant::kHidden + 3;  // and a voltage at each controller's output

  // said: the machine as declared, whose controllers tell where searches for the integrals begin.
  // std::invalid_argument as PlatformPlant, and for a period that does not fit the record's step.
  PlatformLoopPlant(std::vector<PlatformRecord> records, const PlatformNoise& noise, const Vec3<double>& command_noise,
                    const ActuatorLaws& laws, const ControlLaw& law, const LegParams<double>& said, MassModel masses,
                    double longest_step);

  static double start_scale(int k) { return k < PlatformPlant::kStart ? PlatformPlant::start_scale(k) : 1.0; }
  int channels(int record) const {
    return PlatformPlant::channels(record) + (of(record).command[0].size() > 0 ? 3 : 0);
  }
  Eigen::VectorXd guess(int record, int first) const;
  static bool feels_all(const LegParams<double>&, const Window&) { return true; }

  template <typename S>
  void simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                const Hidden<S>& hidden = {}) const;

 private:
  ControlRecord control_record(int record, int leg) const {
    const PlatformRecord& r = of(record);
    const std::size_t i = static_cast<std::size_t>(leg);
    return {r.step, r.setpoint[i], r.extension[i], r.command[i]};
  }

  Vec3<double> command_noise_;
  ControlLaw law_;
  std::vector<LegSignals> integral_;  // of each record: before each sample of the controllers as declared, V
  double said_period_;
  double longest_step_;  // s
};

template <typename S>
void PlatformLoopPlant::simulate(const LegParams<S>& params, const Window& window, const S* start, S* residual,
                                 const Hidden<S>& hidden) const {
  const ControlGrid grid = control_grid(step(window.record), value_of(params.control_period), longest_step_);
  const DrivesOf<S> controlled = [&](const LegMachines<S>& machines, const S& h) {
    const auto of_leg = [&](int i) {
      const HiddenInputs<S> at_output = HiddenInputs<S>(hidden, window.samples).from(PlatformPlant::kHidden + i);
      return std::make_unique<SimulatedController<S>>(machines.leg[i], laws(), control_record(window.record, i), window,
                                                      law_, grid, h, start[PlatformPlant::kStart + i], at_output,
                                                      command_noise_(i));
    };
    return LegDrives<S>{{of_leg(0), of_leg(1), of_leg(2)}};
  };
  simulate_driven(params, window, SampleSteps(grid.steps), controlled, start, residual, hidden);
}

// Compiled in platform_loop.cpp.
extern SMS_PLANT_SIMULATES(PlatformLoopPlant, double);
extern SMS_PLANT_SIMULATES(PlatformLoopPlant, ParameterJet);
extern template class ShootingProblem<PlatformLoopPlant>;

}  // namespace estimation
}  // namespace sms
