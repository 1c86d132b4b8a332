// Timing without a framework: the fastest of several rounds, because whatever disturbs a measurement makes it longer.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <limits>

namespace sms_timing {

// What main() takes from the command line: how often each piece of work is done at most, and which alone, if not all.
// A round should be short, about a millisecond, so that some of them pass without an interruption.
inline int rounds = 500;
inline const char* only = nullptr;

inline bool wanted(const char* name) { return only == nullptr || std::strcmp(only, name) == 0; }

// Of its own, so that callgrind can be told to count what happens inside.
template <typename Work>
[[gnu::noinline]] void counted_round(const Work& work) {
  work();
}

// Times work(), which makes so many calls, and prints a line that validation/speed/__main__.py reads: name, tab, nanoseconds of
// one call, tab, number of calls.
template <typename Work>
void measure(const char* name, int calls, const Work& work) {
  using Nanoseconds = std::chrono::duration<double, std::nano>;
  constexpr double kPatience = 3e9;
  if (!wanted(name)) {
    return;
  }
  double best = std::numeric_limits<double>::infinity(), total = 0.0;
  for (int round = 0; round < rounds && total < kPatience; ++round) {
    const auto start = std::chrono::steady_clock::now();
    counted_round(work);
    const double elapsed = Nanoseconds(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, elapsed / calls);
    total += elapsed;
  }
  std::printf("%s\t%.6g\t%d\n", name, best, calls);
}

// One function a subject, each in its file.
void friction();
void mechanism();
void plant();

}  // namespace sms_timing
