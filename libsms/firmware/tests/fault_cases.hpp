// Every fault of docs/faults.md as a case: how it is made, when it is seen, what the platform does, how it comes back.
#pragma once

#include <string>

#include "bench.hpp"

namespace bench {

// What a case showed.
struct Outcome {
  int detected;   // ms from the cause to the report; -1: never
  bool reaction;  // the platform did what the table says
  bool back;      // and came back as the table says
  bool within;    // no set-point passed a limit, all the time
};

struct FaultCase {
  const char* name;
  const char* cause;
  int most;  // ms within which it is detected
  const char* reaction;
  const char* way_back;
  Outcome (*run)();
};

// ---- the bus ----

// 30 percent of all command frames for a minute; `what` changes the frames of a millisecond.
inline Outcome disturbed_minute(Bench& b, const std::function<bool(std::vector<Frame>&)>& what,
                                Word (*counter)(const fw::CommandLink&)) {
  Outcome o = {-1, b.track(), false, false};
  int since = 0, tracking = 0;
  bool began = false;
  b.disturb = [&](std::vector<Frame>& frames) { began = what(frames) || began; };
  for (int i = 0; i < 60000; ++i) {
    b.step();
    since += began && o.detected < 0 ? 1 : 0;
    if (o.detected < 0 && b.has(Fault::link_disturbed)) o.detected = since;
    o.reaction = o.reaction && (b.mode() == Mode::tracking || b.mode() == Mode::levelling);
    tracking += b.mode() == Mode::tracking ? 1 : 0;
    if (b.mode() == Mode::levelling && i % 100 == 0) b.host.request(Mode::tracking);
  }
  o.reaction = o.reaction && counter(b.app->link) > 0 && tracking > 57000;
  b.disturb = nullptr;
  b.run(1200);
  o.back = !b.has(Fault::link_disturbed) && b.track();
  o.within = b.within_limits();
  return o;
}

inline Outcome lost_frames() {
  Bench b;
  const auto lose = [&b](std::vector<Frame>& frames) {
    std::vector<Frame> kept;
    for (const Frame& f : frames) {
      if (!b.bad_luck()) kept.push_back(f);
    }
    const bool lost = kept.size() < frames.size();
    frames = kept;
    return lost;
  };
  return disturbed_minute(b, lose, [](const fw::CommandLink& l) { return l.lost; });
}

inline Outcome corrupted_frames() {
  Bench b;
  const auto corrupt = [&b](std::vector<Frame>& frames) {
    bool any = false;
    for (Frame& f : frames) {
      if (!b.bad_luck()) continue;
      const unsigned bit = unsigned(b.random() % 64u);
      f.octet[bit / 8] = Word(f.octet[bit / 8] ^ (1u << (bit % 8)));
      any = true;
    }
    return any;
  };
  return disturbed_minute(b, corrupt, [](const fw::CommandLink& l) { return l.corrupted; });
}

inline Outcome duplicated_frames() {
  Bench b;
  const auto duplicate = [&b](std::vector<Frame>& frames) {
    std::vector<Frame> twice;
    for (const Frame& f : frames) {
      twice.push_back(f);
      if (b.bad_luck()) twice.push_back(f);
    }
    const bool any = twice.size() > frames.size();
    frames = twice;
    return any;
  };
  return disturbed_minute(b, duplicate, [](const fw::CommandLink& l) { return l.out_of_sequence; });
}

// A frame is held back until `delay` ms later, so that the ones behind it overtake it.
struct Late {
  Frame frame;
  long due;
};

// Whether a frame arrives whose predecessor has not.
struct Sequence {
  Word last[fw::command_identifiers] = {};
  bool known[fw::command_identifiers] = {};
  bool broken_by(const Frame& f) {
    const int number = fw::command_number(f.identifier);
    const Word alive = fw::alive_of(f);
    const bool broken = known[number] && alive != Word((last[number] + 1u) & 0xFu);
    last[number] = alive;
    known[number] = true;
    return broken;
  }
};

inline Outcome late_frames(int least, int most) {
  Bench b;
  std::vector<Late> held;
  Sequence sequence;
  const auto hold = [&](std::vector<Frame>& frames) {
    std::vector<Frame> now;
    for (const Frame& f : frames) {
      if (b.bad_luck()) {
        held.push_back({f, b.k + least + long(b.random() % unsigned(most - least + 1))});
      } else {
        now.push_back(f);
      }
    }
    for (size_t i = 0; i < held.size();) {
      if (held[i].due <= b.k) {
        now.push_back(held[i].frame);
        held.erase(held.begin() + long(i));
      } else {
        ++i;
      }
    }
    bool overtaken = false;
    for (const Frame& f : now) overtaken = sequence.broken_by(f) || overtaken;
    frames = now;
    return overtaken;
  };
  return disturbed_minute(b, hold, [](const fw::CommandLink& l) { return l.out_of_sequence; });
}

inline Outcome reordered_frames() { return late_frames(11, 19); }
inline Outcome delayed_frames() { return late_frames(20, 80); }

// Recorded frames played onto the bus while the host is at work.
inline Outcome replayed_frames() {
  Bench b;
  std::vector<Frame> recorded;
  const bool ready = b.track();
  b.disturb = [&](std::vector<Frame>& frames) { recorded.insert(recorded.end(), frames.begin(), frames.end()); };
  b.run(3000);
  b.disturb = nullptr;
  size_t next = 0;
  const auto play = [&](std::vector<Frame>& frames) {
    if (b.k % 7 != 0 || frames.size() > 3) return false;
    frames.push_back(recorded[next++ % recorded.size()]);
    return true;
  };
  Outcome o = disturbed_minute(b, play, [](const fw::CommandLink& l) { return l.out_of_sequence; });
  o.reaction = o.reaction && ready;
  return o;
}

// The same recording once its host is gone: nothing of it is obeyed.
inline Outcome replayed_recording() {
  Bench b;
  std::vector<Frame> recorded;
  Outcome o = {-1, b.track(), false, false};
  b.disturb = [&](std::vector<Frame>& frames) { recorded.insert(recorded.end(), frames.begin(), frames.end()); };
  b.host.request(Mode::levelling);
  b.run(500);
  b.host.request(Mode::tracking);
  b.run(500);
  b.disturb = nullptr;
  b.host.heartbeats = b.host.setpoints = false;
  b.run(1500);  // levelling, control released
  size_t next = 0;
  b.disturb = [&](std::vector<Frame>& frames) {
    if (next < recorded.size()) frames.push_back(recorded[next++]);
  };
  o.detected = b.until([&b] { return b.has(Fault::link_disturbed); }, 100);
  for (size_t i = 0; i < recorded.size(); ++i) {
    b.step();
    o.reaction = o.reaction && b.mode() == Mode::levelling && b.app->link.session == fw::nobody;
  }
  b.disturb = nullptr;
  b.host.heartbeats = b.host.setpoints = true;
  b.run(300);
  o.back = b.track();
  o.within = b.within_limits();
  return o;
}

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

// ---- the machine ----

// A fault that stops: seen, valves at their centre, refused until acknowledged with the cause gone, then fine.
inline Outcome stops(Bench& b, Fault fault, int most, const std::function<void()>& mend) {
  Outcome o = {-1, true, false, false};
  o.detected = b.until([&b, fault] { return (b.app->faults.latched & fw::bit(fault)) != 0u; }, most);
  o.reaction = b.mode() == Mode::fault && b.at_centre();
  b.host.request(Mode::levelling);
  b.run(5);
  o.reaction = o.reaction && b.mode() == Mode::fault && b.at_centre();
  mend();
  b.run(200);
  o.reaction = o.reaction && b.mode() == Mode::fault;  // never by itself
  o.back = b.track() && !b.has(fault);
  o.within = b.within_limits();
  return o;
}

inline Outcome sensor_broken() {
  Bench b;
  const bool ready = b.track();
  b.bend = [](sms_hardware_inputs& in) { in.converted[1] = 0; };
  Outcome o = stops(b, Fault::sensor_broken_2, 100, [&b] { b.bend = nullptr; });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome sensor_jumping() {
  Bench b;
  const bool ready = b.track();
  b.bend = [](sms_hardware_inputs& in) { in.converted[2] = Word(in.converted[2] + 300); };
  Outcome o = stops(b, Fault::sensor_jump_3, 100, [&b] { b.bend = nullptr; });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome sensor_stuck() {
  Bench b;
  const bool ready = b.track();
  const Word counts = b.in.converted[0];
  b.bend = [counts](sms_hardware_inputs& in) { in.converted[0] = counts; };
  b.host.setpoints = false;
  b.disturb = [&b](std::vector<Frame>& frames) {
    if (b.k % 10 == 5) frames.push_back(b.host.sealed(sms::frame::AttitudeSetpoint{0, 0, 0.0f, 0.08f, 0.5f}));
  };
  // from the moment the command asks for air
  b.until([&b] { return std::abs(b.app->leg[0].command - 5.0f) > 0.9f; }, 3000);
  Outcome o = stops(b, Fault::sensor_stuck_1, 3000, [&b] {
    b.bend = nullptr;
    b.disturb = nullptr;
    b.host.setpoints = true;
  });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome valve_stuck() {
  Bench b;
  const bool ready = b.track();
  b.plant.valve_dead[0] = true;
  b.host.setpoints = false;
  b.disturb = [&b](std::vector<Frame>& frames) {
    if (b.k % 10 == 5) frames.push_back(b.host.sealed(sms::frame::AttitudeSetpoint{0, 0, 0.0f, 0.08f, 0.5f}));
  };
  b.until([&b] { return std::abs(b.app->leg[0].command - 5.0f) > 0.9f; }, 3000);
  Outcome o = stops(b, Fault::valve_stuck_1, 3000, [&b] {
    b.plant.valve_dead[0] = false;
    b.disturb = nullptr;
    b.host.setpoints = true;
  });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome valve_stuck_open() {
  Bench b;
  const bool ready = b.track();
  b.plant.valve_held[0] = 0.75;
  b.host.setpoints = false;
  b.disturb = [&b](std::vector<Frame>& frames) {
    if (b.k % 10 == 5) frames.push_back(b.host.sealed(sms::frame::AttitudeSetpoint{0, 0, 0.0f, -0.08f, 0.5f}));
  };
  b.until([&b] { return std::abs(b.app->leg[0].command - 5.0f) > 0.9f && b.app->leg[0].command < 5.0f; }, 3000);
  Outcome o = stops(b, Fault::valve_stuck_1, 3000, [&b] {
    b.plant.valve_held[0] = 0.0;
    b.disturb = nullptr;
    b.host.setpoints = true;
  });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome supply_lost() {
  Bench b;
  const bool ready = b.track();
  b.plant.supply = 100e3;
  Outcome o = stops(b, Fault::supply_lost, 1000, [&b] { b.plant.supply = 486e3; });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome enable_opened() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  b.bend = [](sms_hardware_inputs& in) { in.enabled = 0; };
  o.detected = b.until([&b] { return b.has(Fault::enable_open); }, 1000);
  o.reaction = o.reaction && b.mode() == Mode::disabled && b.at_centre();
  b.host.request(Mode::levelling);
  b.run(100);
  o.reaction = o.reaction && b.mode() == Mode::disabled;
  b.bend = nullptr;
  b.run(100);
  o.reaction = o.reaction && b.mode() == Mode::disabled;  // never by itself
  o.back = b.track();
  o.within = b.within_limits();
  return o;
}

// ---- the host's mistakes ----

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
  (void)limited;
  o.reaction = o.reaction && b.mode() == Mode::tracking && b.app->target.result == sms::SetpointResult::limited;
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

// ---- the controller itself ----

inline Outcome loop_overrun() {
  Bench b;
  const bool ready = b.track();
  b.bend = [&b](sms_hardware_inputs& in) { in.missed_ticks = b.k % 10 == 0 ? 1 : 0; };
  Outcome o = stops(b, Fault::loop_overrun, 100, [&b] {
    b.bend = nullptr;
    b.run(1100);
  });
  o.reaction = o.reaction && ready;
  return o;
}

inline Outcome single_overrun() {
  Bench b;
  Outcome o = {-1, b.track(), false, false};
  bool once = true;
  b.bend = [&once](sms_hardware_inputs& in) {
    in.missed_ticks = once ? 1 : 0;
    once = false;
  };
  o.detected = b.until([&b] { return b.has(Fault::loop_overrun); }, 100);
  b.run(500);
  o.reaction = o.reaction && b.mode() == Mode::tracking;
  b.run(700);
  o.back = !b.has(Fault::loop_overrun) && b.mode() == Mode::tracking;
  o.within = b.within_limits();
  return o;
}

inline Outcome watchdog() {
  Bench running;
  Outcome o = {-1, running.track(), false, false};
  running.app->leg[1].pid.integral = sms::no_value();  // what must never be, and now is
  running.app->law = sms::ControlLaw::pid;
  running.app->derived.leg.pid.integral = 1.0f;
  running.app->leg[1].setpoint.position = sms::no_value();
  running.app->leg[1].step = sms::no_value();
  o.detected = running.until([&running] { return running.out.feed_watchdog == 0; }, 100);
  Bench b(sms::ResetCause::watchdog);  // what the board does then
  b.step();
  o.reaction = o.reaction && b.has(Fault::watchdog_reset) && b.mode() == Mode::disabled && b.at_centre();
  b.run(200);
  b.host.request(Mode::levelling);
  b.run(5);
  o.reaction = o.reaction && b.mode() == Mode::disabled;
  o.back = b.track() && !b.has(Fault::watchdog_reset);
  o.within = b.within_limits();
  return o;
}

// ---- the table ----

inline const std::vector<FaultCase>& fault_cases() {
  static const std::vector<FaultCase> kCases = {
      {"frames lost", "30 percent of the command frames for a minute", 21,
       "goes on; after 100 ms without a set-point it levels", "by itself; when it has levelled, by a request",
       &lost_frames},
      {"frames corrupted", "one bit in 30 percent of them", 1, "refuses and counts them", "by itself",
       &corrupted_frames},
      {"frames duplicated", "30 percent come twice", 1, "refuses the second, counts it", "by itself",
       &duplicated_frames},
      {"frames reordered", "30 percent are overtaken by the next one", 1, "refuses the late ones, counts them",
       "by itself", &reordered_frames},
      {"frames delayed", "30 percent come 20 to 80 ms late", 1, "refuses the late ones", "by itself", &delayed_frames},
      {"frames replayed", "a recording of the same session between the host's own frames", 21,
       "refuses those out of sequence; the rest moves within the limits", "by itself", &replayed_frames},
      {"recording played", "a recording after its host is gone", 1, "refuses all of it: the challenge is another",
       "by itself", &replayed_recording},
      {"bus off", "the CAN controller withdraws", 1, "as for host gone", "bus on and heartbeats; then requests",
       &bus_off},
      {"set-points gone", "heartbeats, but no set-points", 101, "levels", "set-points and a request", &setpoints_gone},
      {"host gone", "nothing from the host", 301, "levels, releases control", "heartbeats; then requests", &host_gone},
      {"two hosts", "heartbeats and set-points of another session", 1,
       "the first stays in control; the second may only stop", "by itself, 1 s after its last frame", &two_hosts},
      {"wrong params.def", "a heartbeat with another hash", 1, "gives no control", "a host with the right hash",
       &wrong_hash},
      {"sensor broken", "a position sensor at 0 counts", 3, "closes all valves",
       "acknowledge when the sensor is good again", &sensor_broken},
      {"sensor jumping", "a position sensor 33 mm off at once", 3, "closes all valves", "acknowledge", &sensor_jumping},
      {"sensor stuck", "a position sensor stands still while pressures follow the command", 502, "closes all valves",
       "acknowledge", &sensor_stuck},
      {"valve stuck closed", "neither piston nor pressures follow the command", 502, "closes all valves", "acknowledge",
       &valve_stuck},
      {"valve stuck open", "the piston runs against the command", 1100, "closes all valves", "acknowledge",
       &valve_stuck_open},
      {"supply lost", "supply pressure at ambient", 50, "closes all valves", "acknowledge when the pressure is back",
       &supply_lost},
      {"enable switch opened", "the valves lose their power", 1, "disabled, commands at the centre",
       "close it, request", &enable_opened},
      {"set-point not a number", "a signal without a value", 1, "refuses it, keeps the last", "the next good one",
       &setpoint_nan},
      {"set-point out of the workspace", "0.3 rad roll and pitch at 0.6 m", 11,
       "goes as far as the stroke allows and says so", "the next good one", &setpoint_out_of_workspace},
      {"parameter write while moving", "a transaction while tracking", 1, "refuses it, nothing changes",
       "disable, then write", &write_while_moving},
      {"loop overrun, once", "one period missed", 1, "says so, goes on", "by itself, after 1 s", &single_overrun},
      {"loop overrun, again", "one period in ten missed", 31, "closes all valves", "acknowledge when it has ended",
       &loop_overrun},
      {"watchdog", "a state that is not a number", 1, "does not feed it; after the reset disabled", "acknowledge",
       &watchdog},
  };
  return kCases;
}

}  // namespace bench
