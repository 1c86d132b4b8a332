/* The friction of one cylinder over its velocity, at two mean pressures. Build: cc 01_friction.c -lsms -lm */
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  sms_params params;
  sms_piston piston = {0.2, 0.0, 1.0, 386.0e3, 281.0e3};
  int i;

  sms_params_default(&params);
  printf("velocity [m/s]  friction [N]  with pressure-dependent seals [N]\n");
  for (i = 0; i <= 10; ++i) {
    double plain;
    piston.velocity = 0.02 * i;
    params.pressure_friction = 0.0;
    plain = sms_friction(&params, &piston);
    params.pressure_friction = 7.5e-6; /* 0.75 N per bar */
    printf("%14.2f  %12.2f  %12.2f\n", piston.velocity, plain, sms_friction(&params, &piston));
  }
  return 0;
}
