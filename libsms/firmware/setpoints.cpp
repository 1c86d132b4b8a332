// Set-points: from what a host sends to where each piston shall be now.
#include "application.hpp"

namespace sms {
namespace firmware {
float on_the_way(const Application& app, int leg) {
  const Target& t = app.target;
  const Long passed = app.now - t.when;
  const float share = passed < Long(t.interval) ? float(passed) / float(t.interval) : 1.0f;
  return t.from[leg] + share * (t.extension[leg] - t.from[leg]);
}

void resolve_setpoint(Application& app) {
  Target& t = app.target;
  Vec3<float> extension(t.wanted[0], t.wanted[1], t.wanted[2]);
  if (t.attitude_waiting) {
    t.attitude_waiting = false;
    const Vec3<float> q = extension;
    const sms_status status = inverse_kinematics(app.derived.geometry, q, app.target_pose, app.target_pose, extension);
    t.result = status == SMS_OK ? SetpointResult::accepted : SetpointResult::out_of_workspace;
  }
  if (t.result == SetpointResult::accepted) {
    const SetpointLimits<float>& limits = app.derived.leg.limits;
    for (int i = 0; i < SMS_LEGS; ++i) {
      t.from[i] = on_the_way(app, i);
    }
    for (int i = 0; i < SMS_LEGS; ++i) {
      t.extension[i] = limited<float>(extension(i), limits.lower, limits.upper);
      if (t.extension[i] < extension(i) || t.extension[i] > extension(i)) {
        t.result = SetpointResult::limited;
      }
    }
    t.interval = Word(t.fresh && app.now > t.when ? app.now - t.when : 1u);  // at most setpoint_timeout
    t.fresh = true;
    t.when = app.now;
    set(app.faults, Fault::setpoint_timeout, false);
  }
  if (t.result == SetpointResult::not_a_number) {
    report(app.faults, Fault::setpoint_not_a_number);
  } else if (t.result != SetpointResult::accepted && t.result != SetpointResult::unconfirmed) {
    report(app.faults, Fault::setpoint_out_of_workspace);
  }
}

// ---- as they come in ----

void take_extension_setpoint(Application& app, const float (&extension)[SMS_LEGS], Word alive, Word session) {
  Target& t = app.target;
  const bool whole = is_finite(extension[0]) && is_finite(extension[1]) && is_finite(extension[2]);
  t.result = whole ? SetpointResult::accepted : SetpointResult::not_a_number;
  t.alive = alive;
  t.session = session;
  t.waiting = true;
  t.attitude_waiting = false;
  for (int i = 0; i < SMS_LEGS; ++i) {
    t.wanted[i] = extension[i];
  }
}

void take_attitude_setpoint(Application& app, const float (&attitude)[3], Word alive, Word session) {
  Target& t = app.target;
  t.attitude_waiting = is_finite(attitude[0]) && is_finite(attitude[1]) && is_finite(attitude[2]);
  t.result = SetpointResult::not_a_number;
  t.alive = alive;
  t.session = session;
  t.waiting = true;
  for (int i = 0; i < 3; ++i) {
    t.wanted[i] = attitude[i];
  }
}

void postpone_setpoint(Application& app, Word alive, Word session) {
  Target& t = app.target;
  if (!t.waiting) {
    t.result = SetpointResult::unconfirmed;
    t.alive = alive;
    t.session = session;
    t.waiting = true;
  }
}

}  // namespace firmware
}  // namespace sms
