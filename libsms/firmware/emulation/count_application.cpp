// What the application costs on a controller, function by function: each is called a thousand times with other inputs,
// and the instructions of a call are printed, least; mean; most. The first line says how the library was built.
#include <stdint.h>
#include <stdio.h>

#include "application.hpp"

namespace {

namespace fw = sms::firmware;
using sms::Frame;
using sms::Word;

enum { calls = 1000, instructions_a_count = 40 };

volatile uint32_t& reg(uint32_t address) { return *reinterpret_cast<volatile uint32_t*>(address); }
uint32_t now() { return reg(0xE000E018u); }

uint32_t state = 1;
// -0.5 to 0.5
float any() {
  state = state * 1664525u + 1013904223u;
  return float(state >> 8) * (1.0f / 16777216.0f) - 0.5f;
}

volatile float float_sink;
volatile Word word_sink;

// Eight calls between two readings of the clock, whose resolution is 40 instructions.
template <typename Function>
void count(const char* name, const Function& function) {
  uint32_t least = 0xFFFFFFFFu, most = 0, sum = 0;
  for (int i = 0; i < calls; ++i) {
    const uint32_t begin = now();
    for (int k = 0; k < 8; ++k) {
      function();
    }
    const uint32_t taken = ((begin - now()) & 0xFFFFFFu) * instructions_a_count / 8u;
    least = taken < least ? taken : least;
    most = taken > most ? taken : most;
    sum += taken;
  }
  printf("%s;%lu;%lu;%lu\n", name, static_cast<unsigned long>(least), static_cast<unsigned long>(sum / calls),
         static_cast<unsigned long>(most));
}

fw::Application app;

void keep(const Frame& f) {
  for (const Word octet : f.octet) {
    word_sink = octet;
  }
}

void codec() {
  sms::frame::AttitudeSetpoint s = {3, 5, 0.1f, -0.05f, 0.5f};
  Frame f = sms::pack(s);
  count("pack and seal a set-point", [&] {
    s.roll_setpoint = 0.1f * any();
    f = sms::pack(s);
    sms::seal(f, 7);
    keep(f);
  });
  count("check and unpack a set-point", [&] {
    f.octet[3] = Word((f.octet[3] + 1u) & 0xFFu);
    word_sink = sms::is_sealed(f, 7) ? 1 : 0;
    sms::unpack(f, s);
    float_sink = s.roll_setpoint + s.height_setpoint;
  });
  const sms::SipState begun = fw::begin_mac({1, 2}, 3);
  count("MAC of a command frame (SipHash-2-4)", [&] {
    f.octet[3] = Word((f.octet[3] + 1u) & 0xFFu);
    word_sink = Word(fw::command_mac(begun, f.octet[3], f) & 0xFFu);
  });
  sms::frame::ChamberPressureLower p = {386e3f, 386e3f, 386e3f, 1};
  count("pack telemetry", [&] {
    p.chamber_pressure_lower_2 = 386e3f + 1e5f * any();
    keep(sms::pack(p));
  });
}

void control() {
  const sms::Vec3<float> level(0.0f, 0.0f, 0.5f);
  count("set-point to three extensions (inverse kinematics)", [&] {
    const sms::Vec3<float> q = level + sms::Vec3<float>(0.1f * any(), 0.1f * any(), 0.02f * any());
    sms::Vec3<float> extension;
    sms::inverse_kinematics(app.derived.geometry, q, app.target_pose, app.target_pose, extension);
    float_sink = extension(0);
  });
  count("extensions to pose (forward kinematics)", [&] {
    const sms::Vec3<float> x(0.2f + 0.01f * any(), 0.2f + 0.01f * any(), 0.2f + 0.01f * any());
    sms::forward_kinematics(app.derived.geometry, x, app.pose, app.pose);
  });
  const fw::LegSettings& s = app.derived.leg;
  count("limited set-points, three legs", [&] {
    for (fw::Leg& leg : app.leg) {
      sms::setpoint_step<float>(s.limits, leg.setpoint, 0.2f + 0.2f * any(), any());
    }
  });
  const sms::ControlLaw laws[] = {sms::ControlLaw::proportional, sms::ControlLaw::pid, sms::ControlLaw::state_feedback};
  const char* const names[] = {"P and dead band, three legs", "PID and dead band, three legs",
                               "state feedback and dead band, three legs"};
  for (int i = 0; i < 3; ++i) {
    count(names[i], [&] {
      for (fw::Leg& leg : app.leg) {
        const float u = fw::law_step(s, laws[i], leg, 0.2f + 0.1f * any());
        fw::drive(s, leg, sms::valve_command(s.dead_band, s.centre, u), false);
        word_sink = fw::pulse_width(s, leg);
      }
    });
  }
}

}  // namespace

int main() {
  reg(0xE000E014u) = 0xFFFFFFu;
  reg(0xE000E018u) = 0;
  reg(0xE000E010u) = 5;
  printf("%s\n", sms_build_info());
  fw::reset(app, sms::ResetCause::power_on, 1);
  codec();
  control();
  return 0;
}
