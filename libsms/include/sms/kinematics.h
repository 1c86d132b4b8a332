/* libsms, kinematics of the platform on three actuators and three Panhard rods, for C. Part of sms.h, whose conventions
 * hold here.
 *
 * Frames: right-handed, z points down, x is the roll axis; R = Rz(yaw) Ry(pitch) Rx(roll). The driven coordinates are
 * q = (roll, pitch, height) in rad, rad, m; yaw, x and y follow from them by the rods and are called parasitic.
 * A three-element array that holds q', q'' or an extension has one element a coordinate or actuator, in that order.
 *
 * Example: libsms/examples/02_kinematics.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_KINEMATICS_H
#define SMS_KINEMATICS_H

#ifdef __cplusplus
extern "C" {
#endif

/* sms_geometry, sms_pose, sms_convergence, sms_motion, sms_joint_angles; in float sms_geometryf, ... */
#define SMS_STRUCTS "sms/kinematics_structs.def"
#include "sms/structs.h"

/* ---- geometry (geometry.hpp) ------------------------------------------------------------------------------------- */
/* Made once from the parameters, then handed to every call; parameters changed later need a new one.
 * SMS_WRONG_ABI. */
sms_status sms_geometry_from_params(const sms_params *params, sms_geometry *geometry);
sms_status sms_geometry_from_paramsf(const sms_paramsf *params, sms_geometryf *geometry);

/* Level, all actuators retracted. */
void sms_rest_pose(const sms_geometry *geometry, sms_pose *pose);
void sms_rest_posef(const sms_geometryf *geometry, sms_posef *pose);

/* ---- position (inverse_kinematics.hpp, forward_kinematics.hpp) --------------------------------------------------- */
/* Extensions, yaw, x and y of q = (roll, pitch, height).
 *
 *   start        where the search begins (its yaw, x, y): the last pose of a motion saves an iteration.
 *                NULL: the rest pose. It may be the very pose that is written.
 *   convergence  may be NULL.
 *
 * The stroke is no limit here: compare the extensions with 0 and geometry->stroke. SMS_NOT_A_NUMBER,
 * SMS_OUT_OF_WORKSPACE (tilt beyond 0.6 rad, or the rods do not reach), SMS_NOT_CONVERGED. */
sms_status sms_inverse_kinematics(const sms_geometry *geometry, const double q[3], const sms_pose *start,
                                  sms_pose *pose, double extension[3], sms_convergence *convergence);
sms_status sms_inverse_kinematicsf(const sms_geometryf *geometry, const float q[3], const sms_posef *start,
                                   sms_posef *pose, float extension[3], sms_convergencef *convergence);

/* The pose of three extensions; start, convergence and statuses as above. */
sms_status sms_forward_kinematics(const sms_geometry *geometry, const double extension[3], const sms_pose *start,
                                  sms_pose *pose, sms_convergence *convergence);
sms_status sms_forward_kinematicsf(const sms_geometryf *geometry, const float extension[3], const sms_posef *start,
                                   sms_posef *pose, sms_convergencef *convergence);

#ifndef SMS_FLOAT_ONLY
/* The same for n rows of three numbers, with the bits of n calls; on an x86 processor with AVX2 four rows at a time.
 *
 *   start        n poses, or NULL; they may be the very poses that are written
 *   pose, extension (n x 3), status
 *                one a row; pose and extension of a row with another status than SMS_OK stay as they were
 *   convergence  n, or NULL
 *
 * The first status that is not SMS_OK, or SMS_OK. */
sms_status sms_inverse_kinematics_array(const sms_geometry *geometry, size_t n, const double *q, const sms_pose *start,
                                        sms_pose *pose, double *extension, sms_convergence *convergence,
                                        sms_status *status);
sms_status sms_forward_kinematics_array(const sms_geometry *geometry, size_t n, const double *extension,
                                        const sms_pose *start, sms_pose *pose, sms_convergence *convergence,
                                        sms_status *status);
#endif

/* Lengths of all six links, m, where all six coordinates of the pose are free: the inverse kinematics of a
 * Gough-Stewart platform (eq. 3.6). SMS_NOT_A_NUMBER. */
