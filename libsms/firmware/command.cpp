// Command frames, as they come in.
#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

void refuse(Application& app, Reason why) {
  app.link.refused = Word(app.link.refused + 1);
  if (why != Reason::none) {
    note(app, EventKind::mode_refused, Word(why));
  }
}

void obey(Application& app, const frame::ModeRequest& s) {
  if (s.acknowledge == 1u) {
    acknowledge(app);
  }
  if (s.control_law_request >= 1u && s.control_law_request <= 3u) {
    request_law(app, ControlLaw(int(s.control_law_request)));
  }
  request_mode(app, Mode(int(s.mode_request)), Reason::request);
}

bool is_whole(const frame::ModeRequest& s) {
  return s.mode_request <= 3u && s.control_law_request <= 3u && s.acknowledge <= 1u;
}

// A heartbeat keeps control, or takes it when nobody has it.
void heartbeat(Application& app, const frame::HostHeartbeat& s) {
  if (s.params_hash != parameter_hash() || s.protocol_version != Long(protocol_version)) {
    report(app.faults, Fault::params_hash_mismatch);
    refuse(app, Reason::none);
    return;
  }
  if (app.link.session == nobody) {
    take_control_by(app, Word(s.session));
    check_alive(app.link, 1, Word(s.alive), app.now);
  }
}

Frame confirmation(Operation operation, ParameterResult result, Long alive, Long session, Long index, float value) {
  return pack(frame::ParameterConfirm{Long(operation), Long(result), alive, session, index, value});
}

void begin(Application& app, const frame::ParameterBegin& s, sms_hardware_outputs& out) {
  const ParameterResult result = parameters_begin(app.parameters, write_access(app), s.params_hash, app.now);
  if (result == ParameterResult::wrong_hash) {
    report(app.faults, Fault::params_hash_mismatch);
  }
  put_frame(out, confirmation(Operation::begin, result, s.alive, s.session, 0u, 0.0f));
}

void write(Application& app, const frame::ParameterWrite& s, sms_hardware_outputs& out) {
  const int index = int(s.parameter_index);
  const ParameterResult result = parameters_write(app.parameters, write_access(app), index, s.parameter_value, app.now);
  const float* stored = app.parameters.open ? stored_parameter(app.parameters, index) : nullptr;
  const float value = stored != nullptr ? *stored : 0.0f;
  put_frame(out, confirmation(Operation::write, result, s.alive, s.session, s.parameter_index, value));
}

void commit(Application& app, const frame::ParameterCommit& s, sms_hardware_outputs& out) {
  ParameterResult result = ParameterResult::discarded;
  if (s.commit_action == Long(CommitAction::apply)) {
    result = commit_parameters(app, Word(s.commit_count));
  } else {
    app.parameters.open = false;
    note(app, EventKind::parameters_discarded, Word(result));
  }
  put_frame(out, confirmation(Operation::commit, result, s.alive, s.session, s.commit_count, 0.0f));
}

void read(Application& app, const frame::ParameterRead& s, sms_hardware_outputs& out) {
  const float* stored = parameter(app.parameters.active, int(s.parameter_index));
  const ParameterResult result = stored != nullptr ? ParameterResult::ok : ParameterResult::unknown_index;
  const float value = stored != nullptr ? *stored : 0.0f;
  put_frame(out, confirmation(Operation::read, result, s.alive, s.session, s.parameter_index, value));
}

bool is_signed_signal(Long signal) {
  return signal == Long(CaptureSignal::roll) || signal == Long(CaptureSignal::pitch);
}

void set_up(Application& app, const frame::CaptureSetup& s) {
  if (s.capture_signal_1 > 19u || s.capture_signal_2 > 19u || s.capture_signal_3 > 19u || s.capture_trigger > 4u ||
      s.capture_period == 0u) {
    refuse(app, Reason::none);
    return;
  }
  Capture& c = app.capture;
  c.state = CaptureState::armed;
  c.trigger = CaptureTrigger(int(s.capture_trigger));
  c.signal[0] = Word(s.capture_signal_1);
  c.signal[1] = Word(s.capture_signal_2);
  c.signal[2] = Word(s.capture_signal_3);
  c.period = Word(s.capture_period);
  c.level = Word(s.capture_level);
  c.level_is_signed = is_signed_signal(s.capture_signal_1);
  c.armed_before = false;
  c.samples = 0;
  c.wait = 0;
  c.next_to_send = 0;
  c.end_to_send = 0;
}

void read_out(Application& app, const frame::CaptureRead& s) {
  const Long end = s.capture_first + s.capture_count;
  app.capture.next_to_send = Word(s.capture_first);
  app.capture.end_to_send = Word(end < app.capture.samples ? end : app.capture.samples);
}

