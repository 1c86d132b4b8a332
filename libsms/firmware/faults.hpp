// Which faults are present, and for how long they are said to be.
//
//   stop     the platform cannot be controlled: the valves go to their centre. Latched until acknowledged.
//   while    present as long as its cause: the enable switch, the host, the bus
//   report   an occurrence: said for a second after the last one
#pragma once

#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

enum { fault_count = 24, report_time = 1000 /* ms */ };

constexpr Long bit(Fault fault) { return fault == Fault::none ? 0u : Long(1) << (int(fault) - 1); }

constexpr Fault of_leg(Fault first, int leg) { return Fault(int(first) + leg); }

struct Faults {
  Long latched;
  Long present;
  Long reported;
  Word left[fault_count];  // ms that a report is still held
};

inline void raise(Faults& faults, Fault fault) { faults.latched |= bit(fault); }

inline void set(Faults& faults, Fault fault, bool is_present) {
  faults.present = is_present ? faults.present | bit(fault) : faults.present & ~bit(fault);
}

inline void report(Faults& faults, Fault fault) {
  faults.reported |= bit(fault);
  faults.left[int(fault) - 1] = report_time;
}

inline Long all(const Faults& faults) { return faults.latched | faults.present | faults.reported; }

// Once a period.
inline void age(Faults& faults) {
  if (faults.reported == 0u) {
    return;
  }
  for (int i = 0; i < fault_count; ++i) {
    if (faults.left[i] > 0 && --faults.left[i] == 0) {
      faults.reported &= ~bit(Fault(i + 1));
    }
  }
}

// none when there is none
inline Fault first_of(Long bits) {
  for (int i = 1; i <= fault_count; ++i) {
    if ((bits & bit(Fault(i))) != 0u) {
      return Fault(i);
    }
  }
  return Fault::none;
}

}  // namespace firmware
}  // namespace sms
