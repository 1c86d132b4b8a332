// Keys, nonces, authenticators.
#include "authentication.hpp"

namespace sms {
namespace firmware {
namespace {

enum { counter_mask = 0xFFF };

constexpr Octets8 length_of(int octets) { return Octets8(octets) << 56; }

Octets8 mac_of(const frame::CommandAuthenticator& s) { return (Octets8(s.mac_high) << 32) | s.mac_low; }

bool belongs(const Authenticator& a, const Frame& f, Long now) {
  const Long longest = a.tried ? 0u : Long(authenticator_timeout);
  return a.waiting && now - a.when <= longest && a.said.command_crc == Long(f.octet[0] & 0xFFu) &&
         a.said.session == Long((f.octet[1] >> 4) & 0xFu);
}

}  // namespace

SipState begin_mac(const SipKey& key, Octets8 nonce) { return siphash_stir(siphash_begin(key), nonce); }

Octets8 command_mac(const SipState& begun, Long counter, const Frame& f) {
  const Octets8 octets = Octets8(get_bits<0, 32>(f)) | (Octets8(get_bits<32, 32>(f)) << 32);
  const Octets8 last = Octets8(counter) | (Octets8(f.identifier & 0xFFFFu) << 32) | length_of(22);
  return siphash_end(siphash_stir(siphash_stir(begun, octets), last)) & 0xFFFFFFFFFFu;
}

void set_key(Authentication& a, const SipKey& key, Octets8 board_nonce) {
  a.on = (key.low | key.high) != 0u;
  a.key = key;
  a.board = board_nonce;
  a.drawn = 0;
  a.noted = Long(0) - Long(refusal_period);
  draw_nonce(a);
}

// Through the key, so that nobody else can tell the next one, nor have a desk authenticate frames for it beforehand. Its
// message has 12 octets, that of a MAC 22: neither stands for the other.
void draw_nonce(Authentication& a) {
  a.nonce = siphash_end(siphash_stir(begin_mac(a.key, a.board), Octets8(a.drawn) | length_of(12)));
  a.begun = begin_mac(a.key, a.nonce);
  a.drawn += 1u;
  a.told = false;
  for (Long& counter : a.counter) {
    counter = 0;
  }
  for (Authenticator& kept : a.kept) {
    kept.waiting = false;
  }
}

void keep_authenticator(Authentication& a, const Frame& f, Long now) {
  frame::CommandAuthenticator said;
  if (!unpack(f, said)) {
    return;
  }
  a.kept[a.next] = {said, true, false, now};
  a.next = Word((a.next + 1u) % authenticators_kept);
}

Authenticity check_authentic(Authentication& a, const Frame& f, Long now) {
  Authenticity found = Authenticity::no_authenticator;
  if (a.checks >= Word(most_checks)) {
    return Authenticity::too_many;
  }
  for (Authenticator& kept : a.kept) {
    if (!belongs(kept, f, now)) {
      continue;
    }
    Long& last = a.counter[kept.said.session & 0xFu];
    const Long step = (kept.said.freshness - last) & Long(counter_mask);
    if (step == 0u || step > Long(largest_counter_step)) {
      found = Authenticity::old_counter;
      continue;
    }
    if (a.checks >= Word(most_checks)) {
      return Authenticity::too_many;
    }
    a.checks = Word(a.checks + 1u);
    if (command_mac(a.begun, last + step, f) == mac_of(kept.said)) {
      last += step;
      kept.waiting = false;
      return Authenticity::authentic;
    }
    found = Authenticity::wrong_mac;
    kept.tried = true;  // its command may still come in this period; forged ones do not pile up
  }
  return found;
}

}  // namespace firmware
}  // namespace sms
