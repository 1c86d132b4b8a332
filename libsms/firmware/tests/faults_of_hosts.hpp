// Hosts that are gone, too many, of another params.def, or wrong in what they ask for.
#pragma once

#include "fault_case.hpp"

namespace bench {

inline Outcome bus_off() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  b.plugged_in = false;
  b.bend = [](sms_hardware_inputs& in) { in.bus_off = 1; };
  o.detected = b.until([&b] { return b.has(Fault::bus_off); }, 1000);
  b.run(110);
  o.reaction = o.reaction && b.mode() == Mode::levelling && b.has(Fault::setpoint_timeout);
  b.run(300);
  o.reaction = o.reaction && b.has(Fault::host_gone);
  b.plugged_in = true;
  b.bend = nullptr;
  b.run(300);
  o.back = !b.has(Fault::bus_off) && !b.has(Fault::host_gone) && b.track();
  o.within = b.within_limits();
  return o;
}

inline Outcome setpoints_gone() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  b.run(int(10 - b.k % 10) + 6);  // a set-point was just taken
  b.host.setpoints = false;
  o.detected = b.until([&b] { return b.has(Fault::setpoint_timeout); }, 1000);
  o.reaction = o.reaction && b.mode() == Mode::levelling;
  b.host.setpoints = true;
  b.run(20);
  b.host.request(Mode::tracking);
  b.run(5);
  o.back = b.mode() == Mode::tracking && !b.has(Fault::setpoint_timeout);
  o.within = b.within_limits();
  return o;
}

inline Outcome host_gone() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  while (b.k % 100 != 1) b.step();  // a heartbeat was just taken
  b.host.heartbeats = b.host.setpoints = false;
  o.detected = b.until([&b] { return b.has(Fault::host_gone); }, 1000);
  o.reaction = o.reaction && b.mode() == Mode::levelling && b.app->link.session == fw::nobody;
  b.run(8000);
  for (int i = 0; i < 3; ++i) {
    o.reaction = o.reaction && std::abs(b.app->leg[i].setpoint.position - b.app->derived.level_extension[i]) < 1e-5f;
  }
  b.host.heartbeats = b.host.setpoints = true;
  b.run(300);
  o.back = !b.has(Fault::host_gone) && b.track();
  o.within = b.within_limits();
  return o;
}

inline Outcome two_hosts() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  Host second;
  second.session = 9;
  second.challenge = b.host.challenge;
  b.others.push_back(second);
  while (b.k % 10 != 5) b.step();  // its first frame is the next one
  b.others[0].synchronised = true;
  o.detected = b.until([&b] { return b.has(Fault::second_host); }, 1000);
  b.others[0].request(Mode::levelling);
  b.run(2000);
  o.reaction = o.reaction && b.mode() == Mode::tracking && b.app->link.session == 5;
  b.others[0].request(Mode::disabled);  // anybody may stop
  b.run(2);
  o.reaction = o.reaction && b.mode() == Mode::disabled;
  b.others.clear();
  b.run(1001);
  o.back = !b.has(Fault::second_host) && b.track();
  o.within = b.within_limits();
  return o;
}

inline Outcome wrong_hash() {
  Bench b;
  Outcome o = {-1, true, false, false};
  b.host.hash ^= 1u;
  b.host.setpoints = false;
  while (!b.host.synchronised || b.k % 100 != 0) b.step();  // its first frame is the next one
  o.detected = b.until([&b] { return b.has(Fault::params_hash_mismatch); }, 1000);
  b.host.request(Mode::levelling);
  b.run(300);
  o.reaction = b.mode() == Mode::disabled && b.app->link.session == fw::nobody;
  b.host.hash ^= 1u;
  b.host.setpoints = true;
  b.run(1200);
  o.back = !b.has(Fault::params_hash_mismatch) && b.track();
  o.within = b.within_limits();
  return o;
}

// ---- what it asks for ----

