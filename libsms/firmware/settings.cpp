// The two lists of parameters as tables in the flash.
#include "settings.hpp"

namespace sms {
namespace firmware {
namespace {

const ParameterInfo kMachine[param_count] = {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) {#name, float(lower), float(upper), false},
#include "sms/params.def"
};

constexpr int kSettingCount = end_of_settings - first_setting;

const ParameterInfo kSettings[kSettingCount] = {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) {#name, float(lower), float(upper), (live) != 0},
#include "settings.def"
};

constexpr Long fnv1a(const char* text) {
  Long hash = 0x811C9DC5u;
  for (; *text != '\0'; ++text) {
    hash = ((hash ^ Long(*text)) * 0x01000193u) & 0xFFFFFFFFu;
  }
  return hash;
}

constexpr Long kHash = fnv1a(
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) #name " " unit " " #value ";"
#include "sms/params.def"
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) #name " " unit " " #value ";"
#include "settings.def"
);

bool same(const char* a, const char* b) {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

}  // namespace

const ParameterInfo* parameter_info(int index) {
  if (index >= 0 && index < param_count) {
    return &kMachine[index];
  }
  return index >= first_setting && index < end_of_settings ? &kSettings[index - first_setting] : nullptr;
}

float* parameter(Parameters& parameters, int index) {
  switch (index) {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) \
  case index_of_##name:                                         \
    return &parameters.settings.name;
#include "settings.def"
    default:
      return index >= 0 && index < param_count ? &param(parameters.machine, index) : nullptr;
  }
}

int parameter_index(const char* name) {
  for (int i = 0; i < param_count; ++i) {
    if (same(kMachine[i].name, name)) {
      return i;
    }
  }
  for (int i = 0; i < kSettingCount; ++i) {
    if (same(kSettings[i].name, name)) {
      return first_setting + i;
    }
  }
  return -1;
}

Long parameter_hash() { return kHash; }

}  // namespace firmware
}  // namespace sms
