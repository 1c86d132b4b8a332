// What drives the valves: nothing, a test, or the control law along the set-points.
#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

enum { kinematics_period = 10 /* ms */ };

// One sample of the test; its end is the end of the mode.
SequencerStep test_step(Application& app) {
  const SequencerStep step = sequencer_step(app.derived.sequence, app.sequencer);
  if (step.phase == TestPhase::finished) {
    enter(app, Mode::levelling, Reason::excitation_finished);
  }
  return step;
}

// Open loop nothing else keeps the pistons from the ends of their stroke.
void watch_stroke(Application& app) {
  const SetpointLimits<float>& limits = app.derived.leg.limits;
  for (int i = 0; app.drive == Drive::open_loop && i < SMS_LEGS; ++i) {
    const float x = app.sensed.extension[i];
    if (app.mode == Mode::excitation && (x < limits.lower || x > limits.upper)) {
      enter(app, Mode::levelling, Reason::stroke_limit);
    }
  }
}

Drive drive_of(const Application& app) {
  if (!is_driven(app.mode)) {
    return Drive::centre;
  }
  const bool open =
      app.mode == Mode::excitation && app.phase == TestPhase::excite && !app.derived.excitation_closed_loop;
  return open ? Drive::open_loop : Drive::closed_loop;
}

float goal_of(const Application& app, int leg, float time) {
  if (app.mode == Mode::tracking) {
    return on_the_way(app, leg);
  }
  const float level = app.derived.level_extension[leg];
  return app.phase == TestPhase::excite ? level + excitation_at(app.derived.excitation, leg, time) : level;
}

// The command of one leg, V.
float command_of(Application& app, int i, const SetpointLimits<float>& limits, float time) {
  const LegSettings& s = app.derived.leg;
  Leg& leg = app.leg[i];
  const float extension = app.sensed.extension[i];
  if (app.drive != Drive::closed_loop) {
    restart_setpoint(s, leg, extension);
    app.goal[i] = extension;
    law_step(s, app.law, leg, extension);
    const float excitation = app.drive == Drive::open_loop ? excitation_at(app.derived.excitation, i, time) : 0.0f;
    return limited<float>(s.centre + excitation, 0.0f, 2.0f * command_limit<float>());
  }
  const float goal = goal_of(app, i, time), moving = (goal - app.goal[i]) / limits.period;
  app.goal[i] = goal;
  const SetpointLimited by =
      setpoint_step(limits, leg.setpoint, goal, limited<float>(moving, -limits.rate, limits.rate));
  app.limited = {app.limited.range || by.range, app.limited.rate || by.rate,
                 app.limited.acceleration || by.acceleration};
  return valve_command(s.dead_band, s.centre, law_step(s, app.law, leg, extension));
}

}  // namespace

void drive_legs(Application& app) {
  watch_stroke(app);
  float time = 0.0f;
  if (app.mode == Mode::excitation) {
    const SequencerStep step = test_step(app);
    app.phase = app.mode == Mode::excitation ? step.phase : TestPhase::level;
    time = float(step.sample) * app.parameters.active.machine.control_period;
  }
  const Drive wanted = drive_of(app);
  const bool cut = wanted == Drive::centre && (app.mode == Mode::fault || !app.enabled);
  const bool blend = (app.blend || wanted != app.drive) && !cut;
  app.drive = wanted;
  app.blend = false;
  SetpointLimits<float> limits = app.derived.leg.limits;
  if (app.mode != Mode::tracking && app.phase != TestPhase::excite) {
    limits.rate = app.parameters.active.settings.level_rate;
  }
  app.limited = {false, false, false};
  for (int i = 0; i < SMS_LEGS; ++i) {
    const float command = command_of(app, i, limits, time);
    app.leg[i].step = cut ? 0.0f : app.leg[i].step;
    drive(app.derived.leg, app.leg[i], command, blend);
  }
  const bool is_limited = app.limited.range && app.mode == Mode::tracking;
  if (is_limited && !app.limit_noted) {
    note(app, EventKind::setpoint_limited, Word(1));
  }
  app.limit_noted = is_limited;
}

void follow_pose(Application& app) {
  if (app.now % kinematics_period != 0u) {
    return;
  }
  const Vec3<float> extension(app.sensed.extension[0], app.sensed.extension[1], app.sensed.extension[2]);
  forward_kinematics(app.derived.geometry, extension, app.pose, app.pose);  // else as it was
}

}  // namespace firmware
}  // namespace sms
