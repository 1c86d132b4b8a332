// The settings of settings.def as a struct, and the one list of parameters that the bus and the console see: first the
// rows of params.def, from 4096 on those of settings.def, guarded by a hash over both lists.
#pragma once

#include "sms/params.hpp"
#include "sms/protocol.hpp"

namespace sms {
namespace firmware {

struct Settings {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) float name = float(value);
#include "settings.def"
};

enum SettingIndex : int {
  first_setting = 4096,
  before_settings = first_setting - 1,
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) index_of_##name,
#include "settings.def"
  end_of_settings
};

// Everything that can be read and written from outside.
struct Parameters {
  Params<float> machine;
  Settings settings;

  Parameters();  // the defaults; not inline, for there are hundreds of them
};

// What a value may be.
struct ParameterBounds {
  float lower;
  float upper;
};

// nullptr when there is no such index.
const ParameterBounds* parameter_bounds(int index);
float* parameter(Parameters& parameters, int index);

// Whether it may be written while the platform is levelled.
bool is_live(int index);

// -1 when there is no such name.
int parameter_index(const char* name);

// FNV-1a over name, unit and default of every row of params.def and settings.def: desk and controller speak of the same.
Long parameter_hash();

}  // namespace firmware
}  // namespace sms
