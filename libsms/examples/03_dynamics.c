/* The forces that hold the platform level at mid-stroke, what happens without one of them, and how the platform swings
 * on air springs. Build: cc 03_dynamics.c -lsms -lm */
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  const double q[3] = {0.0, 0.0, 0.5}, at_rest[3] = {0.0, 0.0, 0.0};
  sms_params params;
  sms_mechanism mechanism;
  sms_actuator_law law;
  sms_linear_model model;
  double force[3], qddot[3];
  int i;

  sms_params_default(&params);
  if (sms_mechanism_from_params(&params, SMS_MASSES_CORRECTED, &mechanism) != SMS_OK ||
      sms_inverse_dynamics(&mechanism, q, NULL, NULL, NULL, NULL, force) != SMS_OK) {
    return 1;
  }
  printf("holding forces: %.1f %.1f %.1f N\n", force[0], force[1], force[2]);

  for (i = 0; i < 3; ++i) {
    law.force[i] = force[i];
    law.stiffness[i] = 36.0e3; /* N/m: both chambers at 333 kPa, adiabatic */
    law.damping[i] = 0.0;
  }
  if (sms_linearise(&mechanism, q, &law, NULL, &model) != SMS_OK) {
    return 1;
  }
  printf("eigenfrequencies: %.2f %.2f %.2f Hz\n", model.eigenfrequency[0], model.eigenfrequency[1],
         model.eigenfrequency[2]);

  force[0] = 0.0;
  if (sms_forward_dynamics(&mechanism, q, at_rest, force, NULL, NULL, qddot) != SMS_OK) {
    return 1;
  }
  printf("without actuator 1: %.2f %.2f rad/s^2, %.2f m/s^2\n", qddot[0], qddot[1], qddot[2]);
  return !(qddot[2] < 0.0);
}
