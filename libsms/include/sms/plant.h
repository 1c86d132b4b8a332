/* libsms, the plants: one actuator on the test bench, and the platform on three, for C. Part of sms.h, whose conventions
 * hold here. Air, valve, friction and mechanism as one derivative, a fixed step and an adaptive one: a controller under
 * test in C, or a model inside one.
 *
 * A plant is made once from the parameters and its laws. Its state is the caller's, and so is what the platform keeps
 * between two calls (sms_platform_terms). The input is held during a step: end a step where the command jumps.
 *
 * Example: libsms/examples/05_plant.c */
#ifndef SMS_PLANT_H
#define SMS_PLANT_H

#include <stdbool.h>

#include "sms/dynamics.h"
#include "sms/sms.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- laws (actuator.hpp) ----------------------------------------------------------------------------------------- */
typedef enum sms_valve_law {
  SMS_VALVE_ISO_0_4_MPA = 0, /* the table measured at 0.4 MPa gauge: the default */
  SMS_VALVE_ISO_0_2_MPA = 1, /* the one at 0.2 MPa */
  SMS_VALVE_CLASSIC = 2      /* orifice area and discharge coefficient */
} sms_valve_law;

typedef enum sms_friction_law {
  SMS_FRICTION_ACCELERATION_DEPENDENT = 0, /* eq. 6.5: the default */
  SMS_FRICTION_TWO_BRANCH = 1,             /* eq. 6.2 */
  SMS_FRICTION_STRIBECK = 2,               /* eq. 6.1 */
  SMS_FRICTION_DAHL = 3,
  SMS_FRICTION_LUGRE = 4
} sms_friction_law;

typedef enum sms_chamber_law {
  SMS_CHAMBER_POLYTROPIC = 0, /* eq. 4.30: the default */
  SMS_CHAMBER_ENERGY = 1      /* temperature a state, heat through the wall */
} sms_chamber_law;

/* The laws are int: a compiler for controllers may store an enum in one octet, the C++ struct behind this one does not. */
typedef struct sms_actuator_laws {
  int valve;         /* sms_valve_law */
  int friction;      /* sms_friction_law */
  int chamber;       /* sms_chamber_law */
  bool drive_filter; /* the command passes the filter behind the pulse width (section 7.3.3) */
} sms_actuator_laws;

/* The source's own choice: all defaults, no filter. */
void sms_published_laws(sms_actuator_laws *laws);

/* ---- states and inputs ------------------------------------------------------------------------------------------- */
typedef struct sms_gas {
  double pressure;    /* Pa absolute */
  double temperature; /* K */
} sms_gas;

typedef struct sms_gasf {
  float pressure;
  float temperature;
} sms_gasf;

typedef struct sms_lag {
  double value;
  double rate; /* per second */
} sms_lag;

typedef struct sms_lagf {
  float value;
  float rate;
} sms_lagf;

typedef struct sms_actuator_state {
  sms_gas lower;          /* chamber that extends the rod */
  sms_gas upper;          /* chamber that retracts it */
  sms_lag spool;          /* as the command that would hold it there: V, V/s */
  sms_lag drive;          /* voltage at the valve, V, V/s; with drive_filter */
  double deflection;      /* of the seals, m; Dahl, LuGre, presliding_share */
  double supply_pressure; /* in the reservoir at the valve, Pa; with supply_line_resistance */
  double film;            /* speed of the lubricant's film, m/s; with friction_lag */
} sms_actuator_state;

typedef struct sms_actuator_statef {
  sms_gasf lower;
  sms_gasf upper;
  sms_lagf spool;
  sms_lagf drive;
  float deflection;
  float supply_pressure;
  float film;
} sms_actuator_statef;

typedef struct sms_bench_state {
  double extension; /* m, 0 retracted */
  double velocity;  /* m/s */
  sms_actuator_state actuator;
} sms_bench_state;

typedef struct sms_bench_statef {
  float extension;
  float velocity;
  sms_actuator_statef actuator;
} sms_bench_statef;

typedef struct sms_bench_input {
  double command;    /* V, 0 to 10 */
  double load_force; /* N, against extension */
} sms_bench_input;

typedef struct sms_bench_inputf {
  float command;
  float load_force;
} sms_bench_inputf;

typedef struct sms_platform_state {
  double q[3];    /* roll, pitch, rad; height, m */
  double qdot[3]; /* rad/s, rad/s, m/s */
  sms_actuator_state actuator[3];
} sms_platform_state;

