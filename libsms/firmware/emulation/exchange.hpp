// What host and emulated target say to each other in a period: the structs of hardware.h, which have the same layout on
// both (16-bit words throughout), and what the target measures of itself.
#pragma once

#include "hardware.h"

// Commands are authenticated: what a tick costs is counted with it.
const uint_least32_t lockstep_key[4] = {0x03020100u, 0x07060504u, 0x0B0A0908u, 0x0F0E0D0Cu};

struct FromTarget {
  sms_hardware_outputs outputs;
  uint32_t instructions;  // of this tick
  uint32_t stack;         // deepest so far, bytes
};

static_assert(sizeof(sms_hardware_inputs) == 2 * (SMS_CONVERTED + 6 + SMS_FRAMES_IN * 10 + SMS_CHARACTERS_IN),
              "no gaps");
