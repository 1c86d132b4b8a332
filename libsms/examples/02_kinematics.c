/* A roll of 3 deg at half a turn a second, sampled at 100 Hz: the extensions and rates the actuators must follow, and
 * the pose computed back from them. Every solve starts at the last pose. Build: cc 02_kinematics.c -lsms -lm */
#include <math.h>
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  const double pi = 3.14159265358979324, amplitude = 3.0 * pi / 180.0, omega = 2.0 * pi * 0.5;
  sms_params params;
  sms_geometry geometry;
  sms_pose pose, back;
  sms_convergence convergence;
  double largest_error = 0.0;
  int i;

  sms_params_default(&params);
  sms_geometry_from_params(&params, &geometry);
  sms_rest_pose(&geometry, &pose);
  back = pose;
  printf("time [s]  roll [rad]  extensions [m]              rates [m/s]                yaw [rad]  Newton steps\n");
  for (i = 0; i <= 200; ++i) {
    const double time = 0.01 * i, wave = omega * time;
    double q[3] = {0.0, 0.0, 0.5}, qdot[3] = {0.0, 0.0, 0.0}, qddot[3] = {0.0, 0.0, 0.0}, extension[3];
    sms_motion motion;
    sms_status status;

    q[0] = amplitude * sin(wave);
    qdot[0] = amplitude * omega * cos(wave);
    qddot[0] = -amplitude * omega * omega * sin(wave);
    status = sms_inverse_kinematics(&geometry, q, &pose, &pose, extension, &convergence);
    if (status == SMS_OK) {
      status = sms_inverse_motion(&geometry, &pose, qdot, qddot, &motion);
    }
    if (status == SMS_OK) {
      status = sms_forward_kinematics(&geometry, extension, &back, &back, NULL);
    }
    if (status != SMS_OK) {
      printf("at %.2f s: %s\n", time, sms_status_string(status));
      return 1;
    }
    largest_error = fmax(largest_error, fabs(back.roll - q[0]));
    if (i % 25 == 0) {
      printf("%8.2f %11.5f  %8.5f %8.5f %8.5f  %8.5f %8.5f %8.5f  %9.6f  %d\n", time, q[0], extension[0], extension[1],
             extension[2], motion.extension_rate[0], motion.extension_rate[1], motion.extension_rate[2], pose.yaw,
             convergence.iterations);
    }
  }
  printf("there and back, largest error of roll: %.1e rad\n", largest_error);
  return !(largest_error < 1e-12);
}
