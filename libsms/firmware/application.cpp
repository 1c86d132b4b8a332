// A period of the application: sense, receive, watch, drive, send; and how it begins.
#include "application.hpp"

#include <new>

namespace sms {
namespace firmware {
namespace {

enum { overrun_window = 100 /* ms */, overruns_to_stop = 3 };

// ---- sensing and watching ----

void count_overruns(Application& app, Word missed) {
  if (app.now % overrun_window == 0u) {
    app.overruns = 0;
  }
  if (missed == 0) {
    return;
  }
  report(app.faults, Fault::loop_overrun);
  app.overruns = Word(app.overruns + missed);
  if (app.overruns >= overruns_to_stop) {
    raise(app.faults, Fault::loop_overrun);
  }
}

void watch_hardware(Application& app, const sms_hardware_inputs& in) {
  app.enabled = in.enabled != 0;
  app.load = in.load > app.load ? in.load : app.load;
  age(app.faults);
  set(app.faults, Fault::enable_open, !app.enabled);
  set(app.faults, Fault::bus_off, in.bus_off != 0);
  count_overruns(app, in.missed_ticks);
  const Parameters& p = app.parameters.active;
  sense(p, in, app.sensing, app.sensed, app.faults);
  set(app.faults, Fault::supply_lost, app.sensing.supply_low >= supply_time);
  if (is_driven(app.mode) && app.sensing.supply_low >= supply_time) {
    raise(app.faults, Fault::supply_lost);
  }
  for (int i = 0; i < SMS_LEGS; ++i) {
    const float voltage = app.drive == Drive::centre ? 0.0f : app.leg[i].command - app.derived.leg.centre;
    watch_stuck(p, app.sensed, i, voltage, app.now, app.sensing.leg[i], app.faults);
  }
}

void log_faults(Application& app) {
  const Long now = all(app.faults), changed = now ^ app.known_faults;
  for (int i = 1; changed != 0u && i <= fault_count; ++i) {
    const Fault fault = Fault(i);
    if ((changed & bit(fault)) != 0u) {
      note(app, (now & bit(fault)) != 0u ? EventKind::fault_raised : EventKind::fault_cleared, Word(i));
    }
  }
  if (app.first_fault == Fault::none || (now & bit(app.first_fault)) == 0u) {
    app.first_fault = first_of(now);
  }
  app.known_faults = now;
}

// ---- reset ----

// In place, without a second Application on the stack: zeros, and all parameters at their defaults.
void clear(Application& app) { new (&app) Application(); }

void start(Application& app, ResetCause cause, Word seed) {
  app.reset_cause = cause;
  app.law = ControlLaw::proportional;
  app.pose = app.derived.level_pose;
  app.target_pose = app.derived.level_pose;
  app.link.challenge = Word(seed & 0xFFu);
  for (int i = 0; i < SMS_LEGS; ++i) {
    app.target.extension[i] = app.derived.level_extension[i];
    app.target.from[i] = app.derived.level_extension[i];
    app.goal[i] = app.derived.level_extension[i];
    app.leg[i].command = app.derived.leg.centre;
  }
  if (cause == ResetCause::watchdog) {
    raise(app.faults, Fault::watchdog_reset);
  }
  note(app, EventKind::reset, Word(cause));
}

}  // namespace

void note(Application& app, EventKind kind, Word detail) {
  const Event event = {app.now, kind, detail, app.mode, app.mode};
  note(app.log, event);
}

void reset(Application& app, ResetCause cause, Word seed) {
  clear(app);
  derive(app.parameters.active,
         app.derived);  // the defaults are a machine that can be levelled: a test holds them to it
  start(app, cause, seed);
}

sms_status reset_with(Application& app, const Parameters& parameters, ResetCause cause, Word seed) {
  Derived derived;
  const sms_status status = derive(parameters, derived);
  if (status != SMS_OK) {
    return status;
  }
  clear(app);
  app.parameters.active = parameters;
  app.derived = derived;
  start(app, cause, seed);
  return SMS_OK;
}

void set_key(Application& app, const SipKey& key, Octets8 board_nonce) {
  set_key(app.authentication, key, board_nonce);
}

void tick(Application& app, const sms_hardware_inputs& in, sms_hardware_outputs& out) {
  out.frame_count = 0;
  out.character_count = 0;
  app.now += 1u + in.missed_ticks;
  watch_hardware(app, in);
  receive(app, in, out);
  read_console(app, in);
  if (app.target.waiting) {
    resolve_setpoint(app);
  }
  watch_modes(app);
  log_faults(app);
  drive_legs(app);
  follow_pose(app);
  bool sane = true;
  for (int i = 0; i < SMS_LEGS; ++i) {
    sane = sane && is_finite(app.leg[i].command);
    out.pulse_width[i] =
        sane ? pulse_width(app.derived.leg, app.leg[i]) : Word(0.5f * app.derived.leg.pulse_width.largest);
  }
  out.feed_watchdog = sane ? 1 : 0;
  send(app, out);
  write_console(app, out);
}

}  // namespace firmware
}  // namespace sms
