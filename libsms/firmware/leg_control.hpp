// One leg: the control laws of controller.hpp, the limited set-point, and transitions without a jump.
//
// All laws run along, so that each can take over at any sample. What is left of a step (a law without memory cannot
// know the command before) is kept as an offset of the command that fades with blend_time.
#pragma once

#include "settings.hpp"
#include "sms/controller.hpp"
#include "sms/electronics.hpp"
#include "sms/setpoint.hpp"

namespace sms {
namespace firmware {

// What follows from the parameters for every leg; computed when they change.
struct LegSettings {
  PidSettings<float> proportional;
  PidSettings<float> pid;
  StateFeedbackSettings<float> feedback;
  DeadBand<float> dead_band;
  Converter<float> pulse_width;
  SetpointLimits<float> limits;  // the rate is the mode's
  float centre;                  // V
  float fade;                    // of the blended step, each period
};

inline LegSettings leg_settings(const Parameters& p) {
  LegSettings s;
  s.pid = pid_settings(p.machine);
  s.pid.anti_windup = p.settings.anti_windup > 0.5f ? AntiWindup::conditional_integration : AntiWindup::none;
  s.proportional = s.pid;
  s.proportional.integral = 0.0f;
  s.proportional.derivative = 0.0f;
  s.feedback = state_feedback_settings(p.machine);
  s.dead_band = make_dead_band(p.machine.dead_band_step, p.machine.dead_band_sharpness);
  s.pulse_width = command_converter(p.machine);
  s.limits = {p.settings.stroke_margin, p.machine.stroke - p.settings.stroke_margin, p.settings.setpoint_rate,
              p.settings.setpoint_acceleration, p.machine.control_period};
  s.centre = p.machine.command_offset;
  const float step = p.machine.control_period / p.settings.blend_time;
  s.fade = 1.0f - (step < 1.0f ? step : 1.0f);
  return s;
}

struct Leg {
  Pid<float> pid;
  StateFeedback<float> feedback;
  Setpoint<float> setpoint;
  float step;     // V, fading
  float command;  // at the valve, V
};

// The output of the law in charge, V around the centre; the others follow.
inline float law_step(const LegSettings& s, ControlLaw law, Leg& leg, float extension) {
  const float error = leg.setpoint.position - extension;
  const float by_feedback = state_feedback_step(s.feedback, leg.feedback, leg.setpoint.position, extension);
  if (law == ControlLaw::pid) {
    return pid_step(s.pid, leg.pid, error);
  }
  Pid<float> without_memory = {};
  const float by_error = pid_step(s.proportional, without_memory, error);
  const float output = law == ControlLaw::state_feedback ? by_feedback : by_error;
  pid_follow(s.pid, leg.pid, error, output);
  return output;
}

// The set-point starts where the piston is, at the rate it has.
inline void restart_setpoint(const LegSettings& s, Leg& leg, float extension) {
  leg.setpoint = {extension, limited<float>(leg.feedback.position.output, -s.limits.rate, s.limits.rate)};
}

// Towards a command; `blend` keeps the valve where it is and lets the difference fade.
inline void drive(const LegSettings& s, Leg& leg, float command, bool blend) {
  leg.step = blend ? leg.command - command : leg.step * s.fade;
  if (leg.step < 1.0e-4f && leg.step > -1.0e-4f) {
    leg.step = 0.0f;
  }
  leg.command = limited<float>(command + leg.step, 0.0f, 2.0f * command_limit<float>());
}

inline Word pulse_width(const LegSettings& s, const Leg& leg) { return Word(to_counts(s.pulse_width, leg.command)); }

}  // namespace firmware
}  // namespace sms
