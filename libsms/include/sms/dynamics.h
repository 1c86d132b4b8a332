/* libsms, rigid-body dynamics of the whole mechanism in q = (roll, pitch, height), for C. Part of sms.h, whose
 * conventions hold here; frames and coordinates as in kinematics.h.
 *
 *   M(q) q'' + b(q, q') = J(q)^T F + Q
 *
 * M mass matrix, b bias force (Coriolis, centrifugal and weight), J = d extension / dq, F actuator forces (N, positive
 * pushing out), Q the generalised force of what else acts on the platform.
 *
 * Example: libsms/examples/03_dynamics.c */
#ifndef SMS_DYNAMICS_H
#define SMS_DYNAMICS_H

#include <stdbool.h>

#include "sms/kinematics.h"
#include "sms/sms.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- bodies (bodies.hpp) ----------------------------------------------------------------------------------------- */
/* Which reading of the mass table (Table 3.1), and how much of it. */
typedef enum sms_mass_model {
  SMS_MASSES_CORRECTED = 0, /* the whole mechanism, inertias as they must have been meant: the default */
  SMS_MASSES_TABLE = 1,     /* the whole mechanism, the table as it is printed */
  SMS_MASSES_PLATFORM = 2,  /* top frame and payload alone */
  SMS_MASSES_LUMPED = 3     /* the platform with pistons and half rods as points: cheap; heave off by 0.01 m/s^2 */
} sms_mass_model;

typedef struct sms_body {
  double mass;          /* kg */
  double cog[3];        /* centre of gravity, m */
  double inertia[3][3]; /* kg m^2 */
} sms_body;

typedef struct sms_bodyf {
  float mass;
  float cog[3];
  float inertia[3][3];
} sms_bodyf;

/* Everything that q, q' and forces are put into. Made once from the parameters. */
typedef struct sms_mechanism {
  sms_geometry geometry;
  sms_body platform;   /* platform axes, cog from the reference point, inertia about the cog */
  sms_body hung[6];    /* cylinder or rod, link axes, cog from B_i, inertia about B_i */
  sms_body sliding[3]; /* piston, link axes, cog from P_i, inertia about P_i */
  bool links_move;     /* false: the platform is all there is */
  double gravity;      /* m/s^2 */
} sms_mechanism;

typedef struct sms_mechanismf {
  sms_geometryf geometry;
  sms_bodyf platform;
  sms_bodyf hung[6];
  sms_bodyf sliding[3];
  bool links_move;
  float gravity;
} sms_mechanismf;

/* SMS_OUT_OF_RANGE: there is no such mass model. */
sms_status sms_mechanism_from_params(const sms_params *params, sms_mass_model masses, sms_mechanism *mechanism);
sms_status sms_mechanism_from_paramsf(const sms_paramsf *params, sms_mass_model masses, sms_mechanismf *mechanism);

/* ---- equation of motion (dynamics.hpp) --------------------------------------------------------------------------- */
/* The statuses from here on: SMS_NOT_A_NUMBER, SMS_OUT_OF_WORKSPACE, SMS_NOT_CONVERGED, as in inverse kinematics, where
 * each call begins; `start` is that of sms_inverse_kinematics. */

/* All that the equation is made of. */
typedef struct sms_dynamics {
  sms_pose pose;
  double jacobian[3][3];    /* J, row i of actuator i; m/rad, m/rad, m/m */
  double mass_matrix[3][3]; /* M; kg m^2, kg m, kg */
  double bias_force[3];     /* b; N m, N m, N */
  double gravity_force[3];  /* the weight's part of b, dU/dq; N m, N m, N */
  double kinetic_energy;    /* J */
  double potential_energy;  /* U, of the weights, J, zero at ground */
} sms_dynamics;

typedef struct sms_dynamicsf {
  sms_posef pose;
  float jacobian[3][3];
  float mass_matrix[3][3];
  float bias_force[3];
  float gravity_force[3];
  float kinetic_energy;
  float potential_energy;
} sms_dynamicsf;

sms_status sms_dynamics_at(const sms_mechanism *mechanism, const double q[3], const double qdot[3],
                           const sms_pose *start, sms_dynamics *dynamics);
