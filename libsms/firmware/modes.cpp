// Modes: what takes the platform out of one, who may ask for another, and who is in control.
#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

constexpr Long bits_between(Fault first, Fault last) { return (bit(last) << 1) - bit(first); }

// Those with which the platform cannot be controlled.
constexpr Long kStopping = bits_between(Fault::sensor_broken_1, Fault::valve_stuck_3) | bit(Fault::loop_overrun);

Long stopping(const Faults& f) { return (f.latched & kStopping) | (f.present & bit(Fault::supply_lost)); }

// Reason::none when nothing stands against it.
Reason why_not(const Application& app, Mode wanted) {
  const bool to_drive = is_driven(wanted);
  if (wanted == Mode::fault || (app.mode == Mode::fault && to_drive)) {
    return Reason::wrong_mode;
  }
  if (app.mode == Mode::fault && stopping(app.faults) != 0u) {
    return Reason::fault_present;
  }
  if (!to_drive) {
    return Reason::none;
  }
  if (!app.enabled) {
    return Reason::enable_open;
  }
  if ((stopping(app.faults) | (app.faults.latched & bit(Fault::watchdog_reset))) != 0u) {
    return Reason::fault_present;
  }
  if (wanted != Mode::levelling && app.mode != Mode::levelling) {
    return Reason::wrong_mode;
  }
  return wanted == Mode::tracking && !app.target.fresh ? Reason::no_setpoint : Reason::none;
}

}  // namespace

bool is_driven(Mode mode) { return mode == Mode::levelling || mode == Mode::tracking || mode == Mode::excitation; }

void enter(Application& app, Mode mode, Reason why) {
  const Event event = {app.now, EventKind::mode_changed, Word(why), app.mode, mode};
  note(app.log, event);
  app.mode = mode;
  app.sequencer = {0, 0};
  app.phase = TestPhase::level;
}

// What takes the platform out of its mode, the gravest first.
void watch_modes(Application& app) {
  if (!app.enabled && app.mode != Mode::disabled && app.mode != Mode::fault) {
    enter(app, Mode::disabled, Reason::enable_open);
  }
  if (is_driven(app.mode) && stopping(app.faults) != 0u) {
    enter(app, Mode::fault, Reason::fault);
  }
  const bool by_host = app.link.session != nobody && app.link.session != console_session;
  if (by_host && app.now - app.link.heard > Long(host_timeout)) {
    give_up_control(app);
    set(app.faults, Fault::host_gone, true);
    if (app.mode == Mode::tracking || app.mode == Mode::excitation) {
      enter(app, Mode::levelling, Reason::host_gone);
    }
  }
  app.target.fresh = app.target.fresh && app.now - app.target.when <= Long(setpoint_timeout);
  if (app.mode == Mode::tracking && by_host && !app.target.fresh) {
    set(app.faults, Fault::setpoint_timeout, true);
    enter(app, Mode::levelling, Reason::setpoint_timeout);
  }
}

// ---- requests ----

Reason request_mode(Application& app, Mode wanted, Reason why) {
  if (wanted == app.mode) {
    return Reason::none;
  }
  const Reason refused = why_not(app, wanted);
  if (refused != Reason::none) {
    note(app, EventKind::mode_refused, Word(refused));
    return refused;
  }
  enter(app, wanted, why);
  return Reason::none;
}

void request_law(Application& app, ControlLaw law) {
  if (law == app.law) {
    return;
  }
  app.law = law;
  app.blend = app.drive == Drive::closed_loop;
  note(app, EventKind::law_changed, Word(law));
}

void acknowledge(Application& app) {
  Long still = 0;
  for (int i = 0; i < SMS_LEGS; ++i) {
    still |= app.sensing.leg[i].broken >= samples_to_fault ? bit(of_leg(Fault::sensor_broken_1, i)) : 0u;
  }
  app.faults.latched &= still;
  if (app.mode == Mode::fault && stopping(app.faults) == 0u) {
    enter(app, Mode::disabled, Reason::request);
  }
}

// ---- who is in control ----

void take_control_by(Application& app, Word session) {
  take_control(app.link, session, app.now);
  app.parameters.open = false;
  app.target.fresh = false;
  set(app.faults, Fault::host_gone, false);
  note(app, EventKind::control_taken, session);
}

void give_up_control(Application& app) {
  note(app, EventKind::control_released, app.link.session);
  release_control(app.link, app.now);
  if (app.authentication.on) {
    draw_nonce(app.authentication);
  }
  app.parameters.open = false;
  app.target.fresh = false;
}

}  // namespace firmware
}  // namespace sms
