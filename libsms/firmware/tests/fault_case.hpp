// What a case of a fault is, and what it showed.
#pragma once

#include "bench.hpp"

namespace bench {

// What a case showed.
struct Outcome {
  int detected;   // ms from the cause to the report; -1: never
  bool reaction;  // the platform did what the table says
  bool back;      // and came back as the table says
  bool within;    // no set-point passed a limit, all the time
};

struct FaultCase {
  const char* name;
  const char* cause;
  int most;  // ms within which it is detected
  const char* reaction;
  const char* way_back;
  Outcome (*run)();
};

}  // namespace bench
