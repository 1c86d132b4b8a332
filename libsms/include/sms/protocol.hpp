// The frames of the bus: structs, codec, check (docs/protocol.md; defined by libsms/firmware/sms.dbc).
//
//   Frame f = pack(frame::Extension{...});      physical values to bits
//   frame::Setpoint s;  unpack(f, s);           and back
//
// Bits are numbered in Intel order: bit b of a frame is bit b % 8 of octet b / 8. A physical signal of 16 bits is
//
//   raw = round((value - offset) / step),    kept within what has a meaning; NaN has a raw value of its own
//
// Octets travel in words that hold at least 16 bits, with masks: no type of 8 bits is assumed, and no width of int. (On
// a C28x the least thing with an address has 16 bits.) Only a float is taken as IEEE 754 with 32 bits.
//
// A command frame is sealed by a CRC-8/SAE-J1850 (x^8 + x^4 + x^3 + x^2 + 1, all ones before and after) over its
// identifier, the controller's challenge and the rest of the frame, and carries an alive counter: both are checked by
// link.hpp of the firmware.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "sms/frame.h"

namespace sms {

using Word = std::uint_least16_t;  // an octet, a counter, a raw value
using Long = std::uint_least32_t;  // a time in ms, a hash, the bits of a float

enum { octets_per_frame = 8 };

using Frame = sms_frame;  // every frame of this bus has 8 octets

// ---- bits ----

template <int start, int length>
void put_bits(Frame& f, Long value) {
  static_assert(start % 8 + length <= 32 && start + length <= 64, "fits a Long and the frame");
  for (int i = start / 8; i <= (start + length - 1) / 8; ++i) {
    const int shift = 8 * i - start;
    const Long bits = shift >= 0 ? value >> shift : value << -shift;
    f.octet[i] = Word((f.octet[i] | bits) & 0xFFu);
  }
}

template <int start, int length>
Long get_bits(const Frame& f) {
  Long value = 0;
  for (int i = start / 8; i <= (start + length - 1) / 8; ++i) {
    const int shift = 8 * i - start;
    const Long octet = Long(f.octet[i] & 0xFFu);
    value |= shift >= 0 ? octet << shift : octet >> -shift;
  }
  return value & (0xFFFFFFFFu >> (32 - length));
}

// ---- physical values ----

inline float no_value() { return std::numeric_limits<float>::quiet_NaN(); }

// 65535 is "no value".
inline Long to_unsigned(float value, float step, float offset) {
  using std::floor;
  const float raw = floor((value - offset) / step + 0.5f);
  return raw >= 0.0f ? (raw <= 65534.0f ? Long(raw) : 65534u) : (raw < 0.0f ? 0u : 65535u);
}

inline float from_unsigned(Long raw, float step, float offset) {
  return raw == 65535u ? no_value() : float(raw) * step + offset;
}

// Two's complement; -32768 is "no value".
inline Long to_signed(float value, float step, float offset) {
  using std::floor;
  const float raw = floor((value - offset) / step + 0.5f);
  if (!(raw > -32768.0f)) {
    return raw <= -32768.0f ? 0x8001u : 0x8000u;
  }
  return raw < 0.0f ? (65536u - Long(-raw)) & 0xFFFFu : (raw <= 32767.0f ? Long(raw) : 32767u);
}

inline float from_signed(Long raw, float step, float offset) {
  if (raw == 0x8000u) {
    return no_value();
  }
  return (raw > 0x8000u ? -float(65536u - raw) : float(raw)) * step + offset;
}

inline Long to_real32(float value) {
  Long bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  return bits;
}

inline float from_real32(Long bits) {
  float value = 0.0f;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// ---- enumerations and frames ----

#define SMS_VALUES(table) enum class table : Word {
#define SMS_VALUE(name, number) name = (number),
#define SMS_VALUES_END \
  }                    \
  ;
#include "sms/frames.def"

namespace frame {
#define SMS_FRAME(name_, identifier_) \
  struct name_ {                      \
    enum : Word { identifier = (identifier_) };
#define SMS_RAW(name, start, length) Long name;
#define SMS_UNSIGNED(name, start, step, offset) float name;
#define SMS_SIGNED(name, start, step, offset) float name;
#define SMS_REAL32(name, start) float name;
#define SMS_FRAME_END(name) \
  }                         \
  ;
#include "sms/frames.def"
}  // namespace frame

#define SMS_FRAME(name, identifier)         \
  inline Frame pack(const frame::name& s) { \
    Frame f = {identifier, octets_per_frame, {0, 0, 0, 0, 0, 0, 0, 0}};
#define SMS_RAW(name, start, length) put_bits<start, length>(f, s.name);
#define SMS_UNSIGNED(name, start, step, offset) put_bits<start, 16>(f, to_unsigned(s.name, float(step), float(offset)));
#define SMS_SIGNED(name, start, step, offset) put_bits<start, 16>(f, to_signed(s.name, float(step), float(offset)));
#define SMS_REAL32(name, start) put_bits<start, 32>(f, to_real32(s.name));
#define SMS_FRAME_END(name) \
  return f;                 \
  }
#include "sms/frames.def"

// Whether the frame is whole: 8 octets, its reserved bits zero. The identifier is the caller's matter.
#define SMS_FRAME(name, identifier)                    \
  inline bool unpack(const Frame& f, frame::name& s) { \
    bool whole = Word(f.length) == Word(octets_per_frame);
#define SMS_RAW(name, start, length) s.name = get_bits<start, length>(f);
#define SMS_UNSIGNED(name, start, step, offset) \
  s.name = from_unsigned(get_bits<start, 16>(f), float(step), float(offset));
#define SMS_SIGNED(name, start, step, offset) s.name = from_signed(get_bits<start, 16>(f), float(step), float(offset));
#define SMS_REAL32(name, start) s.name = from_real32(get_bits<start, 32>(f));
#define SMS_RESERVED(start, length) whole = whole && get_bits<start, length>(f) == 0u;
#define SMS_FRAME_END(name) \
  return whole;             \
  }
#include "sms/frames.def"

// ---- the check of command frames ----

// CRC-8 with the polynomial 0x1D, four bits at a time.
inline Word crc8_octet(Word crc, Word octet) {
  static const Word kTable[16] = {0x00, 0x1D, 0x3A, 0x27, 0x74, 0x69, 0x4E, 0x53,
                                  0xE8, 0xF5, 0xD2, 0xCF, 0x9C, 0x81, 0xA6, 0xBB};
  Word c = Word((crc ^ octet) & 0xFFu);
  c = Word(((c << 4) & 0xFFu) ^ kTable[c >> 4]);
  return Word(((c << 4) & 0xFFu) ^ kTable[c >> 4]);
}

// Over the identifier, the challenge, and all octets but the first, which holds it.
inline Word command_crc(const Frame& f, Word challenge) {
  Word crc = crc8_octet(0xFF, Word(f.identifier & 0xFFu));
  crc = crc8_octet(crc, Word((f.identifier >> 8) & 0xFFu));
  crc = crc8_octet(crc, challenge);
  for (int i = 1; i < octets_per_frame; ++i) {
    crc = crc8_octet(crc, f.octet[i]);
  }
  return Word(crc ^ 0xFFu);
}

inline void seal(Frame& f, Word challenge) { f.octet[0] = command_crc(f, challenge); }

inline bool is_sealed(const Frame& f, Word challenge) { return Word(f.octet[0]) == command_crc(f, challenge); }

}  // namespace sms
