// The console of the source (section 7.3.3): RS-422, 115200 baud, 8N1; a control character, data, a carriage return.
// A person can type it. `help` answers with the list.
//
// An optional check follows the data: `*` and two hexadecimal digits, the CRC-8 of the bus over the characters before
// the star. Unknown or malformed lines are answered, and change nothing.
#pragma once

#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

enum { console_line = 64, console_waiting = 256 };

struct Console {
  char line[console_line];
  Word length;
  bool too_long;
  char waiting[console_waiting];  // a ring of characters to be sent
  Word first, count;
  const char* text;  // in the flash, sent after the ring
  Word repeat;       // ms between lines of telemetry, 0: none
  Word countdown;    // ms
};

}  // namespace firmware
}  // namespace sms
