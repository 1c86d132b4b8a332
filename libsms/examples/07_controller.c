/* The controller of the firmware around a simulated actuator: PID, dead-band compensation, a step of 50 mm. Build:
 * cc 07_controller.c -lsms -lm */
#include <math.h>
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  sms_params params;
  sms_actuator_laws laws;
  sms_bench bench;
  sms_bench_state state;
  sms_bench_input input = {5.0, 0.0};
  sms_stepping stepping;
  sms_pid_settings settings;
  sms_pid pid = {0.0, {0.0, 0.0}};
  sms_dead_band dead_band;
  const double from = 0.1, to = 0.15;
  int i;

  sms_published_laws(&laws);
  if (sms_params_default(&params) != SMS_OK || sms_bench_from_params(&params, &laws, &bench) != SMS_OK ||
      sms_bench_at_rest(&bench, from, 0.0, 333.0e3, &state) != SMS_OK ||
      sms_pid_from_params(&params, &settings) != SMS_OK || sms_dead_band_from_params(&params, &dead_band) != SMS_OK) {
    return 1;
  }
  settings.anti_windup = SMS_ANTI_WINDUP_CONDITIONAL_INTEGRATION;
  sms_stepping_begin(1e-5, &stepping);
  printf("  time  extension  command\n");
  for (i = 0; i * settings.period < 2.0; ++i) {
    const double u = sms_pid_step(&settings, &pid, to - state.extension);
    input.command = sms_valve_command(&dead_band, params.command_offset, u);
    if (sms_bench_advance(&bench, &input, settings.period, &stepping, &state) != SMS_OK) {
      return 1;
    }
    if (i % 250 == 0) {
      printf("%4.2f s  %6.1f mm  %5.2f V\n", i * settings.period, 1e3 * state.extension, input.command);
    }
  }
  printf("%4.2f s  %6.1f mm  %5.2f V\n", i * settings.period, 1e3 * state.extension, input.command);
  return !(fabs(state.extension - to) < 0.005);
}
