// The main loop of a board.
#include "application.hpp"

namespace {

sms::firmware::Application application;
sms_hardware_inputs inputs;
sms_hardware_outputs outputs;

}  // namespace

int main() {
  const sms::ResetCause cause = sms::ResetCause(int(hardware_start()));
  sms::firmware::reset(application, cause, hardware_seed());
  while (hardware_read(&inputs) != 0) {
    sms::firmware::tick(application, inputs, outputs);
    hardware_write(&outputs);
  }
}