sms_status sms_dynamics_atf(const sms_mechanismf *mechanism, const float q[3], const float qdot[3],
                            const sms_posef *start, sms_dynamicsf *dynamics);

/* Force and moment from outside on the platform, world axes, the moment about the reference point. */
typedef struct sms_wrench {
  double force[3];  /* N */
  double moment[3]; /* N m */
} sms_wrench;

typedef struct sms_wrenchf {
  float force[3];
  float moment[3];
} sms_wrenchf;

/* q'' under actuator forces and a wrench; wrench may be NULL: none. */
sms_status sms_forward_dynamics(const sms_mechanism *mechanism, const double q[3], const double qdot[3],
                                const double force[3], const sms_wrench *wrench, const sms_pose *start,
                                double qddot[3]);
sms_status sms_forward_dynamicsf(const sms_mechanismf *mechanism, const float q[3], const float qdot[3],
                                 const float force[3], const sms_wrenchf *wrench, const sms_posef *start,
                                 float qddot[3]);

/* The actuator forces, N, that give q''; with qdot and qddot NULL (at rest) those that hold the pose. */
sms_status sms_inverse_dynamics(const sms_mechanism *mechanism, const double q[3], const double *qdot,
                                const double *qddot, const sms_wrench *wrench, const sms_pose *start, double force[3]);
sms_status sms_inverse_dynamicsf(const sms_mechanismf *mechanism, const float q[3], const float *qdot,
                                 const float *qddot, const sms_wrenchf *wrench, const sms_posef *start, float force[3]);

/* ---- small motions (linear_dynamics.hpp) ------------------------------------------------------------------------- */
/* How each actuator answers to small motions about a pose. */
typedef struct sms_actuator_law {
  double force[3];     /* at the pose, N: the holding forces, for an equilibrium */
  double stiffness[3]; /* force lost per metre of extension, N/m */
  double damping[3];   /* force lost per m/s, N s/m */
} sms_actuator_law;

typedef struct sms_actuator_lawf {
  float force[3];
  float stiffness[3];
  float damping[3];
} sms_actuator_lawf;

/* M dq'' + D dq' + K dq = J^T dF, and the same as x' = A x + B dF with x = (dq, dq'). */
typedef struct sms_linear_model {
  double mass_matrix[3][3]; /* M */
  double damping[3][3];     /* D */
  double stiffness[3][3];   /* K */
  double a[6][6];
  double b[6][3];
  double eigenfrequency[3]; /* of K v = omega^2 M v, Hz, ascending omega^2; 0 where the mode does not oscillate */
  double growth_rate[3];    /* 1/s; 0 where it does */
  double mode[3][3];        /* column k: the shape v of mode k in q, v^T M v = 1 */
} sms_linear_model;

typedef struct sms_linear_modelf {
  float mass_matrix[3][3];
  float damping[3][3];
  float stiffness[3][3];
  float a[6][6];
  float b[6][3];
  float eigenfrequency[3];
  float growth_rate[3];
  float mode[3][3];
} sms_linear_modelf;

sms_status sms_linearise(const sms_mechanism *mechanism, const double q[3], const sms_actuator_law *law,
                         const sms_pose *start, sms_linear_model *model);
sms_status sms_linearisef(const sms_mechanismf *mechanism, const float q[3], const sms_actuator_lawf *law,
                          const sms_posef *start, sms_linear_modelf *model);

/* ---- actuator limits (end_stop.hpp, workspace.hpp) --------------------------------------------------------------- */
/* Force of end stops and cushions on the piston rod, N, positive pushing it out. */
double sms_end_stop_force(const sms_params *params, double extension, double velocity);
float sms_end_stop_forcef(const sms_paramsf *params, float extension, float velocity);

/* What a cylinder can push and pull with at the supply pressure, its other chamber vented, N. */
void sms_force_range(const sms_params *params, double *push, double *pull);
void sms_force_rangef(const sms_paramsf *params, float *push, float *pull);

/* The largest share of that range that one of three actuator forces needs, 1 at the limit. */
double sms_force_share(const sms_params *params, const double force[3]);
float sms_force_sharef(const sms_paramsf *params, const float force[3]);

#ifdef __cplusplus
}
#endif

#endif
