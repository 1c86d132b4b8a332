/* A C99 program that links libsms: what it checks is that the ABI is C, in both precisions. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sms/sms.h"

static int failures = 0;

static int close_to(double a, double b, double tolerance) { return fabs(a - b) <= tolerance; }

static void check(int ok, const char *what) {
  if (!ok) {
    printf("FAILED: %s\n", what);
    ++failures;
  }
}

/* Inverse kinematics there, forward kinematics back, in both precisions; failures touch nothing. */
static void check_kinematics(const sms_params *params, const sms_paramsf *paramsf) {
  sms_geometry geometry;
  sms_geometryf geometryf;
  sms_pose pose, back;
  sms_posef posef, backf;
  sms_convergence convergence;
  sms_motion motion, motion_back;
  double q[3] = {0.05, -0.02, 0.5}, qdot[3] = {0.1, -0.2, 0.3}, qddot[3] = {1.0, 2.0, -3.0};
  double extension[3] = {7.0, 7.0, 7.0}, jacobian[3][3], by_pose[3][6], length[6];
  float qf[3] = {0.05f, -0.02f, 0.5f}, extensionf[3];
  int i, k;

  sms_geometry_from_params(params, &geometry);
  sms_geometry_from_paramsf(paramsf, &geometryf);
  check(close_to(geometry.actuator_length[0], 0.7240001, 1e-6), "length of a retracted actuator");
  check(close_to(geometry.panhard_length[2], 1.55486010, 1e-6), "length of a Panhard rod");
  check(geometry.base[3][1] == params->base_joint_4_y && geometry.stroke == params->stroke,
        "fields are where C has them");
  sms_rest_pose(&geometry, &pose);
  check(pose.roll == 0.0 && pose.height == -params->reference_point_z, "the rest pose");

  check(sms_inverse_kinematics(&geometry, q, NULL, &pose, extension, &convergence) == SMS_OK, "inverse kinematics");
  check(convergence.iterations > 0 && convergence.residual < 1e-14, "converged");
  check(sms_inverse_kinematicsf(&geometryf, qf, NULL, &posef, extensionf, NULL) == SMS_OK, "in float");
  check(sms_forward_kinematics(&geometry, extension, NULL, &back, &convergence) == SMS_OK, "forward kinematics");
  check(sms_forward_kinematicsf(&geometryf, extensionf, &posef, &backf, NULL) == SMS_OK, "in float");
  check(close_to(back.roll, q[0], 1e-14) && close_to(back.height, q[2], 1e-14), "there and back");
  check(close_to((double)backf.pitch, q[1], 2e-6), "there and back, float");
  check(sms_six_leg_inverse(&geometry, &pose, length) == SMS_OK, "six legs");
  for (i = 0; i < 3; ++i) {
    check(close_to((double)extensionf[i], extension[i], 2e-6), "extension, float against double");
    check(close_to(length[i] - geometry.actuator_length[i], extension[i], 1e-15), "a leg is its actuator");
    check(close_to(length[3 + i], geometry.panhard_length[i], 1e-14), "a rod keeps its length");
  }

  check(sms_inverse_motion(&geometry, &pose, qdot, qddot, &motion) == SMS_OK, "inverse motion");
  check(sms_forward_motion(&geometry, &pose, motion.extension_rate, motion.extension_acceleration, &motion_back) ==
            SMS_OK,
        "forward motion");
  check(sms_jacobian(&geometry, &pose, jacobian) == SMS_OK, "Jacobian");
  check(sms_pose_jacobian(&geometry, &pose, by_pose) == SMS_OK, "Jacobian by the whole pose");
  for (i = 0; i < 3; ++i) {
    double rate = 0.0, by_six = 0.0;
    for (k = 0; k < 3; ++k) {
      rate += jacobian[i][k] * qdot[k];
      by_six += by_pose[i][k] * qdot[k] + by_pose[i][3 + k] * motion.parasitic_rate[k];
    }
    check(close_to(rate, motion.extension_rate[i], 1e-15), "J is row by row in C");
    check(close_to(by_six, motion.extension_rate[i], 1e-15), "so is the 3x6 one");
    check(close_to(motion_back.qdot[i], qdot[i], 1e-14), "rates there and back");
    check(close_to(motion_back.qddot[i], qddot[i], 1e-13), "accelerations there and back");
  }

  {
    double panhard = 0.0, links = 0.0, angle = 0.0, margin = 0.0;
    sms_joint_angles angles;
    check(sms_conditioning(&geometry, &pose, &panhard, &links) == SMS_OK && panhard < 1.2 && links < 2.0, "condition");
    check(sms_joint_angles_at(&geometry, &pose, &angles) == SMS_OK && angles.base[0] < 0.3, "joint angles");
    check(sms_reach(&geometry, 0.5, 1.0, 0.0, &angle) == SMS_OK && close_to(angle, 0.1714, 1e-4), "9.82 deg of roll");
    check(sms_rectangle_margin(&geometry, 0.5, 0.1, 0.1, &margin) == SMS_OK && margin > 0.0, "5.7 by 5.7 deg fits");
    check(sms_reach(&geometry, 0.2, 1.0, 0.0, &angle) == SMS_OUT_OF_WORKSPACE && angle > 0.1, "too low, untouched");
    check(sms_stroke_margin(&geometry, extension) <= 0.2, "stroke margin");
  }

  extension[0] = 7.0;
  q[0] = 0.7;
  check(sms_inverse_kinematics(&geometry, q, NULL, &back, extension, NULL) == SMS_OUT_OF_WORKSPACE,
        "40 deg is refused");
  q[0] = sqrt(-1.0);
  check(sms_inverse_kinematics(&geometry, q, NULL, &back, extension, &convergence) == SMS_NOT_A_NUMBER,
        "NaN is refused");
  check(extension[0] == 7.0 && close_to(back.pitch, -0.02, 1e-14), "and nothing was written");
}

