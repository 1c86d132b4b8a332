// The virtual rig: the controller's application over a simulated platform, one control period at a time. Host only.
//
//   extension, pressures -> sensors -> counts -> tick(application) -> pulse widths -> valves -> platform, one period
//                                     frames in         frames out
//
// It is a board (hardware.h) whose converters read a plant instead of a machine; the application is the firmware's, to
// the bit. Plant and controller have parameters of their own: an effect is switched on in the plant, and the controller
// does not know. Faults are what a board or a machine can do wrong; those of the bus are made on the bus.
//
// Nothing here reads a clock: how fast simulated time runs is the caller's matter.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "application.hpp"
#include "platform_sensors.hpp"

namespace sms {
namespace firmware {

// What can be made to go wrong; each until it is cleared.
enum class RigFault : int {
  sensor_broken,  // of one leg: the converter reads nothing
  sensor_stuck,   // of one leg: it reads what it read last
  sensor_jump,    // of one leg: it reads `amount` more, m
  valve_stuck,    // of one leg: the spool stays where it is
  supply_lost,    // the supply falls to ambient, with a time constant of `amount`, s
  enable_open,    // the enable switch is open: the valves have no power
  bus_off,        // no frame comes in or goes out, and the controller is told
  loop_overrun,   // every tick comes a period late
  hang            // the application stands still until the watchdog resets it
};
enum { rig_fault_count = 9 };

struct RigNoise {
  double position;  // counts, standard deviation
  double pressure;  // counts
};

class VirtualRig {
 public:
  using Plant = Platform<double>;
  enum { watchdog_time = 10 /* ms, hardware.h */, queue_length = 64 /* frames waiting for the application */ };

  VirtualRig(const Plant& plant, const RigNoise& noise, unsigned seed)
      : plant_(plant), board_(plant.params[0]), noise_(noise), random_(seed) {
    reset(app_, ResetCause::power_on, draw_seed());
  }
  VirtualRig(const VirtualRig&) = delete;
  VirtualRig& operator=(const VirtualRig&) = delete;

  // At rest at a height, level, air in the chambers at a mean pressure, Pa. step: s, of the integrator.
  sms_status begin(double height, double mean_pressure, double step) {
    PlatformState<double> state;
    const sms_status status = platform_at_rest(plant_.plant, Vec3<double>(0.0, 0.0, height), mean_pressure, state);
    if (status != SMS_OK) {
      return status;
    }
    PlatformInput<double> input{Vec3<double>::Zero(), {Vec3<double>::Zero(), Vec3<double>::Zero()}};
    for (int i = 0; i < SMS_LEGS; ++i) {
      input.command(i) = plant_.plant.params[i].valve_centre;
    }
    const sms_status begun =
        begin_simulation(state, input, board_, PositionControl::open_loop, false, true, 1e-6, plant_);
    plant_.fixed_step = step;
    return begun;
  }

  // Its controller obeys authentic commands only (authentication.hpp); a key of zeros: any.
  void set_key(const SipKey& key, Octets8 nonce) {
    key_ = key;
    nonce_ = nonce;
    firmware::set_key(app_, key_, nonce_);
  }

  // False when too many are waiting already: the frame is lost, as on a controller with full mailboxes.
  bool receive(const sms_frame& frame) {
    const bool taken = waiting_.size() < queue_length;
    if (taken) {
      waiting_.push_back(frame);
    }
    return taken;
  }

  // One control period; on any but SMS_OK the plant stands where it could still be computed.
  sms_status step() {
    fill_inputs();
    if (is_on(RigFault::hang)) {
      hang();
    } else {
      silence_ = 0;
      tick(app_, in_, out_);
    }
    for (int i = 0; i < SMS_LEGS; ++i) {
      plant_.command[i] = voltage(i);
    }
    if (is_on(RigFault::supply_lost)) {
      let_supply_fall();
    }
    return run_period(plant_);
  }

  // The frames that the last period sent; none while the bus is off.
  int frames_out() const { return is_on(RigFault::bus_off) ? 0 : int(out_.frame_count); }
  const sms_frame& frame_out(int i) const { return out_.frames[i]; }

  // leg from 0, where the fault is of one.
  void set_fault(RigFault fault, int leg, double amount) {
    fault_[int(fault)] = {true, leg, amount};
    if (fault == RigFault::valve_stuck) {
      stuck_voltage_ = plant_.run.state.actuator[leg].spool.value;
    }
  }
  void clear_fault(RigFault fault) {
    if (fault == RigFault::supply_lost && is_on(fault)) {
      for (int i = 0; i < SMS_LEGS; ++i) {
        plant_.run.state.actuator[i].supply_pressure = plant_.plant.params[i].supply_pressure;
      }
    }
    fault_[int(fault)].on = false;
  }
  bool is_on(RigFault fault) const { return fault_[int(fault)].on; }

