// usage: sms_bench [ROUNDS]; one round is what callgrind is given to count instructions in.
#include <cstdlib>

#include "bench.hpp"

int main(int argc, char** argv) {
  if (argc > 1) {
    sms_bench::rounds = std::atoi(argv[1]);
  }
  sms_bench::friction();
  sms_bench::mechanism();
}
