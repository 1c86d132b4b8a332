// The console of the source (section 7.3.3): RS-422, 115200 baud, 8N1; a control character, data, a carriage return.
// A person can type it. `help` answers with the list.
//
// An optional check follows the data: `*` and two hexadecimal digits, the CRC-8 of the bus over the characters before
// the star. Unknown or malformed lines are answered, and change nothing.
#pragma once

#include "text.hpp"

namespace sms {
namespace firmware {

enum { console_line = 64, console_waiting = 256 };

struct Console {
  char line[console_line];
  Word length;
  bool too_long;
  TextRing<console_waiting> waiting;
  const char* help;  // what is left of it, in the flash
  Long log_from;     // entries of the log still to be listed
  Long log_to;
  Word repeat;     // ms between lines of state, 0: none
  Word countdown;  // ms
};

}  // namespace firmware
}  // namespace sms
