/* libsms, rigid-body dynamics of the whole mechanism in q = (roll, pitch, height), for C. Part of sms.h, whose
 * conventions hold here; frames and coordinates as in kinematics.h.
 *
 *   M(q) q'' + b(q, q') = J(q)^T F + Q
 *
 * M mass matrix, b bias force (Coriolis, centrifugal and weight), J = d extension / dq, F actuator forces (N, positive
 * pushing out), Q the generalised force of what else acts on the platform.
 *
 * Example: libsms/examples/03_dynamics.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_DYNAMICS_H
#define SMS_DYNAMICS_H

#include "sms/kinematics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* sms_body, sms_mechanism, sms_dynamics, sms_wrench, sms_actuator_law, sms_linear_model; in float sms_bodyf, ... */
#define SMS_STRUCTS "sms/dynamics_structs.def"
#include "sms/structs.h"

/* ---- bodies (bodies.hpp) ----------------------------------------------------------------------------------------- */
/* Which reading of the mass table (Table 3.1), and how much of it. */
typedef enum sms_mass_model {
  SMS_MASSES_CORRECTED = 0, /* the whole mechanism, inertias as they must have been meant: the default */
  SMS_MASSES_TABLE = 1,     /* the whole mechanism, the table as it is printed */
  SMS_MASSES_PLATFORM = 2,  /* top frame and payload alone */
  SMS_MASSES_LUMPED = 3     /* the platform with pistons and half rods as points: cheap; heave off by 0.01 m/s^2 */
} sms_mass_model;

/* What of it moves. */
typedef enum sms_moving_bodies {
  SMS_MOVING_PLATFORM = 0, /* the links' masses are none, or lumped into the platform */
  SMS_MOVING_ALL = 1       /* platform, cylinders, pistons and rods */
} sms_moving_bodies;

/* SMS_OUT_OF_RANGE: there is no such mass model; SMS_WRONG_ABI. */
sms_status sms_mechanism_from_params(const sms_params *params, sms_mass_model masses, sms_mechanism *mechanism);
sms_status sms_mechanism_from_paramsf(const sms_paramsf *params, sms_mass_model masses, sms_mechanismf *mechanism);

/* ---- equation of motion (dynamics.hpp) --------------------------------------------------------------------------- */
/* The statuses from here on: SMS_NOT_A_NUMBER, SMS_OUT_OF_WORKSPACE, SMS_NOT_CONVERGED, as in inverse kinematics, where
 * each call begins; `start` is that of sms_inverse_kinematics. */

sms_status sms_dynamics_at(const sms_mechanism *mechanism, const double q[3], const double qdot[3],
                           const sms_pose *start, sms_dynamics *dynamics);
sms_status sms_dynamics_atf(const sms_mechanismf *mechanism, const float q[3], const float qdot[3],
                            const sms_posef *start, sms_dynamicsf *dynamics);

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
sms_status sms_linearise(const sms_mechanism *mechanism, const double q[3], const sms_actuator_law *law,
                         const sms_pose *start, sms_linear_model *model);
sms_status sms_linearisef(const sms_mechanismf *mechanism, const float q[3], const sms_actuator_lawf *law,
                          const sms_posef *start, sms_linear_modelf *model);

/* ---- actuator limits (end_stop.hpp, workspace.hpp) --------------------------------------------------------------- */
/* Force of end stops and cushions on the piston rod, N, positive pushing it out. */
double sms_end_stop_force(const sms_params *params, double extension, double velocity);
float sms_end_stop_forcef(const sms_paramsf *params, float extension, float velocity);

/* What a cylinder can push and pull with at the supply pressure, its other chamber vented, N. SMS_WRONG_ABI. */
sms_status sms_force_range(const sms_params *params, double *push, double *pull);
sms_status sms_force_rangef(const sms_paramsf *params, float *push, float *pull);

/* The largest share of that range that one of three actuator forces needs, 1 at the limit. */
double sms_force_share(const sms_params *params, const double force[3]);
float sms_force_sharef(const sms_paramsf *params, const float force[3]);

#ifdef __cplusplus
}
#endif

#endif
