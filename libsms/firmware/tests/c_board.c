/* A board in C: the application through its C ABI, with nothing but C99. It stands at rest and is told to do nothing. */
#include <stdio.h>
#include <string.h>

#include "sms_firmware.h"

enum { MEMORY = 2048 }; /* doubles */

int main(void) {
  static double memory[MEMORY];
  static sms_hardware_inputs in;
  static sms_hardware_outputs out;
  sms_application *application = (sms_application *)memory;
  const uint_least32_t key[4] = {1, 2, 3, 4}, nonce[2] = {5, 6};
  int i, k, frames = 0;

  if (sms_application_size() > sizeof memory) return 1;
  sms_application_reset(application, 0, 1);
  for (i = 0; i < 3; ++i) in.converted[i] = 2048;
  for (i = 3; i < SMS_CONVERTED; ++i) in.converted[i] = 1638;
  in.enabled = 1;
  for (k = 0; k < 1000; ++k) {
    sms_application_tick(application, &in, &out);
    frames += (int)out.frame_count;
    for (i = 0; i < SMS_LEGS; ++i) {
      if (out.pulse_width[i] != 750) return 2; /* the centre: 5 V */
    }
  }
  printf("%d frames, mode %d, faults %lx, %lu chars\n", frames, sms_application_mode(application),
         (unsigned long)sms_application_faults(application), sms_application_size());
  if (frames <= 600 || sms_application_faults(application) != 0) return 3;
  sms_application_set_key(application, key, nonce); /* from here on its nonce is told, at once */
  sms_application_tick(application, &in, &out);
  for (i = 0; i < (int)out.frame_count; ++i) {
    if (out.frames[i].identifier == 0x103) return 0;
  }
  return 4;
}
