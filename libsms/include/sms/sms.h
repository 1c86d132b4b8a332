/* libsms, the C ABI: the equations of a pneumatic motion platform for firmware and for any other language.
 *
 * Conventions
 *   SI units everywhere, absolute pressures. The caller owns every struct; nothing is allocated, nothing is global,
 *   no call keeps a pointer. A name with the ending f works in float, the same name without it in double, as in
 *   <math.h>; both are always there. A function that can fail returns sms_status and leaves its outputs as they were.
 *
 * The mechanism is in kinematics.h and dynamics.h, its tables in table.h, the plants in plant.h; they come with this
 * header.
 *
 * Frames (kinematics.h)                           Order of calls
 *
 *        R -------- P_i      platform               sms_params_default       every parameter; change what differs
 *        :           |                              sms_params_check         against its bounds
 *        :           |  actuator i, or rod             |
 *        :           |                              sms_..._from_params      geometry, mechanism, bench, platform: made
 *     O -:--------- B_i ----> x, the roll axis         |                     once, again for other parameters
 *     |        ground                               sms_..._at_rest          where a run begins
 *     v z, down                                        |
 *     y points at the reader                        sms_..._advance          again and again: a command held for a period
 *                                                      |
 *     height is that of R above O: -z               sms_..._derivative       or an integrator of one's own
 *
 * Example: libsms/examples/01_friction.c */
#ifndef SMS_SMS_H
#define SMS_SMS_H

#include "sms/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status --------------------------------------------------------------------------------------------------- */
typedef enum sms_status {
  SMS_OK = 0,
  SMS_NOT_A_NUMBER = 1,     /* an input is NaN or infinite */
  SMS_OUT_OF_RANGE = 2,     /* an input lies outside what it can be; for a parameter: its bounds in params.def */
  SMS_OUT_OF_WORKSPACE = 3, /* no pose of the built mechanism fits */
  SMS_NOT_CONVERGED = 4     /* the bounded number of iterations did not suffice */
} sms_status;

/* What a status means, in a few words; never NULL. */
const char *sms_status_string(sms_status status);

/* SMS_VERSION of the library that is linked. */
const char *sms_version(void);

/* How the library was built: version, scalar types, C++ level, exceptions and RTTI, e.g.
 * "libsms 0.1.0 float+double c++14 no-exceptions no-rtti". */
const char *sms_build_info(void);

/* ---- parameters (params.def) ----------------------------------------------------------------------------------- */
typedef struct sms_params {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) double name;
#include "sms/params.def"
} sms_params;

typedef struct sms_paramsf {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) float name;
#include "sms/params.def"
} sms_paramsf;

/* Every parameter at its default. */
void sms_params_default(sms_params *params);
void sms_params_defaultf(sms_paramsf *params);

/* SMS_OK, or what is wrong with the first bad parameter, whose index goes to *index (untouched when all are good). */
sms_status sms_params_check(const sms_params *params, int *index);
sms_status sms_params_checkf(const sms_paramsf *params, int *index);

/* What params.def says of one parameter. */
typedef struct sms_param_info {
  const char *name;
  const char *unit;
  double lower;
  double value; /* the default */
  double upper;
  double uncertainty;
  const char *source;
  const char *doc;
} sms_param_info;

int sms_param_count(void);
/* NULL when index is not in 0 .. sms_param_count() - 1. */
const sms_param_info *sms_param_describe(int index);

/* ---- one cylinder (friction.hpp, piston.hpp) --------------------------------------------------------------------- */
typedef struct sms_piston {
  double extension;      /* x, m, 0 retracted */
  double velocity;       /* m/s, positive while extending */
  double acceleration;   /* m/s^2 */
  double pressure_lower; /* p_a, Pa absolute: extends the rod */
  double pressure_upper; /* p_b, Pa absolute; ambient for a single-acting cylinder */
} sms_piston;

typedef struct sms_pistonf {
  float extension;
  float velocity;
  float acceleration;
  float pressure_lower;
  float pressure_upper;
} sms_pistonf;

/* Friction force of the cylinder, N, positive against extension: eq. 6.5 to 6.7 and the effects on friction. */
double sms_friction(const sms_params *params, const sms_piston *piston);
float sms_frictionf(const sms_paramsf *params, const sms_pistonf *piston);

/* The simple friction law of eq. 4.33, N. */
double sms_friction_stribeck(const sms_params *params, double velocity);
float sms_friction_stribeckf(const sms_paramsf *params, float velocity);

/* Force with which the rod pushes on its load, N: the force balance of eq. 6.4 and 4.34. */
double sms_rod_force(const sms_params *params, const sms_piston *piston);
float sms_rod_forcef(const sms_paramsf *params, const sms_pistonf *piston);

#ifdef __cplusplus
}
#endif

#include "sms/dynamics.h"
#include "sms/kinematics.h"
#include "sms/plant.h"
#include "sms/table.h"

#endif
