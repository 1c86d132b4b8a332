// The last things that happened: every change of mode, every fault, every refusal. Sent as Event frames, kept for the
// console.
#pragma once

#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

struct Event {
  Long time;  // ms
  EventKind kind;
  Word detail;  // a Fault, Reason, ParameterResult or session, by kind
  Mode before;
  Mode after;
};

enum { events_kept = 16 };

struct EventLog {
  Event entry[events_kept];
  Long count;  // since reset
  Long sent;
};

inline void note(EventLog& log, const Event& event) {
  log.entry[log.count % events_kept] = event;
  ++log.count;
}

// The oldest one that was not sent yet and is still kept; nullptr when there is none.
inline const Event* next_to_send(EventLog& log) {
  if (log.sent == log.count) {
    return nullptr;
  }
  if (log.count - log.sent > Long(events_kept)) {
    log.sent = log.count - Long(events_kept);
  }
  return &log.entry[log.sent++ % events_kept];
}

}  // namespace firmware
}  // namespace sms
