// One actuator's position loop, sample by sample: extension in, command at the valve out (dissertation, sections 7.3.5
// and 8.2).
//
//   error -> PID, or state feedback -> dead-band compensation -> + offset -> 0 to 10 V
//
// or no loop at all: the excitation of an open-loop test goes to the valve as it is.
#pragma once

#include "sms/controller.hpp"

namespace sms {

enum class PositionControl : int { open_loop, pid, state_feedback };

template <typename S>
struct PositionLoopSettings {
  PositionControl control;
  PidSettings<S> pid;
  StateFeedbackSettings<S> feedback;
  DeadBand<S> dead_band;
  S offset;          // V, closes the valve
  bool compensated;  // steps over the dead band; off: the controller's output goes to the valve as it is
};

template <typename S>
PositionLoopSettings<S> position_loop_settings(const Params<S>& p, PositionControl control, bool compensated) {
  return {control,
          pid_settings(p),
          state_feedback_settings(p),
          make_dead_band(p.dead_band_step, p.dead_band_sharpness),
          p.command_offset,
          compensated};
}

template <typename S>
struct PositionLoop {
  Pid<S> pid;
  StateFeedback<S> feedback;
};

// At rest: the first sample sees no jump of the extension.
template <typename S>
PositionLoop<S> position_loop_at(const S& extension) {
  return {Pid<S>{}, state_feedback_at(extension)};
}

// V at the valve. The setpoint is an extension, m; in an open loop it is that command itself.
template <typename S>
S position_loop_step(const PositionLoopSettings<S>& settings, PositionLoop<S>& loop, const S& setpoint,
                     const S& extension) {
  if (settings.control == PositionControl::open_loop) {
    return limited<S>(setpoint, S(0), S(2) * command_limit<S>());
  }
  const S u = settings.control == PositionControl::pid
                  ? pid_step<S>(settings.pid, loop.pid, setpoint - extension)
                  : state_feedback_step(settings.feedback, loop.feedback, setpoint, extension);
  return settings.compensated ? valve_command(settings.dead_band, settings.offset, u)
                              : limited<S>(settings.offset + u, S(0), S(2) * command_limit<S>());
}

}  // namespace sms
