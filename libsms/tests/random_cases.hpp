// Random cases that can be repeated: main.cpp prints the seed, and takes it from --seed or SMS_TEST_SEED.
#pragma once

#include <random>

namespace sms_test {

extern unsigned long seed;
extern int count;

class Random {
 public:
  Random() : engine_(seed) {}
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace sms_test
