// What the library says about itself: status texts, version, build, and the list of parameters.
#include "sms/sms.h"

namespace {

const sms_param_info kParams[] = {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) \
  {#name, unit, lower, value, upper, uncertainty, source, doc},
#include "sms/params.def"
};

constexpr int kParamCount = int(sizeof kParams / sizeof kParams[0]);

}  // namespace

// The build, as the compiler sees it, not as a build script believes it to be.
#define SMS_TEXT_(x) #x
#define SMS_TEXT(x) SMS_TEXT_(x)
#ifdef SMS_FLOAT_ONLY
#define SMS_SCALARS " float"
#else
#define SMS_SCALARS " float+double"
#endif
#ifdef __cpp_exceptions
#define SMS_EXCEPTIONS " exceptions"
#else
#define SMS_EXCEPTIONS " no-exceptions"
#endif
#ifdef __cpp_rtti
#define SMS_RTTI " rtti"
#else
#define SMS_RTTI " no-rtti"
#endif
#ifdef __SANITIZE_ADDRESS__
#define SMS_SANITIZERS " address-sanitizer"
#else
#define SMS_SANITIZERS ""
#endif

extern "C" {

const char* sms_status_string(sms_status status) {
  switch (status) {
    case SMS_OK:
      return "ok";
    case SMS_NOT_A_NUMBER:
      return "an input is not a finite number";
    case SMS_OUT_OF_RANGE:
      return "an input is outside its range";
    case SMS_OUT_OF_WORKSPACE:
      return "outside the workspace of the mechanism";
    case SMS_NOT_CONVERGED:
      return "the iteration did not converge";
    case SMS_WRONG_ABI:
      return "parameters of other headers than those of this library";
  }
  return "unknown status";
}

const char* sms_version(void) { return SMS_VERSION; }

const char* sms_build_info(void) {
  return "libsms " SMS_VERSION SMS_SCALARS " c++" SMS_TEXT(__cplusplus) SMS_EXCEPTIONS SMS_RTTI SMS_SANITIZERS;
}

int sms_param_count(void) { return kParamCount; }

const sms_param_info* sms_param_describe(int index) {
  return index >= 0 && index < kParamCount ? &kParams[index] : nullptr;
}

void sms_published_laws(sms_actuator_laws* laws) {
  *laws = {SMS_VALVE_ISO_0_4_MPA, SMS_FRICTION_ACCELERATION_DEPENDENT, SMS_CHAMBER_POLYTROPIC, SMS_DRIVE_DIRECT};
}

}  // extern "C"
