/* One actuator on the bench whose valve is opened, and the platform under a controller written here: it is asked to roll
 * by 3 deg. Build: cc 05_plant.c -lsms -lm */
#include <math.h>
#include <stdio.h>

#include "sms/sms.h"

/* Every 0.1 s of an actuator whose valve gets 6.5 V: it starts, and runs at a steady speed. */
static int open_the_valve(const sms_params *params, const sms_actuator_laws *laws) {
  const sms_bench_input input = {6.5, 0.0};
  sms_bench bench;
  sms_bench_state state;
  sms_stepping stepping;
  int i;

  if (sms_bench_from_params(params, laws, &bench) != SMS_OK ||
      sms_bench_at_rest(&bench, 0.05, 0.0, 333.0e3, &state) != SMS_OK) {
    return 0;
  }
  sms_stepping_begin(1e-6, &stepping);
  printf("bench, 6.5 V\n    time   extension  velocity  pressures\n");
  for (i = 1; i <= 5; ++i) {
    if (sms_bench_advance(&bench, &input, 0.1, &stepping, &state) != SMS_OK) {
      return 0;
    }
    printf("%6.1f s  %7.1f mm  %4.0f mm/s  %.0f and %.0f kPa\n", 0.1 * i, 1e3 * state.extension, 1e3 * state.velocity,
           1e-3 * state.actuator.lower.pressure, 1e-3 * state.actuator.upper.pressure);
  }
  printf("%lu evaluations of the derivative\n\n", stepping.evaluations);
  return state.velocity > 0.0 && state.extension < params->stroke;
}

/* V: proportional, and over the dead band of the valve as soon as the error is worth it. */
static double controller(const sms_params *params, double error) {
  const double step = fabs(error) > 1e-3 ? (error > 0.0 ? 0.5 : -0.5) : 0.0;
  return params->valve_centre + step + 10.0 * error;
}

/* 2 s of the platform, a controller's sample every 1 ms. */
static int roll_by_three_degrees(const sms_params *params, const sms_actuator_laws *laws) {
  const double degree = 3.14159265358979324 / 180.0;
  const double level[3] = {0.0, 0.0, 0.5}, wanted[3] = {3.0 * 3.14159265358979324 / 180.0, 0.0, 0.5};
  sms_platform_input input = {{0.0, 0.0, 0.0}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  sms_platform platform;
  sms_platform_state state, rate;
  sms_platform_terms terms;
  sms_stepping stepping;
  sms_pose pose;
  double setpoint[3];
  int i, k;

  if (sms_platform_from_params(params, laws, SMS_MASSES_CORRECTED, &platform) != SMS_OK ||
      sms_platform_at_rest(&platform, level, 333.0e3, &state) != SMS_OK ||
      sms_inverse_kinematics(&platform.mechanism.geometry, wanted, NULL, &pose, setpoint, NULL) != SMS_OK) {
    return 0;
  }
  sms_platform_prepare(&platform, &terms);
  sms_stepping_begin(1e-4, &stepping);
  for (k = 0; k < 3; ++k) {
    input.command[k] = params->valve_centre;
  }
  if (sms_platform_derivative(&platform, &state, &input, &terms, &rate) != SMS_OK) {
    return 0;
  }
  printf("platform, 3 deg of roll\n    time      roll     pitch    height  friction of the pistons\n");
  for (i = 0; i <= 2000; ++i) {
    if (i > 0 && i % 400 == 0) {
      printf("%6.1f s  %4.2f deg  %4.2f deg  %5.1f mm  %.0f, %.0f and %.0f N\n", 1e-3 * i, state.q[0] / degree,
             state.q[1] / degree, 1e3 * state.q[2], terms.friction[0], terms.friction[1], terms.friction[2]);
    }
    for (k = 0; k < 3; ++k) {
      input.command[k] = controller(params, setpoint[k] - terms.extension[k]);
    }
    if (sms_platform_advance(&platform, &input, 1e-3, &stepping, &terms, &state) != SMS_OK) {
      return 0;
    }
  }
  return fabs(state.q[0] - wanted[0]) < 0.5 * degree;
}

int main(void) {
  sms_params params;
  sms_actuator_laws laws;

  sms_params_default(&params);
  sms_published_laws(&laws);
  return !(open_the_valve(&params, &laws) && roll_by_three_degrees(&params, &laws));
}
