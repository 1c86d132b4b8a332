/* What the mechanism costs on a controller, and whether it computes there what it computes on the desk.
 *
 * The same program runs on the emulated Cortex-M4F and on the host. It solves poses of the whole workspace, cold and
 * warm, and prints for each function the instructions of a call (least, mean, most) and a hash over the bits of every
 * result: equal hashes are equal floats, to the last bit.
 *
 * Instructions: the emulator runs one in a fixed time (-icount shift=0), in which the 25 MHz SysTick counts down once
 * every 40. On the host nothing is counted. Instructions are not clock cycles. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "sms/sms.h"

enum { POSES = 2000, INSTRUCTIONS_A_TICK = 40 };

#ifdef __arm__
#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010)
#define SYSTICK_RELOAD (*(volatile uint32_t *)0xE000E014)
#define SYSTICK_VALUE (*(volatile uint32_t *)0xE000E018)
static void start_clock(void) {
  SYSTICK_RELOAD = 0xFFFFFF;
  SYSTICK_VALUE = 0;
  SYSTICK_CONTROL = 5;
}
static uint32_t now(void) { return SYSTICK_VALUE; }
#else
static void start_clock(void) {}
static uint32_t now(void) { return 0; }
#endif

typedef struct tally {
  const char *name;
  uint32_t least, most, calls;
  uint64_t sum;
  uint32_t hash;
  int failures;
} tally;

static void note(tally *t, uint32_t begin, uint32_t end, sms_status status, const float *result, int count) {
  const uint32_t instructions = ((begin - end) & 0xFFFFFF) * INSTRUCTIONS_A_TICK;
  int i;
  if (t->calls == 0 || instructions < t->least) t->least = instructions;
  if (instructions > t->most) t->most = instructions;
  t->sum += instructions;
  ++t->calls;
  t->failures += status != SMS_OK;
  for (i = 0; i < count; ++i) {
    uint32_t bits;
    memcpy(&bits, &result[i], sizeof bits);
    t->hash = t->hash * 31u + bits;
  }
}

/* A number in -0.5 .. 0.5 from a generator of one multiplication, the same on every machine. */
static float any(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) * (1.0f / 16777216.0f) - 0.5f;
}

int main(void) {
  static tally inverse_cold = {"inverse kinematics, cold"}, inverse_warm = {"inverse kinematics, warm"};
  static tally forward_cold = {"forward kinematics, cold"}, forward_warm = {"forward kinematics, warm"};
  static tally friction = {"friction"};
  tally *const all[] = {&inverse_cold, &inverse_warm, &forward_cold, &forward_warm, &friction};
  sms_paramsf params;
  sms_geometryf geometry;
  uint32_t state = 1;
  int k, failures = 0;

  start_clock();
  sms_params_defaultf(&params);
  sms_geometry_from_paramsf(&params, &geometry);
  for (k = 0; k < POSES; ++k) {
    float extension[3], q[3], found[3], force;
    sms_posef pose, solved;
    sms_pistonf piston;
    sms_status status;
    uint32_t begin;
    int i;

    for (i = 0; i < 3; ++i) extension[i] = geometry.stroke * (0.5f + any(&state));
    begin = now();
    status = sms_forward_kinematicsf(&geometry, extension, NULL, &pose, NULL);
    note(&forward_cold, begin, now(), status, &pose.roll, 6);

    q[0] = pose.roll;
    q[1] = pose.pitch;
    q[2] = pose.height;
    begin = now();
    status = sms_inverse_kinematicsf(&geometry, q, NULL, &solved, found, NULL);
    note(&inverse_cold, begin, now(), status, found, 3);

    q[0] += 0.001f; /* a step of a motion: 1 mrad, 1 mm */
    begin = now();
    status = sms_inverse_kinematicsf(&geometry, q, &solved, &solved, found, NULL);
    note(&inverse_warm, begin, now(), status, found, 3);

    extension[0] += 0.001f;
    begin = now();
    status = sms_forward_kinematicsf(&geometry, extension, &pose, &pose, NULL);
    note(&forward_warm, begin, now(), status, &pose.roll, 6);

    piston.extension = extension[0];
    piston.velocity = 0.6f * any(&state);
    piston.acceleration = 6.0f * any(&state);
    piston.pressure_lower = 386e3f;
    piston.pressure_upper = 281e3f;
    begin = now();
    force = sms_frictionf(&params, &piston);
    note(&friction, begin, now(), SMS_OK, &force, 1);
  }
  for (k = 0; k < (int)(sizeof all / sizeof all[0]); ++k) {
    const tally *t = all[k];
    printf("%s;%lu;%lu;%lu;%08lx\n", t->name, (unsigned long)t->least, (unsigned long)(t->sum / t->calls),
           (unsigned long)t->most, (unsigned long)t->hash);
    failures += t->failures;
  }
  return failures != 0;
}
