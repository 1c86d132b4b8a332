/* Reset without a debugger: FPU on, .bss cleared, constructors run, main. .data is where it belongs already on this
 * board; one with a flash copies it here. */
#include <stdint.h>

extern uint32_t __stack_top, __bss_start__, __bss_end__;
typedef void (*constructor)(void);
extern constructor const __init_array_start[], __init_array_end[];
extern int main(void);

static void start(void) {
  uint32_t *at;
  constructor const *call;
  for (at = &__bss_start__; at < &__bss_end__; ++at) *at = 0;
  for (call = __init_array_start; call < __init_array_end; ++call) (*call)();
  main();
  for (;;) {
  }
}

__attribute__((naked, noreturn)) void Reset_Handler(void) {
  __asm volatile(
      "ldr r0, =0xE000ED88\n ldr r1, [r0]\n orr r1, r1, #(0xF << 20)\n str r1, [r0]\n dsb\n isb\n"
      "ldr r0, =__stack_top\n mov sp, r0\n b %0\n"
      :
      : "i"(start));
}

static void Fault(void) {
  for (;;) {
  }
}

__attribute__((section(".vectors"), used)) void *const vectors[16] = {
    (void *)&__stack_top, (void *)Reset_Handler, (void *)Fault, (void *)Fault,
    (void *)Fault,        (void *)Fault,         (void *)Fault,
};
