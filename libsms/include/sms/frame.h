/* One frame of the bus, as the hardware hands it over. Octets stand in words of at least 16 bits: a C28x has nothing
 * smaller, and the higher bits are ignored. */
#ifndef SMS_FRAME_H
#define SMS_FRAME_H

#include <stdint.h>

typedef struct sms_frame {
  uint_least16_t identifier; /* 11 bits */
  uint_least16_t length;     /* octets */
  uint_least16_t octet[8];
} sms_frame;

#endif
