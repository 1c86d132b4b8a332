/* The application for a caller in C: the main loop of a board, or another language on the desk.
 *
 * The caller owns the memory: sms_application_size() chars of it, aligned as for a double. Nothing is allocated. */
#ifndef SMS_FIRMWARE_SMS_FIRMWARE_H
#define SMS_FIRMWARE_SMS_FIRMWARE_H

#include "hardware.h"
#include "sms/sms.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sms_application sms_application;

/* In units of char, whatever that is. */
unsigned long sms_application_size(void);

/* Everything as after a reset. cause: value table ResetCause of sms.dbc; seed: any number, another one each time. */
void sms_application_reset(sms_application *application, uint_least16_t cause, uint_least16_t seed);

/* After each reset, where commands on the bus are to be authenticated; as hardware_key() of hardware.h. */
void sms_application_set_key(sms_application *application, const uint_least32_t key[4], const uint_least32_t nonce[2]);

/* One control period: 1 ms. */
void sms_application_tick(sms_application *application, const sms_hardware_inputs *in, sms_hardware_outputs *out);

/* Value tables Mode, ControlLaw; bit n - 1 is fault n of the value table Fault. */
int sms_application_mode(const sms_application *application);
int sms_application_control_law(const sms_application *application);
uint_least32_t sms_application_faults(const sms_application *application);

/* Hash over params.def and settings.def: what both ends of the bus have to agree on. */
uint_least32_t sms_parameter_hash(void);

#ifdef __cplusplus
}
#endif

#endif
