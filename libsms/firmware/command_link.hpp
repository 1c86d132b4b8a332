// Which command frames are obeyed: check, session, alive counter (docs/protocol.md).
#pragma once

#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

enum {
  protocol_version = 1,
  nobody = 0,
  console_session = 15,
  largest_step = 4,         // of an alive counter: three frames in a row may get lost
  synchronise_anew = 50,    // ms without an accepted frame of that identifier, then two in order will do
  synchronise_after = 500,  // ms without an accepted frame of that identifier
  host_timeout = 300,       // ms without an accepted frame
  setpoint_timeout = 100,   // ms without a set-point
  command_identifiers = 10,
  largest_jump = 3000  // raw: 30 mrad, 30 mm
};

// Alive counter of one identifier.
struct Alive {
  bool known;
  bool doubtful;   // the last frame was refused
  Word last;       // counter of the last accepted frame
  Word candidate;  // counter of the last refused one
  Long when;       // ms, of the last accepted frame
};

// The last accepted set-point of one identifier, as its three raw words, and one that was too far from it.
struct Neighbourhood {
  bool known, waiting;
  Word last[3], candidate[3];
};

struct CommandLink {
  Word challenge;
  Word session;  // in control
  Long heard;    // ms, its last accepted frame
  Alive alive[command_identifiers];
  Neighbourhood setpoint[2];  // attitude, extension
  // counters since reset, of 16 bits
  Word lost, corrupted, out_of_sequence, refused;
};

// -1: not a command.
inline int command_number(Word identifier) {
  switch (identifier) {
    case frame::ModeRequest::identifier:
      return 0;
    case frame::HostHeartbeat::identifier:
      return 1;
    case frame::AttitudeSetpoint::identifier:
      return 2;
    case frame::ExtensionSetpoint::identifier:
      return 3;
    case frame::ParameterBegin::identifier:
      return 4;
    case frame::ParameterWrite::identifier:
      return 5;
    case frame::ParameterCommit::identifier:
      return 6;
    case frame::ParameterRead::identifier:
      return 7;
    case frame::CaptureSetup::identifier:
      return 8;
    case frame::CaptureRead::identifier:
      return 9;
    default:
      return -1;
  }
}

inline Word session_of(const Frame& f) { return Word((f.octet[1] >> 4) & 0xFu); }
inline Word alive_of(const Frame& f) { return Word(f.octet[1] & 0xFu); }

// Whole and with the right CRC; counted when not.
inline bool check_frame(CommandLink& link, const Frame& f) {
  const bool good = Word(f.length) == Word(octets_per_frame) && is_sealed(f, link.challenge);
  link.corrupted = Word(link.corrupted + (good ? 0 : 1));
  return good;
}

// Whether the counter goes on where it was; what was lost between is counted, and what is refused.
inline bool check_alive(CommandLink& link, int number, Word alive, Long now) {
  Alive& a = link.alive[number];
  const Word step = Word((alive - a.last) & 0xFu);
  const Word from_candidate = Word((alive - a.candidate) & 0xFu);
  const bool in_order = step >= 1 && step <= largest_step;
  const bool anew =
      !a.known || now - a.when > Long(synchronise_after) ||
      (a.doubtful && now - a.when > Long(synchronise_anew) && from_candidate >= 1 && from_candidate <= largest_step);
  if (!in_order && !anew) {
    a.doubtful = true;
    a.candidate = alive;
    link.out_of_sequence = Word(link.out_of_sequence + 1);
    return false;
  }
  link.lost = Word(link.lost + (in_order && a.known ? step - 1 : 0));
  a = {true, false, alive, alive, now};
  link.heard = now;
  return true;
}

// Whether two raw words are no further apart than a host moves a set-point from one frame to the next; the signed ones
// run over like the others.
inline bool is_near(const Word (&a)[3], const Word (&b)[3]) {
  bool near_all = true;
  for (int i = 0; i < 3; ++i) {
    const Word apart = Word((a[i] - b[i]) & 0xFFFFu);
    near_all = near_all && (apart <= Word(largest_jump) || apart >= Word(0x10000u - Word(largest_jump)));
  }
  return near_all;
}

// A set-point far from the last one waits until the next one confirms it, when there is a last one that still moves the
// platform: a frame that passed its check by chance moves nothing. One that holds no value goes through, to be refused
// as such.
inline bool is_plausible(CommandLink& link, const Frame& f, bool streaming) {
  Neighbourhood& n = link.setpoint[f.identifier == Word(frame::AttitudeSetpoint::identifier) ? 0 : 1];
  Word raw[3];
  bool has_value = true;
  for (int i = 0; i < 3; ++i) {
    raw[i] = Word((f.octet[2 + 2 * i] & 0xFFu) | ((f.octet[3 + 2 * i] & 0xFFu) << 8));
    has_value = has_value && raw[i] != 0xFFFFu && raw[i] != 0x8000u;
  }
  const bool plausible = !streaming || (n.known && is_near(raw, n.last)) || (n.waiting && is_near(raw, n.candidate));
  n.waiting = has_value && !plausible;
  n.known = n.known || plausible;
  for (int i = 0; has_value && i < 3; ++i) {
    (plausible ? n.last : n.candidate)[i] = raw[i];
  }
  return plausible || !has_value;
}

// Somebody takes control: all counters start anew.
inline void take_control(CommandLink& link, Word session, Long now) {
  link.session = session;
  link.heard = now;
  for (Alive& a : link.alive) {
    a = {false, false, 0, 0, now};
  }
  for (Neighbourhood& n : link.setpoint) {
    n.known = n.waiting = false;
  }
}

// Nobody is in control; what was recorded until now fails its CRC from here on.
inline void release_control(CommandLink& link, Long now) {
  link.session = nobody;
  link.challenge = Word((link.challenge + 1u + now % 254u) & 0xFFu);
}

}  // namespace firmware
}  // namespace sms
