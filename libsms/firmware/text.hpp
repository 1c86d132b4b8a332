// Numbers and words for a person, without <stdio.h>: into a ring of characters, and out of a line.
#pragma once

#include "sms/limit.hpp"
#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

// ---- names of the enumerations ----

#define SMS_VALUES(table)                   \
  inline const char* name_of(table value) { \
    switch (int(value)) {
#define SMS_VALUE(name, number) \
  case number:                  \
    return #name;
#define SMS_VALUES_END \
  }                    \
  return "?";          \
  }
#include "sms/frames.def"

// ---- writing ----

// Characters that wait to be sent. What does not fit is left out, and said so by the `~` at its place.
template <int size>
struct TextRing {
  char character[size];
  Word first, count;
};

template <int size>
void put(TextRing<size>& ring, char c) {
  if (ring.count + 1 < size) {
    ring.character[(ring.first + ring.count) % size] = c;
    ++ring.count;
  } else if (ring.count + 1 == size) {
    ring.character[(ring.first + ring.count) % size] = '~';
    ++ring.count;
  }
}

template <int size>
void put(TextRing<size>& ring, const char* text) {
  for (int i = 0; i < size && text[i] != '\0'; ++i) {
    put(ring, text[i]);
  }
}

template <int size>
void put_integer(TextRing<size>& ring, Long value, int least_digits = 1) {
  char digits[10];
  int n = 0;
  for (; n < 10 && (value > 0u || n < least_digits); ++n, value /= 10u) {
    digits[n] = char('0' + int(value % 10u));
  }
  for (; n > 0; --n) {
    put(ring, digits[n - 1]);
  }
}

// With this many decimals; beyond 4 thousand million as such.
template <int size>
void put_fixed(TextRing<size>& ring, float value, int decimals) {
  if (!(value - value >= 0.0f)) {
    return put(ring, "nan");
  }
  if (value < 0.0f) {
    put(ring, '-');
    value = -value;
  }
  Long scale = 1;
  for (int i = 0; i < decimals; ++i) {
    scale *= 10u;
  }
  const Long whole = Long(limited<float>(value, 0.0f, 4.0e9f));
  Long part = Long(limited<float>((value - float(whole)) * float(scale) + 0.5f, 0.0f, float(scale)));
  const Long carry = part >= scale ? 1u : 0u;
  part -= carry * scale;
  put_integer(ring, whole + carry);
  if (decimals > 0) {
    put(ring, '.');
    put_integer(ring, part, decimals);
  }
}

// Six decimals and a power of ten: any float, read back to a few units of its last place.
template <int size>
void put_scientific(TextRing<size>& ring, float value) {
  int power = 0;
  float magnitude = value < 0.0f ? -value : value;
  for (; power < 39 && magnitude >= 10.0f; ++power) {
    magnitude *= 0.1f;
  }
  for (; power > -39 && magnitude > 0.0f && magnitude < 1.0f; --power) {
    magnitude *= 10.0f;
  }
  put_fixed(ring, value < 0.0f ? -magnitude : magnitude, 6);
  put(ring, 'e');
  put(ring, power < 0 ? '-' : '+');
  put_integer(ring, Long(power < 0 ? -power : power), 2);
}

// ---- reading ----

// A line between two places.
struct Text {
  const char* at;
  const char* end;
};

inline void skip_spaces(Text& t) {
  while (t.at < t.end && *t.at == ' ') {
    ++t.at;
  }
}

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Digits into mantissa and power of ten; those beyond the ninth only count.
inline int read_digits(Text& t, Long& mantissa, int& power, bool fraction) {
  int n = 0;
  for (; t.at < t.end && is_digit(*t.at); ++t.at, ++n) {
    const bool fits = mantissa < 100000000u;
    mantissa = fits ? 10u * mantissa + Long(*t.at - '0') : mantissa;
    power += (fraction ? -1 : 0) + (fits ? 0 : 1);
  }
  return n;
}

// -1.5, .5, 2e-3. False, and value untouched, when there is no number or it does not end at a space.
inline bool read_number(Text& t, float& value) {
  skip_spaces(t);
  const bool negative = t.at < t.end && *t.at == '-';
  t.at += t.at < t.end && (*t.at == '-' || *t.at == '+') ? 1 : 0;
  Long mantissa = 0, exponent = 0;
  int power = 0, unused = 0;
  int digits = read_digits(t, mantissa, power, false);
  if (t.at < t.end && *t.at == '.') {
    ++t.at;
    digits += read_digits(t, mantissa, power, true);
  }
  bool good = digits > 0;
  if (good && t.at < t.end && (*t.at == 'e' || *t.at == 'E')) {
    ++t.at;
    const bool down = t.at < t.end && *t.at == '-';
    t.at += t.at < t.end && (*t.at == '-' || *t.at == '+') ? 1 : 0;
    good = read_digits(t, exponent, unused, false) > 0 && exponent < 60u;
    power += down ? -int(exponent) : int(exponent);
  }
  if (!good || (t.at < t.end && *t.at != ' ')) {
    return false;
  }
  float result = float(mantissa);
  for (; power > 0; --power) {
    result *= 10.0f;
  }
  for (; power < 0; ++power) {
    result *= 0.1f;
  }
  value = negative ? -result : result;
  return value - value >= 0.0f;
}

inline bool read_all_numbers(Text& t, float* values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!read_number(t, values[i])) {
      return false;
    }
  }
  skip_spaces(t);
  return t.at == t.end;
}

// A word into a buffer, with a zero behind it; false when there is none or it is too long.
template <int size>
bool read_word(Text& t, char (&word)[size]) {
  skip_spaces(t);
  int n = 0;
  for (; t.at < t.end && *t.at != ' ' && n < size - 1; ++t.at, ++n) {
    word[n] = *t.at;
  }
  word[n] = '\0';
  return n > 0 && (t.at == t.end || *t.at == ' ');
}

// -1: no such digit
inline int hexadecimal(char c) {
  if (is_digit(c)) {
    return c - '0';
  }
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : (c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1);
}

}  // namespace firmware
}  // namespace sms
