// Prints docs/faults.md's table: every fault, made and measured.
#include <cstdio>

#include "fault_cases.hpp"

int main() {
  bool good = true;
  for (const bench::FaultCase& c : bench::fault_cases()) {
    const bench::Outcome o = c.run();
    const bool as_stated = o.detected >= 1 && o.detected <= c.most && o.reaction && o.back && o.within;
    good = good && as_stated;
    std::printf("%s|%s|%d|%d|%s|%s|%s\n", c.name, c.cause, c.most, o.detected, c.reaction, c.way_back,
                as_stated ? "yes" : "NO");
  }
  return good ? 0 : 1;
}
