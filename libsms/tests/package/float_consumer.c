/* What a controller links: float alone, no mathematics of its own. Exit code 0 when the friction is in its range. */
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  sms_paramsf params;
  sms_pistonf piston = {0.2f, 0.1f, 0.3f, 386.0e3f, 281.0e3f};
  float force;

  printf("%s\n", sms_build_info());
  if (sms_params_defaultf(&params) != SMS_OK) {
    return 1;
  }
  force = sms_frictionf(&params, &piston);
  printf("friction %.3f N\n", (double)force);
  return !(force > 38.0f && force < 200.0f);
}
