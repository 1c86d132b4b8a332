// usage: sms_bench [ROUNDS [NAME]]; one round of one measurement is what callgrind counts instructions in.
#include <cstdlib>

#include "bench.hpp"

int main(int argc, char** argv) {
  if (argc > 1) {
    sms_timing::rounds = std::atoi(argv[1]);
  }
  if (argc > 2) {
    sms_timing::only = argv[2];
  }
  sms_timing::friction();
  sms_timing::mechanism();
  sms_timing::plant();
}
