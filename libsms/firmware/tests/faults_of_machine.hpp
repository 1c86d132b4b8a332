// Sensors, valves, supply, enable switch, and the controller itself.
#pragma once

#include "fault_case.hpp"

namespace bench {

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

}  // namespace bench
