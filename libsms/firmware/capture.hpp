// A logger like the source's (section 7.3.2): chosen signals, 200 samples each, started by a trigger on the first one.
// A captured value is the raw word of that signal's telemetry frame.
#pragma once

#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

enum { captured_signals = 3, captured_samples = 200 };

struct Capture {
  CaptureState state;
  CaptureTrigger trigger;
  Word signal[captured_signals];  // CaptureSignal
  Word period;                    // ms
  Word level;                     // raw, of signal 1
  bool level_is_signed;
  bool armed_before;  // `previous` is valid
  bool previous;      // signal 1 was above the level
  Word wait;          // ms until the next sample
  Word samples;
  Long start;  // ms
  Word next_to_send, end_to_send;
  Word value[captured_samples][captured_signals];
};

inline bool above_level(const Capture& c, Word raw) {
  const Word flip = c.level_is_signed ? 0x8000u : 0u;  // two's complement, compared as unsigned
  return Word((raw ^ flip) & 0xFFFFu) >= Word((c.level ^ flip) & 0xFFFFu);
}

// Whether the trigger comes now.
inline bool is_triggered(Capture& c, Word raw, bool fault) {
  const bool above = above_level(c, raw), before = c.armed_before ? c.previous : above;
  c.previous = above;
  c.armed_before = true;
  switch (c.trigger) {
    case CaptureTrigger::at_once:
      return true;
    case CaptureTrigger::rising:
      return above && !before;
    case CaptureTrigger::falling:
      return !above && before;
    case CaptureTrigger::crossing:
      return above != before;
    case CaptureTrigger::fault:
      return fault;
  }
  return false;
}

inline void take_sample(Capture& c, const Word (&raw)[captured_signals]) {
  for (int i = 0; i < captured_signals; ++i) {
    c.value[c.samples][i] = raw[i];
  }
  ++c.samples;
  c.wait = Word(c.period - 1);
  if (c.samples >= Word(captured_samples)) {
    c.state = CaptureState::complete;
  }
}

}  // namespace firmware
}  // namespace sms