inline Outcome setpoint_nan() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  const float before[3] = {b.app->target.extension[0], b.app->target.extension[1], b.app->target.extension[2]};
  b.host.setpoints = false;
  b.host.setpoint(sms::no_value(), 0.0f, 0.5f);
  o.detected = b.until([&b] { return b.has(Fault::setpoint_not_a_number); }, 100);
  o.reaction = o.reaction && b.mode() == Mode::tracking && b.app->target.result == sms::SetpointResult::not_a_number;
  for (int i = 0; i < 3; ++i) o.reaction = o.reaction && !(std::abs(b.app->target.extension[i] - before[i]) > 1e-3f);
  b.host.setpoints = true;
  b.run(1200);
  o.back = !b.has(Fault::setpoint_not_a_number) && b.mode() == Mode::tracking;
  o.within = b.within_limits();
  return o;
}

inline Outcome setpoint_out_of_workspace() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  b.host.setpoints = false;
  b.disturb = [&b](std::vector<Frame>& frames) {
    if (b.k % 10 == 5) frames.push_back(b.host.sealed(sms::frame::AttitudeSetpoint{0, 0, 0.3f, 0.3f, 0.6f}));
  };
  while (b.k % 10 != 5) b.step();
  o.detected = b.until([&b] { return b.has(Fault::setpoint_out_of_workspace); }, 100);
  b.run(3000);
  bool limited = false;
  for (const fw::Event& e : b.app->log.entry) limited = limited || e.kind == sms::EventKind::setpoint_limited;
  o.reaction =
      o.reaction && limited && b.mode() == Mode::tracking && b.app->target.result == sms::SetpointResult::limited;
  b.disturb = nullptr;
  b.host.setpoints = true;
  b.run(1200);
  o.back = !b.has(Fault::setpoint_out_of_workspace) && b.mode() == Mode::tracking;
  o.within = b.within_limits();
  return o;
}

inline sms::frame::ParameterConfirm confirmation(const Bench& b) {
  sms::frame::ParameterConfirm s = {};
  for (const Frame& f : b.heard) {
    if (f.identifier == Word(sms::frame::ParameterConfirm::identifier)) sms::unpack(f, s);
  }
  return s;
}

inline bool answered(Bench& b, sms::ParameterResult result) {
  for (int i = 0; i < 3; ++i) {
    b.step();
    const sms::frame::ParameterConfirm s = confirmation(b);
    if (s.confirm_operation != 0u) return s.confirm_result == sms::Long(result);
  }
  return false;
}

inline Outcome write_while_moving() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  const float before = b.app->parameters.active.machine.proportional_gain;
  b.host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash()});
  o.detected = b.until([&b] { return confirmation(b).confirm_result == sms::Long(sms::ParameterResult::moving); }, 10);
  b.host.send(sms::frame::ParameterWrite{0, 0, sms::Long(sms::index_of_proportional_gain), 10.0f});
  o.reaction = o.reaction && answered(b, sms::ParameterResult::no_transaction);
  b.host.send(sms::frame::ParameterCommit{0, 0, 0, 1});
  o.reaction = o.reaction && answered(b, sms::ParameterResult::no_transaction) && b.mode() == Mode::tracking &&
               !(b.app->parameters.active.machine.proportional_gain > before);
  b.host.request(Mode::disabled);
  b.run(5);
  b.host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash()});
  o.back = answered(b, sms::ParameterResult::ok);
  b.host.send(sms::frame::ParameterWrite{0, 0, sms::Long(sms::index_of_proportional_gain), 10.0f});
  o.back = o.back && answered(b, sms::ParameterResult::ok);
  b.host.send(sms::frame::ParameterCommit{0, 0, 0, 1});
  o.back = o.back && answered(b, sms::ParameterResult::ok) && b.app->derived.leg.pid.proportional > 9.9f && b.track();
  o.within = b.within_limits();
  return o;
}

}  // namespace bench
