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
  uint_least32_t key[4] = {0, 0, 0, 0}, nonce[2] = {0, 0};
  if (hardware_key(key, nonce) != 0) {
    using sms::Octets8;
    const sms::SipKey whole = {Octets8(key[0]) | (Octets8(key[1]) << 32), Octets8(key[2]) | (Octets8(key[3]) << 32)};
    sms::firmware::set_key(memory.application, whole, Octets8(nonce[0]) | (Octets8(nonce[1]) << 32));
  }
  while (hardware_read(&inputs) != 0) {
    sms::firmware::tick(memory.application, inputs, outputs);
    hardware_write(&outputs);
  }
}
