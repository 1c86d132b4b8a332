// The services of the debugger that QEMU plays on the target: files of the host, by number (Arm's semihosting, 2.0).
// In lockstep the target waits in read() until the host has written, so that emulated time stands still meanwhile.
#pragma once

#include <stdint.h>

namespace semihosting {

inline int call(int number, const void* arguments) {
  register int r0 __asm__("r0") = number;
  register const void* r1 __asm__("r1") = arguments;
  __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

enum Mode : uint32_t { to_read = 1, to_write = 5 };  // "rb", "wb"

inline int open(const char* name, uint32_t length, Mode mode) {
  const struct {
    const char* name;
    uint32_t mode, length;
  } arguments = {name, mode, length};
  return call(0x01, &arguments);
}

// All of it, however the pipe hands it over; false at its end.
inline bool read(int file, void* to, uint32_t count) {
  char* at = static_cast<char*>(to);
  for (uint32_t left = count; left > 0u;) {
    const struct {
      int file;
      void* to;
      uint32_t count;
    } arguments = {file, at, left};
    const uint32_t missing = static_cast<uint32_t>(call(0x06, &arguments));
    if (missing >= left) {
      return false;
    }
    at += left - missing;
    left = missing;
  }
  return true;
}

inline void write(int file, const void* from, uint32_t count) {
  const struct {
    int file;
    const void* from;
    uint32_t count;
  } arguments = {file, from, count};
  call(0x05, &arguments);
}

[[noreturn]] inline void stop(bool good) {
  call(0x18, reinterpret_cast<const void*>(good ? 0x20026u : 0x20023u));
  for (;;) {
  }
}

}  // namespace semihosting
