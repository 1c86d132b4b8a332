// The emulated board of the processor in the loop: sensors come from the host, commands go to it, a period at a time.
// It counts the instructions between read and write, which is one tick, and how deep the stack got.
//
// Instructions: the emulator runs one in a fixed time (-icount shift=0), in which the 25 MHz SysTick counts down once
// every 40.
#include "exchange.hpp"
#include "semihosting.hpp"

extern "C" uint32_t __stack_top;
extern "C" uint32_t __stack_limit;

namespace {

constexpr uint32_t kInstructionsPerCount = 40, kPaint = 0xA5A5A5A5u;

volatile uint32_t& reg(uint32_t address) { return *reinterpret_cast<volatile uint32_t*>(address); }
uint32_t now() { return reg(0xE000E018u); }

int from_host, to_host;
uint32_t begin;
FromTarget message;

void paint_stack() {
  uint32_t* here;
  __asm__ volatile("mov %0, sp" : "=r"(here));
  for (volatile uint32_t* at = &__stack_limit; at < here; ++at) {  // volatile: no call whose frame it would paint over
    *at = kPaint;
  }
}

uint32_t stack_used() {
  const uint32_t* at = &__stack_limit;
  while (at < &__stack_top && *at == kPaint) {
    ++at;
  }
  return static_cast<uint32_t>(&__stack_top - at) * 4u;
}

}  // namespace

extern "C" {

uint_least16_t hardware_start(void) {
  paint_stack();
  from_host = semihosting::open("to_target", 9, semihosting::to_read);
  to_host = semihosting::open("from_target", 11, semihosting::to_write);
  reg(0xE000E014u) = 0xFFFFFFu;
  reg(0xE000E018u) = 0;
  reg(0xE000E010u) = 5;
  return 0;
}

uint_least16_t hardware_seed(void) { return 1; }

int hardware_key(uint_least32_t key[4], uint_least32_t nonce[2]) {
  for (int i = 0; i < 4; ++i) {
    key[i] = lockstep_key[i];
  }
  nonce[0] = nonce[1] = 0;
  return 1;
}

int hardware_read(sms_hardware_inputs* inputs) {
  if (!semihosting::read(from_host, inputs, sizeof *inputs)) {
    semihosting::stop(true);
  }
  begin = now();
  return 1;
}

void hardware_write(const sms_hardware_outputs* outputs) {
  message.instructions = ((begin - now()) & 0xFFFFFFu) * kInstructionsPerCount;
  message.outputs = *outputs;
  message.stack = stack_used();
  semihosting::write(to_host, &message, sizeof message);
}

}  // extern "C"
