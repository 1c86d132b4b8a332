/* A C99 program that links libsms: what it checks is that the ABI is C, in both precisions. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sms/sms.h"

static int failures = 0;

static void check(int ok, const char *what) {
  if (!ok) {
    printf("FAILED: %s\n", what);
    ++failures;
  }
}

int main(void) {
  sms_params params;
  sms_paramsf paramsf;
  sms_piston piston = {0.2, 0.1, 0.3, 386.0e3, 281.0e3};
  sms_pistonf pistonf = {0.2f, 0.1f, 0.3f, 386.0e3f, 281.0e3f};
  int index = -1;
  double force;

  printf("%s\n", sms_build_info());
  check(strstr(sms_build_info(), "float+double") != NULL, "the archive has both precisions");
  check(strstr(sms_build_info(), "no-exceptions no-rtti") != NULL, "built as firmware builds it");
  check(strcmp(sms_version(), SMS_VERSION) == 0, "header and archive are of one version");

  sms_params_default(&params);
  sms_params_defaultf(&paramsf);
  check(sms_params_check(&params, &index) == SMS_OK && index == -1, "defaults are within bounds");
  check(sms_params_checkf(&paramsf, &index) == SMS_OK && index == -1, "float defaults are within bounds");

  force = sms_friction(&params, &piston);
  check(force > 38.0 && force < 200.0, "friction of a sliding piston");
  check(fabs(force - (double)sms_frictionf(&paramsf, &pistonf)) < 1e-4 * force, "float agrees with double");
  check(sms_friction_stribeck(&params, 0.0) == 0.0, "eq. 4.33 is zero at rest");
  check(fabs(sms_rod_force(&params, &piston) - (double)sms_rod_forcef(&paramsf, &pistonf)) < 0.05,
        "rod force, float against double");

  params.bore_diameter = -1.0;
  check(sms_params_check(&params, &index) == SMS_OUT_OF_RANGE, "a negative bore is refused");
  check(index >= 0 && strcmp(sms_param_describe(index)->name, "bore_diameter") == 0, "and named");
  params.bore_diameter = sqrt(-1.0);
  check(sms_params_check(&params, &index) == SMS_NOT_A_NUMBER, "NaN is refused");
  check(sms_param_describe(sms_param_count()) == NULL && sms_param_describe(-1) == NULL, "no parameter out there");
  check(strcmp(sms_status_string(SMS_NOT_CONVERGED), "") != 0, "every status has words");

  printf("%s\n", failures == 0 ? "ok" : "failed");
  return failures != 0;
}
