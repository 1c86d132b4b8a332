// The C ABI over the application.
#include "sms_firmware.h"

#include "application.hpp"

namespace {

using sms::firmware::Application;

Application& cpp(sms_application* application) { return *reinterpret_cast<Application*>(application); }
const Application& cpp(const sms_application* application) {
  return *reinterpret_cast<const Application*>(application);
}

sms::Octets8 joined(const uint_least32_t* half) { return sms::Octets8(half[0]) | (sms::Octets8(half[1]) << 32); }

static_assert(alignof(Application) <= alignof(double), "memory aligned as for a double will do");

}  // namespace

extern "C" {

unsigned long sms_application_size(void) { return sizeof(Application); }

void sms_application_reset(sms_application* application, uint_least16_t cause, uint_least16_t seed) {
  sms::firmware::reset(cpp(application), sms::ResetCause(int(cause)), seed);
}

void sms_application_set_key(sms_application* application, const uint_least32_t key[4], const uint_least32_t nonce[2]) {
  sms::firmware::set_key(cpp(application), {joined(key), joined(key + 2)}, joined(nonce));
}

void sms_application_tick(sms_application* application, const sms_hardware_inputs* in, sms_hardware_outputs* out) {
  sms::firmware::tick(cpp(application), *in, *out);
}

int sms_application_mode(const sms_application* application) { return int(cpp(application).mode); }

int sms_application_control_law(const sms_application* application) { return int(cpp(application).law); }

uint_least32_t sms_application_faults(const sms_application* application) {
  return sms::firmware::all(cpp(application).faults);
}

uint_least32_t sms_parameter_hash(void) { return sms::firmware::parameter_hash(); }

}  // extern "C"