sms_status sms_six_leg_inverse(const sms_geometry *geometry, const sms_pose *pose, double length[6]);
sms_status sms_six_leg_inversef(const sms_geometryf *geometry, const sms_posef *pose, float length[6]);

/* ---- velocity and acceleration (motion.hpp) ---------------------------------------------------------------------- */
/* From q' and q''. SMS_NOT_A_NUMBER. */
sms_status sms_inverse_motion(const sms_geometry *geometry, const sms_pose *pose, const double qdot[3],
                              const double qddot[3], sms_motion *motion);
sms_status sms_inverse_motionf(const sms_geometryf *geometry, const sms_posef *pose, const float qdot[3],
                               const float qddot[3], sms_motionf *motion);

/* From the extensions' rates and accelerations. SMS_NOT_A_NUMBER. */
sms_status sms_forward_motion(const sms_geometry *geometry, const sms_pose *pose, const double extension_rate[3],
                              const double extension_acceleration[3], sms_motion *motion);
sms_status sms_forward_motionf(const sms_geometryf *geometry, const sms_posef *pose, const float extension_rate[3],
                               const float extension_acceleration[3], sms_motionf *motion);

/* J = d extension / d(roll, pitch, height) along the rods' constraint, row i of actuator i; m/rad, m/rad, m/m.
 * SMS_NOT_A_NUMBER. */
sms_status sms_jacobian(const sms_geometry *geometry, const sms_pose *pose, double jacobian[3][3]);
sms_status sms_jacobianf(const sms_geometryf *geometry, const sms_posef *pose, float jacobian[3][3]);

/* d extension / d(roll, pitch, height, yaw, x, y) with all six coordinates free. SMS_NOT_A_NUMBER. */
sms_status sms_pose_jacobian(const sms_geometry *geometry, const sms_pose *pose, double jacobian[3][6]);
sms_status sms_pose_jacobianf(const sms_geometryf *geometry, const sms_posef *pose, float jacobian[3][6]);

/* ---- workspace (workspace.hpp) ----------------------------------------------------------------------------------- */
/* Stroke left over by the actuator nearest to one of its ends, m; negative outside. */
double sms_stroke_margin(const sms_geometry *geometry, const double extension[3]);
float sms_stroke_marginf(const sms_geometryf *geometry, const float extension[3]);

/* Least stroke margin, m, on the edges of |roll| <= roll_limit, |pitch| <= pitch_limit (rad) at a height.
 * SMS_NOT_A_NUMBER, SMS_OUT_OF_WORKSPACE, SMS_NOT_CONVERGED. */
sms_status sms_rectangle_margin(const sms_geometry *geometry, double height, double roll_limit, double pitch_limit,
                                double *margin);
sms_status sms_rectangle_marginf(const sms_geometryf *geometry, float height, float roll_limit, float pitch_limit,
                                 float *margin);

/* The largest tilt that the stroke allows at a height in one direction, rad: roll = angle * direction_roll and pitch =
 * angle * direction_pitch, a unit vector. SMS_NOT_A_NUMBER, SMS_OUT_OF_WORKSPACE: not even level fits. */
sms_status sms_reach(const sms_geometry *geometry, double height, double direction_roll, double direction_pitch,
                     double *angle);
sms_status sms_reachf(const sms_geometryf *geometry, float height, float direction_roll, float direction_pitch,
                      float *angle);

/* The joints' angles in a pose that fits the rods. SMS_NOT_A_NUMBER. */
sms_status sms_joint_angles_at(const sms_geometry *geometry, const sms_pose *pose, sms_joint_angles *angles);
sms_status sms_joint_angles_atf(const sms_geometryf *geometry, const sms_posef *pose, sms_joint_anglesf *angles);

/* Distance from singularity, 1 is best: condition numbers in m and rad of the rods' lengths by (yaw, x, y), and of all
 * six lengths by the whole pose. SMS_NOT_A_NUMBER. */
sms_status sms_conditioning(const sms_geometry *geometry, const sms_pose *pose, double *panhard, double *links);
sms_status sms_conditioningf(const sms_geometryf *geometry, const sms_posef *pose, float *panhard, float *links);

#ifdef __cplusplus
}
#endif

#endif
