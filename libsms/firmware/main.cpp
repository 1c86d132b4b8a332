// The main loop of a board.
#include "application.hpp"

namespace {

// Not constructed before main(): reset() does that in place, so that the defaults stand in the flash once.
union Memory {
  Memory() {}
  sms::firmware::Application application;
};

Memory memory;
sms_hardware_inputs inputs;
sms_hardware_outputs outputs;

}  // namespace

int main() {
  const sms::ResetCause cause = sms::ResetCause(int(hardware_start()));
  sms::firmware::reset(memory.application, cause, hardware_seed());
  while (hardware_read(&inputs) != 0) {
    sms::firmware::tick(memory.application, inputs, outputs);
    hardware_write(&outputs);
  }
}
