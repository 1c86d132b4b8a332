// SipHash-2-4: a keyed hash of a short message, 64 bits, which nobody without the key can tell or find.
//
//   J.-P. Aumasson, D. J. Bernstein: SipHash: a fast short-input PRF. INDOCRYPT 2012.
//
// Four words of 64 bits are stirred by additions, rotations and exclusive ors: twice for each eight octets of the
// message, four times at the end. No table, no branch and no memory access depends on key or message, so that the time
// it takes says nothing of either. Octets travel in words, as in protocol.hpp.
#pragma once

#include <cstdint>

namespace sms {

using Octets8 = std::uint_least64_t;  // eight octets, the first one lowest

struct SipKey {
  Octets8 low, high;  // octets 0 to 7, 8 to 15
};

namespace siphash {

constexpr Octets8 low64(Octets8 x) { return x & 0xFFFFFFFFFFFFFFFFu; }

constexpr Octets8 rotated(Octets8 x, int by) { return low64(x << by) | (x >> (64 - by)); }

inline void round(Octets8& a, Octets8& b, Octets8& c, Octets8& d) {
  a = low64(a + b);
  c = low64(c + d);
  b = rotated(b, 13) ^ a;
  d = rotated(d, 16) ^ c;
  a = rotated(a, 32);
  c = low64(c + b);
  a = low64(a + d);
  b = rotated(b, 17) ^ c;
  d = rotated(d, 21) ^ a;
  c = rotated(c, 32);
}

}  // namespace siphash

struct SipState {
  Octets8 v[4];
};

inline SipState siphash_begin(const SipKey& key) {
  return {{key.low ^ 0x736F6D6570736575u, key.high ^ 0x646F72616E646F6Du, key.low ^ 0x6C7967656E657261u,
           key.high ^ 0x7465646279746573u}};
}

// The next eight octets of the message. Its last block holds what is left, 0 to 7 octets, and in its highest octet the
// length of the whole message modulo 256.
inline SipState siphash_stir(const SipState& s, Octets8 block) {
  Octets8 a = s.v[0], b = s.v[1], c = s.v[2], d = s.v[3] ^ block;
  siphash::round(a, b, c, d);
  siphash::round(a, b, c, d);
  return {{a ^ block, b, c, d}};
}

inline Octets8 siphash_end(const SipState& s) {
  Octets8 a = s.v[0], b = s.v[1], c = s.v[2] ^ 0xFFu, d = s.v[3];
  for (int i = 0; i < 4; ++i) {
    siphash::round(a, b, c, d);
  }
  return a ^ b ^ c ^ d;
}

}  // namespace sms
