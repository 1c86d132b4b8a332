// The application: everything a controller does in one period, as one function on one struct.
//
//   Application app;
//   reset(app, cause, seed);
//   every control period:  tick(app, inputs, outputs);
//
// The board, the emulated board and the virtual rig call this same function (hardware.h). It uses no heap, no globals,
// no clock but the count of its calls; every loop is bounded. What goes over the bus is in docs/protocol.md, what can
// go wrong and what then happens in docs/faults.md.
//
// The order of a period: sense, receive, watch, drive, send. A set-point that arrived before a tick moves the valves in
// it.
#pragma once

#include "authentication.hpp"
#include "capture.hpp"
#include "command_link.hpp"
#include "console.hpp"
#include "event_log.hpp"
#include "faults.hpp"
#include "hardware.h"
#include "leg_control.hpp"
#include "parameter_store.hpp"
#include "sensing.hpp"
#include "sms/excitation.hpp"
#include "sms/forward_kinematics.hpp"
#include "sms/inverse_kinematics.hpp"
#include "sms/sequencer.hpp"

namespace sms {
namespace firmware {

// What follows from the parameters; computed when they take effect.
struct Derived {
  Geometry<float> geometry;
  Pose<float> level_pose;
  float level_extension[SMS_LEGS];
  LegSettings leg;
  Excitation<float> excitation;
  bool excitation_closed_loop;
  SequencerSettings sequence;
};

// SMS_OUT_OF_WORKSPACE and the like when no such machine can be levelled; derived is then as it was.
sms_status derive(const Parameters& p, Derived& derived);

// What the valves are driven by.
enum class Drive { centre, open_loop, closed_loop };

// Set-points as they come in, to be worked on once a period. They are joined by straight lines: the way to a new one
// takes as long as it was waited for.
struct Target {
  float extension[SMS_LEGS];  // m, within the stroke
  float from[SMS_LEGS];       // m, where the way to it began
  Word interval;              // ms that it takes
  float wanted[3];            // as received: roll, pitch, height, or three extensions
  bool attitude_waiting;      // for its inverse kinematics
  bool waiting;               // for the answer
  bool fresh;                 // one came within the time-out
  Word alive, session;        // of the last one
  Long when;                  // ms
  SetpointResult result;
};

struct Application {
  Long now;  // ms since reset
  ResetCause reset_cause;
  Mode mode;
  ControlLaw law;
  Drive drive;
  bool blend;  // the drive changes in this period: keep the valves where they are
  Sequencer sequencer;
  TestPhase phase;

  ParameterStore parameters;
  Derived derived;
  Sensing sensing;
  Sensed sensed;
  Leg leg[SMS_LEGS];
  float goal[SMS_LEGS];  // of the last period, m
  Target target;
  Pose<float> target_pose;  // of the last set-point: where the next search starts
  Pose<float> pose;         // of the platform, by forward kinematics
  SetpointLimited limited;
  bool limit_noted;

  CommandLink link;
  Authentication authentication;  // off until set_key
  Faults faults;
  Long known_faults;  // that the log knows of
  Fault first_fault;
  EventLog log;
  Capture capture;
  Console console;

  bool enabled;
  Word overruns;  // in the last 100 ms
  Word load;
  Word heartbeats;
  Mode told_mode;
  Long told_faults;
};

// Power on, or what the cause says. All parameters at their defaults.
void reset(Application& app, ResetCause cause, Word seed);

// As reset, with parameters of the caller; SMS_OK, or what is wrong with them, and then nothing is touched.
sms_status reset_with(Application& app, const Parameters& parameters, ResetCause cause, Word seed);

// From here on commands of the bus need an authenticator; after each reset. A key of zeros: they need none.
void set_key(Application& app, const SipKey& key, Octets8 board_nonce);

// One control period.
void tick(Application& app, const sms_hardware_inputs& in, sms_hardware_outputs& out);

// ---- for the parts of the application ----

void note(Application& app, EventKind kind, Word detail);

// modes.cpp
bool is_driven(Mode mode);
void enter(Application& app, Mode mode, Reason why);
// Takes the platform out of its mode where it has to be.
void watch_modes(Application& app);
// Asks for a mode; the reason why not, or Reason::none.
Reason request_mode(Application& app, Mode wanted, Reason why);
void request_law(Application& app, ControlLaw law);
void acknowledge(Application& app);
void take_control_by(Application& app, Word session);
void give_up_control(Application& app);

// setpoints.cpp
void take_extension_setpoint(Application& app, const float (&extension)[SMS_LEGS], Word alive, Word session);
void take_attitude_setpoint(Application& app, const float (&attitude)[3], Word alive, Word session);
// One that the next has to confirm; only answered.
void postpone_setpoint(Application& app, Word alive, Word session);
// The last one taken, by inverse kinematics and within the stroke; the way to it begins.
void resolve_setpoint(Application& app);
// Where a piston shall be now, m.
float on_the_way(const Application& app, int leg);

// drive.cpp
void drive_legs(Application& app);
void follow_pose(Application& app);

// derived.cpp
WriteAccess write_access(const Application& app);
// Puts the staged parameters into effect, or says why not.
ParameterResult commit_parameters(Application& app, Word count);

// command.cpp, telemetry.cpp, console.cpp
void receive(Application& app, const sms_hardware_inputs& in, sms_hardware_outputs& out);
void send(Application& app, sms_hardware_outputs& out);
void read_console(Application& app, const sms_hardware_inputs& in);
void write_console(Application& app, sms_hardware_outputs& out);
bool put_frame(sms_hardware_outputs& out, const Frame& frame);

}  // namespace firmware
}  // namespace sms
