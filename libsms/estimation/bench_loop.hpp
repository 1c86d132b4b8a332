// The rig "bench" in a closed loop as a plant of shooting.hpp: the controller is simulated with the machine
// (actuator_controller.hpp). The set-point is measured instead of the command; where the command is measured as well, it is
// held against what the controller makes of the measured extension.
#pragma once

#include "estimation/actuator_controller.hpp"
#include "estimation/bench_plant.hpp"

namespace sms {
namespace estimation {

class BenchLoopPlant : public BenchPlant {
 public:
  static constexpr int kStart = BenchPlant::kStart + 1;  // and the controller's integral, V
  static constexpr int kFelt = kStart;
  static constexpr int kHidden = BenchPlant::kHidden + 1;  // and a voltage at the controller's output

  // said: the controller as declared, which tells where searches for the integral begin. std::invalid_argument for
  // arrays of different lengths, numbers that are not finite, or a period that does not fit the record's step.
  BenchLoopPlant(std::vector<BenchRecord> records, const BenchNoise& noise, double command_noise,
                 const ActuatorLaws& laws, const ControlLaw& law, const Params<double>& said, double longest_step);

  static double start_scale(int k) { return k < BenchPlant::kStart ? BenchPlant::start_scale(k) : 1.0; }
  int channels(int record) const { return BenchPlant::channels(record) + (of(record).command.size() > 0 ? 1 : 0); }
  Eigen::VectorXd guess(int record, int first) const;
  static bool feels_all(const Params<double>&, const Window&) { return true; }

  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                const Hidden<S>& hidden = {}) const;

 private:
  ControlRecord control_record(int record) const {
    const BenchRecord& r = of(record);
    return {r.step, r.setpoint, r.extension, r.command};
  }

  double command_noise_;
  ControlLaw law_;
  std::vector<Eigen::VectorXd> integral_;  // of each record: before each sample of the controller as declared, V
  double said_period_;
  double longest_step_;  // s
};

template <typename S>
void BenchLoopPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual,
                              const Hidden<S>& hidden) const {
  const ControlGrid grid = control_grid(step(window.record), value_of(params.control_period), longest_step_);
  const HiddenInputs<S> at_output = HiddenInputs<S>(hidden, window.samples).from(BenchPlant::kHidden);
  const DriveOf<S> controlled = [&](const Bench<S>& bench, const S& h) {
    return std::make_unique<SimulatedController<S>>(bench.params, laws(), control_record(window.record), window, law_,
                                                    grid, h, start[BenchPlant::kStart], at_output, command_noise_);
  };
  simulate_driven(params, window, SampleSteps(grid.steps), controlled, start, residual, hidden);
}

// Compiled in bench_loop.cpp.
extern SMS_PLANT_SIMULATES(BenchLoopPlant, double);
extern SMS_PLANT_SIMULATES(BenchLoopPlant, ParameterJet);
extern template class ShootingProblem<BenchLoopPlant>;

}  // namespace estimation
}  // namespace sms
