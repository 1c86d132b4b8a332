// The two lists of parameters as tables in the flash. It is full of them, so they are as short as they can be: bounds,
// places and names apart, and the names one after the other without pointers to them.
#include "settings.hpp"

namespace sms {
namespace firmware {
namespace {

constexpr int kSettingCount = end_of_settings - first_setting;

const ParameterBounds kMachineBounds[param_count] = {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) {float(lower), float(upper)},
#include "sms/params.def"
};

const ParameterBounds kSettingBounds[kSettingCount] = {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) {float(lower), float(upper)},
#include "settings.def"
};

float sms_paramsf::*const kMachinePlace[param_count] = {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) &sms_paramsf::name,
#include "sms/params.def"
};

float Settings::*const kSettingPlace[kSettingCount] = {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) &Settings::name,
#include "settings.def"
};

const bool kLive[kSettingCount] = {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) (live) != 0,
#include "settings.def"
};

// Every name with its zero.
const char kMachineNames[] =
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) #name "\0"
#include "sms/params.def"
    ;

const char kSettingNames[] =
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) #name "\0"
#include "settings.def"
    ;

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

bool is_setting(int index) { return index >= first_setting && index < end_of_settings; }

// Which one of `count` names it is; -1: none.
int place_of(const char* name, const char* names, int count) {
  for (int i = 0; i < count; ++i) {
    const char* wanted = name;
    for (; *wanted != '\0' && *wanted == *names; ++wanted, ++names) {
    }
    if (*wanted == *names) {
      return i;
    }
    for (; *names != '\0'; ++names) {
    }
    ++names;
  }
  return -1;
}

}  // namespace

Parameters::Parameters() = default;

const ParameterBounds* parameter_bounds(int index) {
  if (index >= 0 && index < param_count) {
    return &kMachineBounds[index];
  }
  return is_setting(index) ? &kSettingBounds[index - first_setting] : nullptr;
}

float* parameter(Parameters& parameters, int index) {
  if (index >= 0 && index < param_count) {
    return &(parameters.machine.*kMachinePlace[index]);
  }
  return is_setting(index) ? &(parameters.settings.*kSettingPlace[index - first_setting]) : nullptr;
}

bool is_live(int index) { return is_setting(index) && kLive[index - first_setting]; }

int parameter_index(const char* name) {
  const int machine = place_of(name, kMachineNames, param_count);
  if (machine >= 0) {
    return machine;
  }
  const int setting = place_of(name, kSettingNames, kSettingCount);
  return setting >= 0 ? first_setting + setting : -1;
}

Long parameter_hash() { return kHash; }

}  // namespace firmware
}  // namespace sms
