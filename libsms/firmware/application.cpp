// Modes, and what drives the valves in them.
#include "application.hpp"

#include <new>

namespace sms {
namespace firmware {
namespace {

enum { overrun_window = 100 /* ms */, overruns_to_stop = 3, kinematics_period = 10 /* ms */ };

constexpr Long bits_between(Fault first, Fault last) { return (bit(last) << 1) - bit(first); }

// Those with which the platform cannot be controlled.
constexpr Long kStopping = bits_between(Fault::sensor_broken_1, Fault::valve_stuck_3) | bit(Fault::loop_overrun);

Long stopping(const Faults& f) { return (f.latched & kStopping) | (f.present & bit(Fault::supply_lost)); }

bool is_driven(Mode mode) { return mode == Mode::levelling || mode == Mode::tracking || mode == Mode::excitation; }

void enter(Application& app, Mode mode, Reason why) {
  const Event event = {app.now, EventKind::mode_changed, Word(why), app.mode, mode};
  note(app.log, event);
  app.mode = mode;
  app.sequencer = {0, 0};
  app.phase = TestPhase::level;
}

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

// ---- set-points ----

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

// ---- driving ----

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

}  // namespace

// ---- parameters ----

namespace {

// What no bound of a single parameter can say: sensors that are calibrated between two places, and the period that the
// times of the application are counted in.
bool is_possible(const Parameters& p) {
  const Settings& s = p.settings;
  const float span[SMS_LEGS] = {s.calibration_extended_1 - s.calibration_retracted_1,
                                s.calibration_extended_2 - s.calibration_retracted_2,
                                s.calibration_extended_3 - s.calibration_retracted_3};
  bool possible = p.machine.control_period > 0.999e-3f && p.machine.control_period < 1.001e-3f;
  for (const float counts : span) {
    possible = possible && (counts > 100.0f || counts < -100.0f);
  }
  return possible;
}

// Of a number that is not negative.
unsigned long nearest(float x) {
  using std::floor;
  return static_cast<unsigned long>(floor(x + 0.5f));
}

}  // namespace

sms_status derive(const Parameters& p, Derived& derived) {
  if (!is_possible(p)) {
    return SMS_OUT_OF_RANGE;
  }
  Derived d;
  d.geometry = make_geometry(p.machine);
  Vec3<float> level;
  const sms_status status = inverse_kinematics(d.geometry, Vec3<float>(0.0f, 0.0f, p.settings.level_height),
                                               rest_pose(d.geometry), d.level_pose, level);
  if (status != SMS_OK) {
    return status;
  }
  d.leg = leg_settings(p);
  for (int i = 0; i < SMS_LEGS; ++i) {
    if (level(i) < d.leg.limits.lower || level(i) > d.leg.limits.upper) {
      return SMS_OUT_OF_WORKSPACE;
    }
    d.level_extension[i] = level(i);
  }
  const Settings& s = p.settings;
  d.excitation = {s.excitation_waveform > 0.5f ? Waveform::chirp : Waveform::sine,
                  {s.excitation_amplitude_1, s.excitation_amplitude_2, s.excitation_amplitude_3},
                  {s.excitation_frequency_1, s.excitation_frequency_2, s.excitation_frequency_3},
                  {s.excitation_offset_1, s.excitation_offset_2, s.excitation_offset_3},
                  s.excitation_last_frequency,
                  s.excitation_duration};
  d.excitation_closed_loop = s.excitation_closed_loop > 0.5f;
  const float rate = 1.0f / p.machine.control_period;
  d.sequence = {nearest(s.excitation_level_time * rate), nearest(s.excitation_duration * rate),
                nearest(s.excitation_cycles)};
  derived = d;
  return SMS_OK;
}

WriteAccess write_access(const Application& app) {
  const bool at_rest = app.mode == Mode::disabled || app.mode == Mode::fault;
  return at_rest ? WriteAccess::all : (app.mode == Mode::levelling ? WriteAccess::live : WriteAccess::none);
}

ParameterResult commit_parameters(Application& app, Word count) {
  ParameterStore& store = app.parameters;
  ParameterResult result = parameters_ready(store, write_access(app), count);
  if (result == ParameterResult::ok && derive(store.staged, app.derived) != SMS_OK) {
    result = ParameterResult::impossible_machine;
  }
  if (result == ParameterResult::ok) {
    store.active = store.staged;
  }
  note(app, result == ParameterResult::ok ? EventKind::parameters_applied : EventKind::parameters_discarded,
       Word(result));
  return result;
}

// ---- requests ----

void note(Application& app, EventKind kind, Word detail) {
  const Event event = {app.now, kind, detail, app.mode, app.mode};
  note(app.log, event);
}

namespace {

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
  app.parameters.open = false;
  app.target.fresh = false;
}

// ---- reset and tick ----

namespace {

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
