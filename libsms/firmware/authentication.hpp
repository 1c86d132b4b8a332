// Authentic command frames, after the idea of AUTOSAR SecOC: with a key in the controller, a command is obeyed only
// when an authenticator came before it (docs/protocol.md). Without a key nothing of this happens.
//
//   MAC = the low 40 bits of SipHash-2-4(key; nonce (8 octets), command frame (8), counter (4), identifier (2))
//
// The nonce is the controller's, another one for each session; the counter is the desk's, and only rises. So a frame is
// obeyed once: what was recorded has a counter that is over, or a nonce that is.
#pragma once

#include "sms/protocol.hpp"
#include "sms/siphash.hpp"

namespace sms {
namespace firmware {

enum {
  authenticator_timeout = 20,  // ms from an authenticator to its command frame
  largest_counter_step = 1024,
  authenticators_kept = 4,
  most_checks = 4,        // of a MAC, in one period: what a flood may cost
  refusal_period = 1000,  // ms from one Event not_authentic to the next
  session_values = 16
};

struct Authenticator {
  frame::CommandAuthenticator said;
  bool waiting;
  bool tried;  // in vain: after this period it is over
  Long when;   // ms
};

struct Authentication {
  bool on;  // there is a key
  SipKey key;
  Octets8 board;  // the board's own nonce
  Long drawn;     // nonces since reset
  Octets8 nonce;
  SipState begun;                // the hash of a MAC as far as the nonce
  bool told;                     // the nonce, to the desk
  Long counter[session_values];  // the last one of each session
  Authenticator kept[authenticators_kept];
  Word next;    // place of the next one
  Word checks;  // MACs of this period
  Long noted;   // ms, the last refusal that the log has
};

// Low 40 bits; `begun` is what every MAC of a session begins with.
SipState begin_mac(const SipKey& key, Octets8 nonce);
Octets8 command_mac(const SipState& begun, Long counter, const Frame& f);

// A key and a number that this board never had before; a key of zeros is none.
void set_key(Authentication& a, const SipKey& key, Octets8 board_nonce);

// Whatever was authentic until now is not from here on.
void draw_nonce(Authentication& a);

void keep_authenticator(Authentication& a, const Frame& f, Long now);

// Whether a command frame, its CRC checked, has its authenticator; that one is used up.
Authenticity check_authentic(Authentication& a, const Frame& f, Long now);

}  // namespace firmware
}  // namespace sms