/* The equation of motion, there and back, for every reading of the mass table and in both precisions. */
static void check_dynamics(const sms_params *params, const sms_paramsf *paramsf) {
  const double q[3] = {0.05, -0.02, 0.5}, qdot[3] = {0.1, -0.2, 0.3}, force[3] = {1000.0, 1100.0, 900.0};
  const float qf[3] = {0.05f, -0.02f, 0.5f}, qdotf[3] = {0.1f, -0.2f, 0.3f}, forcef[3] = {1000.0f, 1100.0f, 900.0f};
  const sms_wrench wrench = {{10.0, 20.0, -30.0}, {5.0, 6.0, 7.0}};
  sms_mechanism mechanism;
  sms_mechanismf mechanismf;
  sms_dynamics dynamics;
  sms_dynamicsf dynamicsf;
  sms_linear_model model;
  sms_actuator_law law;
  double qddot[3], back[3], untouched[3] = {7.0, 7.0, 7.0}, push = 0.0, pull = 0.0;
  float qddotf[3];
  int masses, i, k;

  for (masses = SMS_MASSES_CORRECTED; masses <= SMS_MASSES_LUMPED; ++masses) {
    check(sms_mechanism_from_params(params, (sms_mass_model)masses, &mechanism) == SMS_OK, "mass model");
    check(mechanism.gravity == params->gravity, "fields are where C has them");
    check(mechanism.moving ==
              (masses == SMS_MASSES_CORRECTED || masses == SMS_MASSES_TABLE ? SMS_MOVING_ALL : SMS_MOVING_PLATFORM),
          "what moves");
    check(sms_mechanism_from_paramsf(paramsf, (sms_mass_model)masses, &mechanismf) == SMS_OK, "in float");
    check(sms_forward_dynamics(&mechanism, q, qdot, force, &wrench, NULL, qddot) == SMS_OK, "forward dynamics");
    check(sms_inverse_dynamics(&mechanism, q, qdot, qddot, &wrench, NULL, back) == SMS_OK, "inverse dynamics");
    check(sms_forward_dynamics(&mechanism, q, qdot, force, NULL, NULL, qddot) == SMS_OK, "without a wrench");
    check(sms_forward_dynamicsf(&mechanismf, qf, qdotf, forcef, NULL, NULL, qddotf) == SMS_OK, "in float");
    for (i = 0; i < 3; ++i) {
      check(close_to(back[i], force[i], 1e-9), "forces there and back");
      check(close_to((double)qddotf[i], qddot[i], 1e-3), "accelerations, float against double");
    }
  }
  check(sms_mechanism_from_params(params, (sms_mass_model)4, &mechanism) == SMS_OUT_OF_RANGE, "no fifth mass model");

  check(sms_mechanism_from_params(params, SMS_MASSES_CORRECTED, &mechanism) == SMS_OK, "mass model");
  check(sms_forward_dynamics(&mechanism, q, qdot, force, NULL, NULL, qddot) == SMS_OK, "forward dynamics");
  check(sms_dynamics_at(&mechanism, q, qdot, NULL, &dynamics) == SMS_OK, "terms");
  check(sms_dynamics_atf(&mechanismf, qf, qdotf, NULL, &dynamicsf) == SMS_OK, "in float");
  for (i = 0; i < 3; ++i) {
    double left = dynamics.bias_force[i];
    for (k = 0; k < 3; ++k) {
      left += dynamics.mass_matrix[i][k] * qddot[k] - dynamics.jacobian[k][i] * force[k];
      check(close_to(dynamics.mass_matrix[i][k], dynamics.mass_matrix[k][i], 1e-12), "M is symmetric");
    }
    check(close_to(left, 0.0, 1e-9), "the equation holds");
  }
  check(dynamics.kinetic_energy > 0.0 && dynamics.potential_energy > 1000.0, "energies");

  check(sms_inverse_dynamics(&mechanism, q, NULL, NULL, NULL, NULL, law.force) == SMS_OK, "holding forces");
  for (i = 0; i < 3; ++i) {
    law.stiffness[i] = 36.0e3;
    law.damping[i] = 500.0;
  }
  check(sms_linearise(&mechanism, q, &law, NULL, &model) == SMS_OK, "linear model");
  check(model.a[0][3] == 1.0 && model.b[0][0] == 0.0, "x = (dq, dq')");
  check(model.eigenfrequency[0] > 1.5 && model.eigenfrequency[2] < 3.5, "eigenfrequencies");
  check(sms_end_stop_force(params, 0.2, 1.0) == 0.0 && sms_end_stop_force(params, -1e-3, 0.0) > 0.0, "end stop");
  check(sms_force_range(params, &push, &pull) == SMS_OK, "force range");
  check(push > pull && pull > 1042.0, "the supply can carry the payload");
  check(close_to(sms_force_share(params, force), 1100.0 / push, 1e-15), "with its largest force for a measure");

  law.stiffness[1] = sqrt(-1.0);
  check(sms_linearise(&mechanism, q, &law, NULL, &model) == SMS_NOT_A_NUMBER, "NaN is refused");
  check(sms_forward_dynamics(&mechanism, q, qdot, law.stiffness, NULL, NULL, untouched) == SMS_NOT_A_NUMBER &&
            untouched[0] == 7.0,
        "and nothing was written");
}

