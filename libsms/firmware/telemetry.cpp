// What the controller sends: telemetry, answers, its log, and what was captured.
#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

enum { telemetry_period = 10, status_period = 50, heartbeat_period = 100, statistics_period = 200, capture_period = 2 };

// The six frames of measured and commanded signals, in the order of CaptureSignal.
enum { telemetry_frames = 6 };

Frame telemetry(const Application& app, int which) {
  const Long time = app.now & 0xFFFFu;
  const Sensed& s = app.sensed;
  const Leg* leg = app.leg;
  switch (which) {
    case 0:
      return pack(frame::Extension{s.extension[0], s.extension[1], s.extension[2], time});
    case 1:
      return pack(frame::Setpoint{leg[0].setpoint.position, leg[1].setpoint.position, leg[2].setpoint.position,
                                  app.target.alive, app.target.session, Long(app.target.result)});
    case 2:
      return pack(frame::ValveCommand{leg[0].command, leg[1].command, leg[2].command, s.supply_pressure});
    case 3:
      return pack(frame::ChamberPressureLower{s.pressure_lower[0], s.pressure_lower[1], s.pressure_lower[2], time});
    case 4:
      return pack(frame::ChamberPressureUpper{s.pressure_upper[0], s.pressure_upper[1], s.pressure_upper[2], time});
    default:
      return pack(frame::Attitude{app.pose.roll, app.pose.pitch, app.pose.height, time});
  }
}

// The raw value of a CaptureSignal: three to a frame, but the supply's is the fourth of the valve commands.
Word raw_signal(const Application& app, Word signal) {
  if (signal == 0) {
    return 0;
  }
  const bool supply = signal == Word(CaptureSignal::supply_pressure);
  const bool attitude = signal > Word(CaptureSignal::supply_pressure);
  const int place = signal - (attitude ? 2 : 1);
  const Frame f = telemetry(app, supply ? 2 : place / 3);
  const int low = 2 * (supply ? 3 : place % 3);
  return Word(f.octet[low] | (f.octet[low + 1] << 8));
}

void capture(Application& app) {
  Capture& c = app.capture;
  if (c.state == CaptureState::armed && is_triggered(c, raw_signal(app, c.signal[0]), all(app.faults) != 0u)) {
    c.state = CaptureState::running;
    c.start = app.now;
    note(app, EventKind::capture_triggered, 0);
  }
  if (c.state != CaptureState::running) {
    return;
  }
  if (c.wait > 0) {
    --c.wait;
    return;
  }
  const Word raw[captured_signals] = {raw_signal(app, c.signal[0]), raw_signal(app, c.signal[1]),
                                      raw_signal(app, c.signal[2])};
  take_sample(c, raw);
  if (c.state == CaptureState::complete) {
    note(app, EventKind::capture_complete, 0);
  }
}

void send_capture(Application& app, sms_hardware_outputs& out) {
  Capture& c = app.capture;
  if (app.now % statistics_period == 0u && c.state != CaptureState::idle) {
    put_frame(out, pack(frame::CaptureStatus{Long(c.state), Long(c.trigger), c.signal[0], c.signal[1], c.signal[2],
                                             c.period, c.samples, c.start & 0xFFFFu}));
  }
  if (app.now % capture_period == 0u && c.next_to_send < c.end_to_send) {
    const Word(&v)[captured_signals] = c.value[c.next_to_send];
    put_frame(out, pack(frame::CaptureData{c.next_to_send, v[0], v[1], v[2]}));
    ++c.next_to_send;
  }
}

void send_status(Application& app, sms_hardware_outputs& out) {
  const Long faults = all(app.faults);
  if (app.now % status_period != 0u && app.mode == app.told_mode && faults == app.told_faults) {
    return;
  }
  app.told_mode = app.mode;
  app.told_faults = faults;
  put_frame(out, pack(frame::Status{
                     Long(app.mode), Long(app.law), app.enabled ? 1u : 0u, Long(app.phase), app.limited.range ? 1u : 0u,
                     app.limited.rate ? 1u : 0u, app.limited.acceleration ? 1u : 0u, app.parameters.open ? 1u : 0u,
                     app.target.fresh ? 1u : 0u, faults, Long(app.first_fault), app.load, app.log.count & 0xFFu}));
  app.load = 0;
}

void send_log(Application& app, sms_hardware_outputs& out) {
  for (int i = 0; i < events_kept && out.frame_count < Word(SMS_FRAMES_OUT - telemetry_frames - 4); ++i) {
    const Event* e = next_to_send(app.log);
    if (e == nullptr) {
      return;
    }
    put_frame(out, pack(frame::Event{Long(e->kind), e->detail, Long(e->before), Long(e->after),
                                     (app.log.sent - 1u) & 0xFFu, e->time}));
  }
}

}  // namespace

bool put_frame(sms_hardware_outputs& out, const Frame& frame) {
  if (out.frame_count >= Word(SMS_FRAMES_OUT)) {
    return false;
  }
  out.frames[out.frame_count++] = frame;
  return true;
}

void send(Application& app, sms_hardware_outputs& out) {
  capture(app);
  send_log(app, out);
  send_status(app, out);
  if (app.now % heartbeat_period == 0u) {
    put_frame(out, pack(frame::ControllerHeartbeat{app.link.challenge, app.heartbeats & 0xFu, app.link.session,
                                                   parameter_hash(), Long(protocol_version), Long(app.reset_cause)}));
    app.heartbeats = Word(app.heartbeats + 1);
  }
  Authentication& a = app.authentication;
  if (a.on && (!a.told || app.now % heartbeat_period == 0u)) {
    put_frame(out, pack(frame::SessionNonce{Long(a.nonce & 0xFFFFFFFFu), Long(a.nonce >> 32)}));
    a.told = true;
  }
  const bool due = app.now % telemetry_period == 0u;
  for (int i = 0; i < telemetry_frames; ++i) {
    if (due || (i == 1 && app.target.waiting)) {
      put_frame(out, telemetry(app, i));
    }
  }
  app.target.waiting = false;
  if (app.now % statistics_period == 0u) {
    const CommandLink& link = app.link;
    put_frame(out, pack(frame::LinkStatistics{link.lost, link.corrupted, link.out_of_sequence, link.refused}));
  }
  send_capture(app, out);
}

}  // namespace firmware
}  // namespace sms
