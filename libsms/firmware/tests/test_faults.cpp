// Every fault of docs/faults.md: seen in time, reacted to, recovered from, and no limit passed meanwhile.
#include <doctest/doctest.h>

#include "fault_cases.hpp"

TEST_CASE("faults") {
  for (const bench::FaultCase& c : bench::fault_cases()) {
    SUBCASE(c.name) {
      const bench::Outcome o = c.run();
      CAPTURE(c.name);
      CHECK(o.detected >= 1);
      CHECK(o.detected <= c.most);
      CHECK(o.reaction);
      CHECK(o.back);
      CHECK(o.within);
    }
  }
}
