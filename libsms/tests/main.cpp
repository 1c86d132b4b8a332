// --seed N, or else SMS_TEST_SEED of the environment, repeats a random run; --count N sets how many random cases a
// property test takes; both are printed.
// doctest's own options have the prefix dt- (--dt-test-case=friction*), because it knows another --count.
#define DOCTEST_CONFIG_IMPLEMENT
#define DOCTEST_CONFIG_NO_UNPREFIXED_OPTIONS
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "random_cases.hpp"

namespace sms_test {
unsigned long seed = std::random_device{}();
int count = 10000;
}  // namespace sms_test

int main(int argc, char** argv) {
  const char* repeated = std::getenv("SMS_TEST_SEED");
  if (repeated != nullptr) sms_test::seed = std::strtoul(repeated, nullptr, 10);
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], "--seed") == 0) sms_test::seed = std::strtoul(argv[i + 1], nullptr, 10);
    if (std::strcmp(argv[i], "--count") == 0) sms_test::count = std::atoi(argv[i + 1]);
  }
  std::printf("random cases: --seed %lu --count %d\n", sms_test::seed, sms_test::count);
  doctest::Context context(argc, argv);
  return context.run();
}
