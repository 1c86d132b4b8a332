/* Roll and pitch to extensions on a controller without the solver: a table in float, small enough for any flash. Here
 * it is solved at the start; ik_tables -o table.h writes one as a constant. Build: cc 04_table.c -lsms -lm */
#include <math.h>
#include <stdio.h>

#include "sms/sms.h"

enum { NODES = 11 }; /* from -0.1 to 0.1 rad in 20 mrad */

static float extensions[NODES * NODES * 3];

static const sms_tablef table = {
    {NODES, -0.1f, 0.1f, 50.0f}, {NODES, -0.1f, 0.1f, 50.0f}, {1, 0.5f, 0.5f, 0.0f}, extensions};

static sms_status solve(const sms_geometryf *geometry) {
  float *node = extensions;
  sms_posef pose;
  int i, k;
  sms_rest_posef(geometry, &pose);
  for (i = 0; i < NODES; ++i) {
    for (k = 0; k < NODES; ++k, node += 3) {
      const float q[3] = {-0.1f + 0.02f * (float)i, -0.1f + 0.02f * (float)k, 0.5f};
      const sms_status status = sms_inverse_kinematicsf(geometry, q, &pose, &pose, node, NULL);
      if (status != SMS_OK) {
        return status;
      }
    }
  }
  return SMS_OK;
}

int main(void) {
  const float q[3] = {0.043f, -0.017f, 0.5f};
  sms_paramsf params;
  sms_geometryf geometry;
  sms_posef pose;
  float direct[3], linear[3], cubic[3];
  int i;

  sms_params_defaultf(&params);
  sms_geometry_from_paramsf(&params, &geometry);
  if (solve(&geometry) != SMS_OK || sms_inverse_kinematicsf(&geometry, q, NULL, &pose, direct, NULL) != SMS_OK ||
      sms_table_bilinearf(&table, q[0], q[1], linear) != SMS_OK ||
      sms_table_bicubicf(&table, q[0], q[1], cubic) != SMS_OK) {
    return 1;
  }
  printf("actuator  extension [m]  bilinear, too large by [um]  bicubic [um]\n");
  for (i = 0; i < 3; ++i) {
    const double linear_error = (double)linear[i] - (double)direct[i],
                 cubic_error = (double)cubic[i] - (double)direct[i];
    printf("%8d  %13.6f  %27.2f  %12.2f\n", i + 1, (double)direct[i], 1e6 * linear_error, 1e6 * cubic_error);
    if (fabs(linear_error) > 40e-6 || fabs(cubic_error) > 2e-6) {
      return 1;
    }
  }
  printf("outside the table: %s\n", sms_status_string(sms_table_bilinearf(&table, 0.11f, 0.0f, linear)));
  return 0;
}