  const Application& application() const { return app_; }
  const PlatformState<double>& state() const { return plant_.run.state; }
  const PlatformTerms<double>& terms() const { return plant_.system.terms; }
  double time() const { return plant_.run.time; }
  unsigned long evaluations() const { return plant_.run.evaluations; }

 private:
  struct Switched {
    bool on;
    int leg;
    double amount;
  };

  bool is_on(RigFault fault, int leg) const { return is_on(fault) && fault_[int(fault)].leg == leg; }

  Word draw_seed() { return Word(random_() & 0xFFFFu); }

  double noise(double deviation) { return deviation > 0.0 ? deviation * normal_(random_) : 0.0; }

  static Word counts(double value) { return Word(std::min(std::max(std::floor(value + 0.5), 0.0), kFull)); }

  void fill_inputs() {
    look(plant_);
    for (int i = 0; i < SMS_LEGS; ++i) {
      in_.converted[i] = position_counts(i);
    }
    const auto convert = [this](int channel, double reading) {
      in_.converted[channel] = pressure_counts(reading - board_.ambient_pressure);
    };
    each_pressure(plant_, convert);
    in_.enabled = is_on(RigFault::enable_open) ? 0 : 1;
    in_.bus_off = is_on(RigFault::bus_off) ? 1 : 0;
    in_.missed_ticks = is_on(RigFault::loop_overrun) ? 1 : 0;
    in_.load = 0;
    in_.character_count = 0;
    in_.frame_count = 0;
    if (is_on(RigFault::bus_off)) {
      waiting_.clear();
    }
    while (!waiting_.empty() && in_.frame_count < SMS_FRAMES_IN) {
      in_.frames[in_.frame_count++] = waiting_.front();
      waiting_.pop_front();
    }
  }

  Word position_counts(int leg) {
    const Converter<double>& c = plant_.electronics.position;
    const double amiss = is_on(RigFault::sensor_jump, leg) ? fault_[int(RigFault::sensor_jump)].amount : 0.0;
    const double read = measure(plant_, board_, leg, amiss + noise(noise_.position) * c.step);
    const Word now = counts((read + board_.potentiometer_margin) / c.step);
    if (is_on(RigFault::sensor_broken, leg)) {
      return 0;
    }
    if (!is_on(RigFault::sensor_stuck, leg)) {
      last_counts_[leg] = now;
    }
    return last_counts_[leg];
  }

  Word pressure_counts(double gauge) {
    return counts(gauge / double(Settings{}.pressure_sensor_range) * kFull + noise(noise_.pressure));
  }

  // Of the valve of one leg, from the pulse width; a valve without power goes to its centre.
  double voltage(int leg) const {
    if (is_on(RigFault::valve_stuck, leg)) {
      return stuck_voltage_;
    }
    if (is_on(RigFault::enable_open)) {
      return plant_.plant.params[leg].valve_centre;
    }
    return plant_.electronics.command.step * double(out_.pulse_width[leg]);
  }

  // Pulse widths stay as they are, nothing is sent; after 10 ms the watchdog bites, and the outputs go to the centre.
  void hang() {
    out_.frame_count = 0;
    out_.character_count = 0;
    if (++silence_ < watchdog_time) {
      return;
    }
    silence_ = 0;
    clear_fault(RigFault::hang);
    reset(app_, ResetCause::watchdog, draw_seed());
    firmware::set_key(app_, key_, ++nonce_);
    for (uint_least16_t& width : out_.pulse_width) {
      width = uint_least16_t(0.5 * board_.pwm_steps);
    }
  }

  void let_supply_fall() {
    const double kept = std::exp(-plant_.period / std::max(fault_[int(RigFault::supply_lost)].amount, 1e-3));
    for (ActuatorState<double>& a : plant_.run.state.actuator) {
      a.supply_pressure = board_.ambient_pressure + kept * (a.supply_pressure - board_.ambient_pressure);
    }
  }

  static constexpr double kFull = 4095.0;

  Simulation<Plant> plant_;
  Params<double> board_;  // of converters, filters and pulse width
  RigNoise noise_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  Application app_;
  SipKey key_{0, 0};
  Octets8 nonce_ = 0;  // the board's, another one with each reset
  sms_hardware_inputs in_{};
  sms_hardware_outputs out_{};
  std::deque<sms_frame> waiting_;
  Switched fault_[rig_fault_count]{};
  Word last_counts_[SMS_LEGS]{};
  double stuck_voltage_ = 0.0;
  int silence_ = 0;
};

}  // namespace firmware
}  // namespace sms