// Frames of the session in control, checked.
void dispatch(Application& app, const Frame& f, sms_hardware_outputs& out) {
  switch (f.identifier) {
    case frame::ModeRequest::identifier: {
      frame::ModeRequest s;
      return unpack(f, s) && is_whole(s) ? obey(app, s) : refuse(app, Reason::none);
    }
    case frame::HostHeartbeat::identifier: {
      frame::HostHeartbeat s;
      return unpack(f, s) ? heartbeat(app, s) : refuse(app, Reason::none);
    }
    case frame::AttitudeSetpoint::identifier: {
      frame::AttitudeSetpoint s;
      unpack(f, s);
      const float attitude[3] = {s.roll_setpoint, s.pitch_setpoint, s.height_setpoint};
      return take_attitude_setpoint(app, attitude, Word(s.alive), Word(s.session));
    }
    case frame::ExtensionSetpoint::identifier: {
      frame::ExtensionSetpoint s;
      unpack(f, s);
      const float extension[SMS_LEGS] = {s.extension_setpoint_1, s.extension_setpoint_2, s.extension_setpoint_3};
      return take_extension_setpoint(app, extension, Word(s.alive), Word(s.session));
    }
    case frame::ParameterBegin::identifier: {
      frame::ParameterBegin s;
      return unpack(f, s) ? begin(app, s, out) : refuse(app, Reason::none);
    }
    case frame::ParameterWrite::identifier: {
      frame::ParameterWrite s;
      unpack(f, s);
      return write(app, s, out);
    }
    case frame::ParameterCommit::identifier: {
      frame::ParameterCommit s;
      return unpack(f, s) && s.commit_action <= 1u ? commit(app, s, out) : refuse(app, Reason::none);
    }
    case frame::ParameterRead::identifier: {
      frame::ParameterRead s;
      return unpack(f, s) ? read(app, s, out) : refuse(app, Reason::none);
    }
    case frame::CaptureSetup::identifier: {
      frame::CaptureSetup s;
      return unpack(f, s) ? set_up(app, s) : refuse(app, Reason::none);
    }
    case frame::CaptureRead::identifier: {
      frame::CaptureRead s;
      return unpack(f, s) ? read_out(app, s) : refuse(app, Reason::none);
    }
    default:
      return;
  }
}

// Whoever asks for it, and whatever its counter says.
bool is_stop(const Frame& f) {
  frame::ModeRequest s;
  return f.identifier == Word(frame::ModeRequest::identifier) && unpack(f, s) && is_whole(s) &&
         s.mode_request == Long(Mode::disabled) && s.acknowledge == 0u && s.control_law_request == 0u;
}

// Counted and reported as a frame whose CRC is wrong, or whose counter is; the log has one a second, so that a flood does
// not wash it out.
void refuse_as_not_authentic(Application& app, Authenticity why) {
  CommandLink& link = app.link;
  Word& count = why == Authenticity::wrong_mac     ? link.corrupted
                : why == Authenticity::old_counter ? link.out_of_sequence
                                                   : link.refused;
  count = Word(count + 1);
  report(app.faults, Fault::link_disturbed);
  if (app.now - app.authentication.noted >= Long(refusal_period)) {
    app.authentication.noted = app.now;
    note(app, EventKind::not_authentic, Word(why));
  }
}

void receive_one(Application& app, const Frame& f, sms_hardware_outputs& out) {
  if (f.identifier == Word(frame::CommandAuthenticator::identifier)) {
    return app.authentication.on ? keep_authenticator(app.authentication, f, app.now) : void();
  }
  const int number = command_number(f.identifier);
  if (number < 0) {
    return;
  }
  CommandLink& link = app.link;
  const Word session = session_of(f);
  if (!check_frame(link, f)) {
    report(app.faults, Fault::link_disturbed);
    return;
  }
  if (app.authentication.on) {
    const Authenticity authenticity = check_authentic(app.authentication, f, app.now);
    if (authenticity != Authenticity::authentic) {
      return refuse_as_not_authentic(app, authenticity);
    }
  }
  if (is_stop(f)) {
    request_mode(app, Mode::disabled, Reason::request);
    return;
  }
  if (session == nobody || session == console_session) {
    refuse(app, Reason::none);
    return;
  }
  if (link.session == nobody) {
    const bool mode_request = f.identifier == Word(frame::ModeRequest::identifier);
    return f.identifier == Word(frame::HostHeartbeat::identifier)
               ? dispatch(app, f, out)
               : refuse(app, mode_request ? Reason::not_in_control : Reason::none);
  }
  if (session != link.session) {
    report(app.faults, Fault::second_host);
    refuse(app, Reason::none);
    return;
  }
  const bool setpoint = f.identifier == Word(frame::AttitudeSetpoint::identifier) ||
                        f.identifier == Word(frame::ExtensionSetpoint::identifier);
  if (setpoint && !is_plausible(link, f, app.target.fresh)) {
    postpone_setpoint(app, alive_of(f), session);
    refuse(app, Reason::none);
    return;
  }
  const Word lost = link.lost;
  const bool in_sequence = check_alive(link, number, alive_of(f), app.now);
  if (!in_sequence || link.lost != lost) {
    report(app.faults, Fault::link_disturbed);
  }
  if (in_sequence) {
    dispatch(app, f, out);
  }
}

}  // namespace

void receive(Application& app, const sms_hardware_inputs& in, sms_hardware_outputs& out) {
  app.authentication.checks = 0;
  for (int i = 0; i < SMS_FRAMES_IN && i < int(in.frame_count); ++i) {
    receive_one(app, in.frames[i], out);
  }
  if (app.parameters.open && app.now - app.parameters.used > Long(transaction_timeout)) {
    app.parameters.open = false;
    note(app, EventKind::parameters_discarded, Word(ParameterResult::timed_out));
  }
}

}  // namespace firmware
}  // namespace sms
