/* Reset of the emulated Cortex-M4F: FPU on, then newlib's start-up for semihosting, which clears .bss and calls main.
 * A fault ends the emulation with exit code 1. */
#include <stdint.h>

extern uint32_t __stack_top;
extern void _start(void);

__attribute__((naked, noreturn)) void Reset_Handler(void) {
  __asm volatile(
      "ldr r0, =0xE000ED88\n ldr r1, [r0]\n orr r1, r1, #(0xF << 20)\n str r1, [r0]\n dsb\n isb\n"
      "ldr r0, =__stack_top\n mov sp, r0\n b _start\n");
}

static void Fault(void) {
  __asm volatile("mov r0, #0x18\n ldr r1, =0x20023\n bkpt 0xAB\n");
  for (;;) {
  }
}

__attribute__((section(".vectors"), used)) void *const vectors[16] = {
    (void *)&__stack_top, (void *)Reset_Handler, (void *)Fault, (void *)Fault,
    (void *)Fault,        (void *)Fault,         (void *)Fault,
};

void _init(void) {}
void _fini(void) {}
