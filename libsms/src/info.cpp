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

#define SMS_TEXT_(x) #x
#define SMS_TEXT(x) SMS_TEXT_(x)

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
  }
  return "unknown status";
}

const char* sms_version(void) { return SMS_VERSION; }

const char* sms_build_info(void) {
  return "libsms " SMS_VERSION
#ifdef SMS_FLOAT_ONLY
         " float"
#else
         " float+double"
#endif
         " c++" SMS_TEXT(__cplusplus)
#ifdef __cpp_exceptions
         " exceptions"
#else
         " no-exceptions"
#endif
#ifdef __cpp_rtti
         " rtti";
#else
         " no-rtti";
#endif
}

int sms_param_count(void) { return kParamCount; }

const sms_param_info* sms_param_describe(int index) {
  return index >= 0 && index < kParamCount ? &kParams[index] : nullptr;
}

}  // extern "C"