/* The plants in both precisions: they rest, they move alike, a fixed and an adaptive step agree, failures touch nothing. */
static void check_plants(const sms_params *params, const sms_paramsf *paramsf) {
  const double level[3] = {0.02, -0.01, 0.49};
  const float levelf[3] = {0.02f, -0.01f, 0.49f};
  sms_actuator_laws laws, bad;
  sms_bench bench;
  sms_benchf benchf;
  sms_bench_input input = {6.5, 20.0};
  sms_bench_inputf inputf = {6.5f, 20.0f};
  sms_bench_state state, fixed, rate;
  sms_bench_statef statef;
  sms_platform platform;
  sms_platformf platformf;
  sms_platform_input drive = {{5.0, 5.0, 5.0}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  sms_platform_inputf drivef = {{6.2f, 5.5f, 4.3f}, {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}}};
  sms_platform_state at, stepped, at_rate;
  sms_platform_statef atf;
  sms_platform_terms terms;
  sms_platform_termsf termsf;
  sms_stepping stepping;
  sms_steppingf steppingf;
  int i, k;

  sms_published_laws(&laws);
  bad = laws;
  bad.friction = (sms_friction_law)5;
  bench.params.bore_diameter = 7.0;
  check(sms_bench_from_params(params, &bad, &bench) == SMS_OUT_OF_RANGE && bench.params.bore_diameter == 7.0,
        "an unknown law is refused");
  check(sms_platform_from_params(params, &laws, (sms_mass_model)4, &platform) == SMS_OUT_OF_RANGE, "and a mass model");
  check(sms_bench_from_params(params, &laws, &bench) == SMS_OK, "a bench");
  check(sms_bench_from_paramsf(paramsf, &laws, &benchf) == SMS_OK, "a bench in float");
  check(sms_bench_at_rest(&bench, 0.1, 20.0, 333.0e3, &state) == SMS_OK, "at rest");
  check(sms_bench_at_restf(&benchf, 0.1f, 20.0f, 333.0e3f, &statef) == SMS_OK, "at rest, float");
  input.command = params->valve_centre;
  check(sms_bench_derivative(&bench, &state, &input, &rate) == SMS_OK && fabs(rate.velocity) < 1e-9, "rest is rest");
  input.command = 6.5;
  fixed = state;
  sms_stepping_begin(1e-8, &stepping);
  sms_stepping_beginf(1e-4f, &steppingf);
  check(sms_bench_advance(&bench, &input, 0.2, &stepping, &state) == SMS_OK && stepping.evaluations > 100, "it runs");
  check(sms_bench_advancef(&benchf, &inputf, 0.2f, &steppingf, &statef) == SMS_OK, "it runs in float");
  for (i = 0; i < 4000; ++i) {
    check(sms_bench_step(&bench, &input, 5e-5, &fixed) == SMS_OK, "a step");
  }
  check(state.extension > 0.12 && close_to(state.extension, fixed.extension, 1e-7), "adaptive against fixed steps");
  check(close_to((double)statef.extension, state.extension, 1e-4), "float against double");
  fixed = state;
  input.command = sqrt(-1.0);
  check(sms_bench_advance(&bench, &input, 0.2, &stepping, &state) == SMS_NOT_A_NUMBER, "NaN is refused");
  check(sms_bench_derivative(&bench, &state, &input, &rate) == SMS_NOT_A_NUMBER, "by all");
  input.command = 5.0;
  check(sms_bench_step(&bench, &input, 0.0, &state) == SMS_OUT_OF_RANGE, "no time is no step");
  stepping.tolerance = 0.0;
  check(sms_bench_advance(&bench, &input, 0.2, &stepping, &state) == SMS_OUT_OF_RANGE, "no tolerance neither");
  check(memcmp(&fixed, &state, sizeof state) == 0, "and the state is as it was");

  check(sms_platform_from_params(params, &laws, SMS_MASSES_CORRECTED, &platform) == SMS_OK, "a platform");
  check(sms_platform_from_paramsf(paramsf, &laws, SMS_MASSES_CORRECTED, &platformf) == SMS_OK, "a platform in float");
  check(sms_platform_at_rest(&platform, level, 333.0e3, &at) == SMS_OK, "at rest");
  check(sms_platform_at_restf(&platformf, levelf, 333.0e3f, &atf) == SMS_OK, "at rest, float");
  sms_platform_prepare(&platform, &terms);
  sms_platform_preparef(&platformf, &termsf);
  for (k = 0; k < 3; ++k) {
    drive.command[k] = params->valve_centre;
  }
  check(sms_platform_derivative(&platform, &at, &drive, &terms, &at_rate) == SMS_OK, "its derivative");
  check(fabs(at_rate.qdot[0]) + fabs(at_rate.qdot[1]) + fabs(at_rate.qdot[2]) < 1e-9, "rest is rest");
  check(at.actuator[2].supply_pressure == params->supply_pressure, "fields are where C has them");
  for (k = 0; k < 3; ++k) {
    drive.command[k] = (double)drivef.command[k];
  }
  stepped = at;
  sms_stepping_begin(1e-8, &stepping);
  sms_stepping_beginf(1e-4f, &steppingf);
  check(sms_platform_advance(&platform, &drive, 0.1, &stepping, &terms, &at) == SMS_OK, "it runs");
  check(sms_platform_advancef(&platformf, &drivef, 0.1f, &steppingf, &termsf, &atf) == SMS_OK, "it runs in float");
  for (i = 0; i < 2000; ++i) {
    check(sms_platform_step(&platform, &drive, 5e-5, &terms, &stepped) == SMS_OK, "a step");
  }
  check(terms.extension_rate[0] > terms.extension_rate[2] + 0.01, "each actuator its own way");
  for (k = 0; k < 3; ++k) {
    check(close_to(at.q[k], stepped.q[k], 1e-7), "adaptive against fixed steps");
    check(close_to((double)atf.q[k], at.q[k], 1e-4), "float against double");
  }
  stepped = at;
  at.q[0] = stepped.q[0] = 0.9;
  check(sms_platform_step(&platform, &drive, 1e-4, &terms, &at) == SMS_OUT_OF_WORKSPACE, "beyond the machine");
  check(sms_platform_advance(&platform, &drive, 1e-4, &stepping, &terms, &at) == SMS_OUT_OF_WORKSPACE, "either way");
  check(memcmp(&stepped, &at, sizeof at) == 0, "and the state is as it was");
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

  check(sms_params_default(&params) == SMS_OK && sms_params_defaultf(&paramsf) == SMS_OK, "of one ABI");
  check(sms_params_check(&params, &index) == SMS_OK && index == -1, "defaults are within bounds");
  check(sms_params_checkf(&paramsf, &index) == SMS_OK && index == -1, "float defaults are within bounds");

  force = sms_friction(&params, &piston);
  check(force > 38.0 && force < 200.0, "friction of a sliding piston");
  check(fabs(force - (double)sms_frictionf(&paramsf, &pistonf)) < 1e-4 * force, "float agrees with double");
  check(sms_friction_stribeck(&params, 0.0) == 0.0, "eq. 4.33 is zero at rest");
  check(fabs(sms_rod_force(&params, &piston) - (double)sms_rod_forcef(&paramsf, &pistonf)) < 0.05,
        "rod force, float against double");
  check_kinematics(&params, &paramsf);
  check_dynamics(&params, &paramsf);
  check_plants(&params, &paramsf);

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
