/* What the application wants from a board, and all it ever touches: values in, values out, once a control period.
 *
 * A board brings six functions and a timer. The desk brings the same two structs from a simulated plant, so that
 * firmware, emulated firmware and virtual rig run one application. No type of 8 bits: a C28x has none. */
#ifndef SMS_FIRMWARE_HARDWARE_H
#define SMS_FIRMWARE_HARDWARE_H

#include "sms/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SMS_LEGS = 3,
  SMS_CONVERTED = 10,     /* extensions 1..3, lower chambers 1..3, upper chambers 1..3, supply */
  SMS_FRAMES_IN = 8,      /* a full bus of 500 kbit/s brings 4 in a millisecond */
  SMS_FRAMES_OUT = 24,    /* the mailboxes of the CAN controller, or a queue in front of it */
  SMS_CHARACTERS_IN = 16, /* 115200 baud bring 12 in a millisecond */
  SMS_CHARACTERS_OUT = 11 /* and take 11 away */
};

typedef struct sms_hardware_inputs {
  uint_least16_t converted[SMS_CONVERTED]; /* counts, 12 bits */
  uint_least16_t enabled;                  /* 1: the enable switch is closed, the valves have power */
  uint_least16_t bus_off;                  /* 1: the CAN controller has withdrawn from the bus */
  uint_least16_t missed_ticks;             /* periods that passed without a tick since the last one; 0 is right */
  uint_least16_t load;                     /* duration of the last tick, in half percents of the period */
  uint_least16_t frame_count;
  uint_least16_t character_count;
  sms_frame frames[SMS_FRAMES_IN]; /* received, oldest first */
  uint_least16_t characters[SMS_CHARACTERS_IN];
} sms_hardware_inputs;

typedef struct sms_hardware_outputs {
  uint_least16_t pulse_width[SMS_LEGS]; /* counts out of pwm_steps: the valve commands, 0 to 10 V */
  uint_least16_t feed_watchdog;         /* 1: all is sane, restart the watchdog */
  uint_least16_t frame_count;
  uint_least16_t character_count;
  sms_frame frames[SMS_FRAMES_OUT]; /* to be sent in this order */
  uint_least16_t characters[SMS_CHARACTERS_OUT];
} sms_hardware_outputs;

/* ---- what a board implements ---------------------------------------------------------------------------------- */

/* Clocks, converters, pulse width at the centre, CAN, UART, watchdog (10 ms). Returns the cause of the reset as in the
 * value table ResetCause of sms.dbc. */
uint_least16_t hardware_start(void);

/* Any number that differs from one reset to the next. */
uint_least16_t hardware_seed(void);

/* The key with which commands on the bus are authenticated, 16 octets, and 8 octets that this board never had before: from
 * a generator of random numbers, or a count of resets in memory that keeps it. Octet 0 lowest in word 0. Returns 0 when
 * there is no key: the bus is open. The key stays in the board: nothing reads it out. */
int hardware_key(uint_least32_t key[4], uint_least32_t nonce[2]);

/* Waits for the next period and fills everything; 0 ends the main loop, which only an emulated board does. */
int hardware_read(sms_hardware_inputs *inputs);

/* Pulse widths first, then frames and characters; feeds the watchdog if told to. */
void hardware_write(const sms_hardware_outputs *outputs);

#ifdef __cplusplus
}
#endif

#endif