typedef struct sms_platform_statef {
  float q[3];
  float qdot[3];
  sms_actuator_statef actuator[3];
} sms_platform_statef;

typedef struct sms_platform_input {
  double command[3]; /* V, 0 to 10 */
  sms_wrench wrench;
} sms_platform_input;

typedef struct sms_platform_inputf {
  float command[3];
  sms_wrenchf wrench;
} sms_platform_inputf;

/* ---- plants ------------------------------------------------------------------------------------------------------ */
typedef struct sms_bench {
  sms_params params;
  sms_actuator_laws laws;
} sms_bench;

typedef struct sms_benchf {
  sms_paramsf params;
  sms_actuator_laws laws;
} sms_benchf;

typedef struct sms_platform {
  sms_mechanism mechanism;
  sms_params params[3]; /* of each actuator */
  sms_actuator_laws laws;
} sms_platform;

typedef struct sms_platformf {
  sms_mechanismf mechanism;
  sms_paramsf params[3];
  sms_actuator_laws laws;
} sms_platformf;

/* SMS_OUT_OF_RANGE: there is no such law or mass model. A platform has one set of parameters for all three actuators
 * until the caller changes platform->params[i]. */
sms_status sms_bench_from_params(const sms_params *params, const sms_actuator_laws *laws, sms_bench *bench);
sms_status sms_bench_from_paramsf(const sms_paramsf *params, const sms_actuator_laws *laws, sms_benchf *bench);
sms_status sms_platform_from_params(const sms_params *params, const sms_actuator_laws *laws, sms_mass_model masses,
                                    sms_platform *platform);
sms_status sms_platform_from_paramsf(const sms_paramsf *params, const sms_actuator_laws *laws, sms_mass_model masses,
                                     sms_platformf *platform);

/* At rest with closed valves: the load, or the weight in a pose, is carried, and the mean of the two pressures of each
 * actuator is as given, Pa. SMS_NOT_A_NUMBER; for the platform the statuses of inverse kinematics too. */
sms_status sms_bench_at_rest(const sms_bench *bench, double extension, double load_force, double mean_pressure,
                             sms_bench_state *state);
sms_status sms_bench_at_restf(const sms_benchf *bench, float extension, float load_force, float mean_pressure,
                              sms_bench_statef *state);
sms_status sms_platform_at_rest(const sms_platform *platform, const double q[3], double mean_pressure,
                                sms_platform_state *state);
sms_status sms_platform_at_restf(const sms_platformf *platform, const float q[3], float mean_pressure,
                                 sms_platform_statef *state);

/* What the platform does at the last state that was looked at. The next search for pose and accelerations begins there;
 * nothing else is read. */
typedef struct sms_platform_terms {
  sms_pose pose;
  double extension[3];              /* m */
  double extension_rate[3];         /* m/s */
  double extension_acceleration[3]; /* m/s^2 */
  double force[3];                  /* of gas and ends of the stroke on the rods, N */
  double friction[3];               /* N, positive against extension */
} sms_platform_terms;

typedef struct sms_platform_termsf {
  sms_posef pose;
  float extension[3];
  float extension_rate[3];
  float extension_acceleration[3];
  float force[3];
  float friction[3];
} sms_platform_termsf;

/* Before the first call: the rest pose, and zeros. */
void sms_platform_prepare(const sms_platform *platform, sms_platform_terms *terms);
void sms_platform_preparef(const sms_platformf *platform, sms_platform_termsf *terms);

/* ---- motion (bench.hpp, platform.hpp, integrate.hpp, integrate_adaptive.hpp) ------------------------------------- */
/* The statuses from here on: SMS_NOT_A_NUMBER for a state, an input or a rate that is none; SMS_OUT_OF_RANGE where a
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

/* What adaptive steps remember from one call to the next. */
typedef struct sms_stepping {
  double tolerance;          /* error of one step over the range of each state: 1e-4 to 1e-7 in double, 1e-4 in float */
  double next;               /* size of the step to try, s */
  double last_error;         /* of the last accepted step over its tolerance */
  unsigned long evaluations; /* of the derivative, so far */
} sms_stepping;

typedef struct sms_steppingf {
  float tolerance;
  float next;
  float last_error;
  unsigned long evaluations;
} sms_steppingf;

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
