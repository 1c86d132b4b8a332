/* libsms, the plants: one actuator on the test bench, and the platform on three, for C. Part of sms.h, whose conventions
 * hold here. Air, valve, friction and mechanism as one derivative, a fixed step and an adaptive one: a controller under
 * test in C, or a model inside one.
 *
 * A plant is made once from the parameters and its laws. Its state is the caller's, and so is what the platform keeps
 * between two calls (sms_platform_terms). The input is held during a step: end a step where the command jumps.
 *
 * Example: libsms/examples/05_plant.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_PLANT_H
#define SMS_PLANT_H

#include "sms/dynamics.h"
#include "sms/pneumatics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- laws (actuator.hpp) ----------------------------------------------------------------------------------------- */
typedef enum sms_friction_law {
  SMS_FRICTION_ACCELERATION_DEPENDENT = 0, /* eq. 6.5: the default */
  SMS_FRICTION_TWO_BRANCH = 1,             /* eq. 6.2 */
  SMS_FRICTION_STRIBECK = 2,               /* eq. 6.1 */
  SMS_FRICTION_DAHL = 3,
  SMS_FRICTION_LUGRE = 4
} sms_friction_law;

typedef enum sms_drive_law {
  SMS_DRIVE_DIRECT = 0,  /* the command is the voltage at the valve: the default */
  SMS_DRIVE_FILTERED = 1 /* it passes the filter behind the pulse width (section 7.3.3) */
} sms_drive_law;

/* The laws are int: a compiler for controllers may store an enum in one octet, the C++ struct behind this one does not. */
typedef struct sms_actuator_laws {
  int valve;    /* sms_valve_law */
  int friction; /* sms_friction_law */
  int chamber;  /* sms_chamber_law */
  int drive;    /* sms_drive_law */
} sms_actuator_laws;

/* The source's own choice: all defaults. */
void sms_published_laws(sms_actuator_laws *laws);

/* ---- plants, states and inputs (bench.hpp, platform.hpp) --------------------------------------------------------- */
/* sms_actuator_state; sms_bench, sms_bench_state, sms_bench_input; sms_platform, sms_platform_state, sms_platform_input,
 * sms_platform_terms; sms_stepping; in float sms_actuator_statef, ... */
#define SMS_STRUCTS "sms/plant_structs.def"
#include "sms/structs.h"

/* SMS_OUT_OF_RANGE: there is no such law or mass model; SMS_WRONG_ABI. A platform has one set of parameters for all three actuators
 * until the caller changes platform->params[i]. */
sms_status sms_bench_from_params(const sms_params *params, const sms_actuator_laws *laws, sms_bench *bench);
sms_status sms_bench_from_paramsf(const sms_paramsf *params, const sms_actuator_laws *laws, sms_benchf *bench);
sms_status sms_platform_from_params(const sms_params *params, const sms_actuator_laws *laws, sms_mass_model masses,
                                    sms_platform *platform);
sms_status sms_platform_from_paramsf(const sms_paramsf *params, const sms_actuator_laws *laws, sms_mass_model masses,
                                     sms_platformf *platform);

/* At rest with closed valves: the load, or the weight in a pose, is carried, and the mean of the two pressures of each
 * actuator is as given, Pa. SMS_WRONG_ABI, SMS_NOT_A_NUMBER; for the platform the statuses of inverse kinematics
 * too. */
sms_status sms_bench_at_rest(const sms_bench *bench, double extension, double load_force, double mean_pressure,
                             sms_bench_state *state);
sms_status sms_bench_at_restf(const sms_benchf *bench, float extension, float load_force, float mean_pressure,
                              sms_bench_statef *state);
sms_status sms_platform_at_rest(const sms_platform *platform, const double q[3], double mean_pressure,
                                sms_platform_state *state);
sms_status sms_platform_at_restf(const sms_platformf *platform, const float q[3], float mean_pressure,
                                 sms_platform_statef *state);

/* The terms before the first call: the rest pose, and zeros. */
void sms_platform_prepare(const sms_platform *platform, sms_platform_terms *terms);
void sms_platform_preparef(const sms_platformf *platform, sms_platform_termsf *terms);

/* ---- motion (bench.hpp, platform.hpp, integrate.hpp, integrate_adaptive.hpp) ------------------------------------- */
/* The statuses from here on: SMS_WRONG_ABI; SMS_NOT_A_NUMBER for a state, an input or a rate that is none; SMS_OUT_OF_RANGE where a
 * chamber has no volume; SMS_OUT_OF_WORKSPACE, SMS_NOT_CONVERGED as in inverse kinematics. Nothing is written then. */

/* The state's derivative, a struct of the same fields per second. */
sms_status sms_bench_derivative(const sms_bench *bench, const sms_bench_state *state, const sms_bench_input *input,
                                sms_bench_state *rate);
sms_status sms_bench_derivativef(const sms_benchf *bench, const sms_bench_statef *state, const sms_bench_inputf *input,
                                 sms_bench_statef *rate);
sms_status sms_platform_derivative(const sms_platform *platform, const sms_platform_state *state,
                                   const sms_platform_input *input, sms_platform_terms *terms,
                                   sms_platform_state *rate);
sms_status sms_platform_derivativef(const sms_platformf *platform, const sms_platform_statef *state,
                                    const sms_platform_inputf *input, sms_platform_termsf *terms,
                                    sms_platform_statef *rate);

/* One step of the classical Runge-Kutta method over `duration`, s; in float 0.1 ms is a good size. SMS_OUT_OF_RANGE: it
 * is not positive. The terms are those of its last stage. */
sms_status sms_bench_step(const sms_bench *bench, const sms_bench_input *input, double duration,
                          sms_bench_state *state);
sms_status sms_bench_stepf(const sms_benchf *bench, const sms_bench_inputf *input, float duration,
                           sms_bench_statef *state);
sms_status sms_platform_step(const sms_platform *platform, const sms_platform_input *input, double duration,
                             sms_platform_terms *terms, sms_platform_state *state);
sms_status sms_platform_stepf(const sms_platformf *platform, const sms_platform_inputf *input, float duration,
                              sms_platform_termsf *terms, sms_platform_statef *state);

/* A careful first step. */
void sms_stepping_begin(double tolerance, sms_stepping *stepping);
void sms_stepping_beginf(float tolerance, sms_steppingf *stepping);

/* Over `duration`, s, in as many steps as the tolerance asks for; they stop at valve edges, reversals and ends of the
 * stroke. SMS_OUT_OF_RANGE also: duration or tolerance is not positive; SMS_NOT_CONVERGED: a step would be smaller
 * than 0.1 ns. The stepping too is untouched then. The terms are those of the end. */
sms_status sms_bench_advance(const sms_bench *bench, const sms_bench_input *input, double duration,
                             sms_stepping *stepping, sms_bench_state *state);
sms_status sms_bench_advancef(const sms_benchf *bench, const sms_bench_inputf *input, float duration,
                              sms_steppingf *stepping, sms_bench_statef *state);
sms_status sms_platform_advance(const sms_platform *platform, const sms_platform_input *input, double duration,
                                sms_stepping *stepping, sms_platform_terms *terms, sms_platform_state *state);
sms_status sms_platform_advancef(const sms_platformf *platform, const sms_platform_inputf *input, float duration,
                                 sms_steppingf *stepping, sms_platform_termsf *terms, sms_platform_statef *state);

#ifdef __cplusplus
}
#endif

#endif
