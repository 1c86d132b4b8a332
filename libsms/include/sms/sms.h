/* libsms, the C ABI: the equations of a pneumatic motion platform for firmware and for any other language.
 *
 * Conventions
 *   SI units everywhere, absolute pressures. The caller owns every struct; nothing is allocated, nothing is global,
 *   no call keeps a pointer. A name with the ending f works in float, the same name without it in double, as in
 *   <math.h>; both are always there, and a struct is written once for both (..._structs.def). A function that can fail
 *   returns sms_status and leaves its outputs as they were.
 *
 * Headers and library fit together, or the first call says so. sms_params_default writes into the parameters which
 * headers they are of, and every function that takes parameters, or a plant made of them, compares that with its own:
 * where they differ it returns SMS_WRONG_ABI, and NaN where it returns a number.
 *
 * The mechanism is in kinematics.h and dynamics.h, its tables in table.h, valve and chambers in pneumatics.h, controllers
 * in controller.h, the plants in plant.h; they come with this header.
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

#include <stddef.h>
#include <stdint.h>

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
  SMS_NOT_CONVERGED = 4,    /* the bounded number of iterations did not suffice */
  SMS_WRONG_ABI = 5         /* parameters that were not initialised, or of other headers than the library's */
} sms_status;

/* What a status means, in a few words; never NULL. */
const char *sms_status_string(sms_status status);

/* SMS_VERSION of the library that is linked. */
const char *sms_version(void);

/* How the library was built: version, scalar types, C++ level, exceptions and RTTI, e.g.
 * "libsms 0.2.0 float+double c++14 no-exceptions no-rtti". */
const char *sms_build_info(void);

/* ---- parameters (params.def) ----------------------------------------------------------------------------------- */
/* sms_params and sms_piston; in float sms_paramsf and sms_pistonf. */
#define SMS_STRUCTS "sms/sms_structs.def"
#include "sms/structs.h"

/* Every parameter at its default: the first call. SMS_WRONG_ABI, and nothing is written: the library that is linked was
 * built from other headers than the program. */
sms_status sms_params_init(unsigned long abi, size_t size, sms_params *params);
sms_status sms_params_initf(unsigned long abi, size_t size, sms_paramsf *params);

/* The same, with the number and the size that the program was compiled with. */
static inline sms_status sms_params_default(sms_params *params) {
  return sms_params_init(SMS_ABI, sizeof(sms_params), params);
}
static inline sms_status sms_params_defaultf(sms_paramsf *params) {
  return sms_params_initf(SMS_ABI, sizeof(sms_paramsf), params);
}

/* SMS_OK, or what is wrong with the first bad parameter, whose index goes to *index (untouched when all are good, and
 * with SMS_WRONG_ABI). */
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
/* NaN where an input is NaN or infinite. */
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

#include "sms/controller.h"
#include "sms/dynamics.h"
#include "sms/kinematics.h"
#include "sms/plant.h"
#include "sms/pneumatics.h"
#include "sms/table.h"

#endif
