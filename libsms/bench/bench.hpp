// Timing without a framework: the fastest of several rounds, because whatever disturbs a measurement makes it longer.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

namespace sms_bench {

// How often each piece of work is done, at most; main() takes it from the command line. A round should be short, about
// a millisecond, so that some of them pass without an interruption.
inline int rounds = 500;

// Nanoseconds of one call, when work() makes `calls` of them.
template <typename Work>
double nanoseconds_per_call(int calls, const Work& work) {
  using Nanoseconds = std::chrono::duration<double, std::nano>;
  constexpr double kPatience = 3e9;
  double best = std::numeric_limits<double>::infinity(), total = 0.0;
  for (int round = 0; round < rounds && total < kPatience; ++round) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const double elapsed = Nanoseconds(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, elapsed / calls);
    total += elapsed;
  }
  return best;
}

// One line that validation/bench.py reads: name, tab, value, tab, unit.
inline void report(const char* name, double value, const char* unit) {
  std::printf("%s\t%.6g\t%s\n", name, value, unit);
}

// One function a subject, each in its file.
void friction();
void mechanism();

}  // namespace sms_bench
