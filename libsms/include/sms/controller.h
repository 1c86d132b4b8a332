/* libsms, the position controllers of one actuator, for C: the code of the firmware and of the simulated loop. Part of
 * sms.h, whose conventions hold here.
 *
 *   error, m -> PID, or set-point and extension -> state feedback -> dead-band compensation -> command at the valve, V
 *
 * Called once a period. Settings are made once, and may be changed by hand; a state of zeros is at rest. Inputs are not
 * looked at: NaN goes through, and stays in the state.
 *
 * Example: libsms/examples/07_controller.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_CONTROLLER_H
#define SMS_CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

/* What the integral of a PID does while the output is at its limit. */
typedef enum sms_anti_windup {
  SMS_ANTI_WINDUP_NONE = 0,                   /* goes on: eq. 7.4 as it stands, the default */
  SMS_ANTI_WINDUP_CONDITIONAL_INTEGRATION = 1 /* stands still where the error would push it further */
} sms_anti_windup;

/* sms_differentiator; sms_pid_settings, sms_pid; sms_state_feedback_settings, sms_state_feedback; sms_dead_band; in float
 * sms_differentiatorf, ... */
#define SMS_STRUCTS "sms/controller_structs.def"
#include "sms/structs.h"

/* ---- PID (controller.hpp) ---------------------------------------------------------------------------------------- */
/* Gains, filter and period of the parameters. SMS_WRONG_ABI. */
sms_status sms_pid_from_params(const sms_params *params, sms_pid_settings *settings);
sms_status sms_pid_from_paramsf(const sms_paramsf *params, sms_pid_settingsf *settings);

/* Output, V around the valve's centre, to the error, m: eq. 7.4, trapezoidal integral, filtered derivative. */
double sms_pid_step(const sms_pid_settings *settings, sms_pid *state, double error);
float sms_pid_stepf(const sms_pid_settingsf *settings, sms_pidf *state, float error);

/* Bumpless transfer, while something else drives the valve: with the same error the next step gives `output`, V. */
void sms_pid_follow(const sms_pid_settings *settings, sms_pid *state, double error, double output);
void sms_pid_followf(const sms_pid_settingsf *settings, sms_pidf *state, float error, float output);

/* Takes over the wanted settings without a jump of the output. */
void sms_pid_change_gains(sms_pid_settings *settings, sms_pid *state, const sms_pid_settings *wanted);
void sms_pid_change_gainsf(sms_pid_settingsf *settings, sms_pidf *state, const sms_pid_settingsf *wanted);

/* ---- state feedback (controller.hpp) ----------------------------------------------------------------------------- */
/* SMS_WRONG_ABI. */
sms_status sms_state_feedback_from_params(const sms_params *params, sms_state_feedback_settings *settings);
sms_status sms_state_feedback_from_paramsf(const sms_paramsf *params, sms_state_feedback_settingsf *settings);

/* The state of a controller that starts at rest at an extension, m: its first step sees no jump. */
void sms_state_feedback_at(double extension, sms_state_feedback *state);
void sms_state_feedback_atf(float extension, sms_state_feedbackf *state);

/* Output, V around the valve's centre, to set-point and extension, m: Figure 8.3. */
double sms_state_feedback_step(const sms_state_feedback_settings *settings, sms_state_feedback *state, double setpoint,
                               double extension);
float sms_state_feedback_stepf(const sms_state_feedback_settingsf *settings, sms_state_feedbackf *state, float setpoint,
                               float extension);

/* ---- dead-band compensation (controller.hpp) --------------------------------------------------------------------- */
/* With dead_band_step and dead_band_sharpness of the parameters; a by eq. 7.6. SMS_WRONG_ABI. */
sms_status sms_dead_band_from_params(const sms_params *params, sms_dead_band *dead_band);
sms_status sms_dead_band_from_paramsf(const sms_paramsf *params, sms_dead_bandf *dead_band);

/* The output of a controller, V, stretched over the dead band: eq. 7.5. */
double sms_over_dead_band(const sms_dead_band *dead_band, double voltage);
float sms_over_dead_bandf(const sms_dead_bandf *dead_band, float voltage);

/* Its slope, 1: eq. 7.7. */
double sms_dead_band_gain(const sms_dead_band *dead_band, double voltage);
float sms_dead_band_gainf(const sms_dead_bandf *dead_band, float voltage);

/* Command at the valve, V: the compensated output around `offset` (command_offset), within 0 to 10 V. */
double sms_valve_command(const sms_dead_band *dead_band, double offset, double voltage);
float sms_valve_commandf(const sms_dead_bandf *dead_band, float offset, float voltage);

#ifdef __cplusplus
}
#endif

#endif
