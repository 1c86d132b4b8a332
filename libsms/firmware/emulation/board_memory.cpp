// A board whose registers are a struct in memory: the smallest there is. It gives the size of the whole image, main loop
// and all, and shows what a real board fills in.
#include "hardware.h"

namespace {

struct Registers {
  volatile uint_least16_t tick;  // set by the timer, cleared by the loop
  volatile uint_least16_t converted[SMS_CONVERTED];
  volatile uint_least16_t pulse_width[SMS_LEGS];
  volatile uint_least16_t enabled, bus_off, watchdog, seed, reset_cause;
  volatile uint_least16_t received, receiver, sent, transmitter;
  volatile uint_least32_t key[4], resets;  // in memory that keeps them
  volatile uint_least16_t has_key;
  sms_frame mailbox;
};

Registers registers;

}  // namespace

extern "C" {

uint_least16_t hardware_start(void) { return registers.reset_cause; }

uint_least16_t hardware_seed(void) { return registers.seed; }

int hardware_key(uint_least32_t key[4], uint_least32_t nonce[2]) {
  for (int i = 0; i < 4; ++i) {
    key[i] = registers.key[i];
  }
  nonce[0] = registers.resets;
  nonce[1] = 0;
  return int(registers.has_key);
}

int hardware_read(sms_hardware_inputs* inputs) {
  while (registers.tick == 0) {
  }
  registers.tick = 0;
  for (int i = 0; i < SMS_CONVERTED; ++i) {
    inputs->converted[i] = registers.converted[i];
  }
  inputs->enabled = registers.enabled;
  inputs->bus_off = registers.bus_off;
  inputs->frame_count = 0;
  if (registers.received != 0) {
    inputs->frames[inputs->frame_count++] = registers.mailbox;
  }
  inputs->character_count = 0;
  if (registers.receiver != 0) {
    inputs->characters[inputs->character_count++] = registers.receiver;
  }
  return 1;
}

void hardware_write(const sms_hardware_outputs* outputs) {
  for (int i = 0; i < SMS_LEGS; ++i) {
    registers.pulse_width[i] = outputs->pulse_width[i];
  }
  for (int i = 0; i < int(outputs->frame_count); ++i) {
    registers.mailbox = outputs->frames[i];
    registers.sent = 1;
  }
  for (int i = 0; i < int(outputs->character_count); ++i) {
    registers.transmitter = outputs->characters[i];
  }
  registers.watchdog = outputs->feed_watchdog;
}

}  // extern "C"
