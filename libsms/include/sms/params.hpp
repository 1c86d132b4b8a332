// The parameters of params.def as a C++ struct over the scalar: float on the controller, double in simulation,
// a Jet in a fit. Params<double> and Params<float> are the C structs of sms.h with defaults, so that firmware and
// desk share one layout and no call copies anything.
//
// Every parameter is an S, one after the other, behind what the C structs open with (abi and size): what is done to all parameters alike is a loop over them (values_of), which
// a compiler leaves a loop. Two hundred statements at each scalar were a third of the code of a fit.
#pragma once

#include <cstddef>
#include <new>

#include "sms/sms.h"

namespace sms {

enum ParamIndex : int {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) index_of_##name,
#include "sms/params.def"
  param_count
};

// In a union of its own a member waits for the constructors here, which build all of them in a loop.
template <typename S>
struct Params {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) \
  union {                                                                    \
    S name;                                                                  \
  };
#include "sms/params.def"

  Params();
  Params(const Params& other);
  Params& operator=(const Params& other);
};

template <>
struct Params<double> : sms_params {
  Params() {
    abi = SMS_ABI;
    size = sizeof(sms_params);
#define SMS_PARAM(name_, unit, lower, value, upper, uncertainty, source, doc) name_ = value;
#include "sms/params.def"
  }
};

template <>
struct Params<float> : sms_paramsf {
  Params() {
    abi = SMS_ABI;
    size = sizeof(sms_paramsf);
#define SMS_PARAM(name_, unit, lower, value, upper, uncertainty, source, doc) name_ = float(value);
#include "sms/params.def"
  }
};

// All parameters in the order of params.def.
template <typename S>
S* values_of(Params<S>& params) {
  constexpr std::size_t before = sizeof(Params<S>) - param_count * sizeof(S);
  static_assert(before == 0 || before == sizeof(sms_params::abi) + sizeof(sms_params::size),
                "parameters lie one after the other");
  return reinterpret_cast<S*>(reinterpret_cast<char*>(&params) + before);
}

template <typename S>
const S* values_of(const Params<S>& params) {
  return values_of(const_cast<Params<S>&>(params));
}

template <typename S>
Params<S>::Params() {
  static const double defaults[param_count] = {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) value,
#include "sms/params.def"
  };
  for (int i = 0; i < param_count; ++i) {
    new (values_of(*this) + i) S(defaults[i]);
  }
}

template <typename S>
Params<S>::Params(const Params& other) {
  for (int i = 0; i < param_count; ++i) {
    new (values_of(*this) + i) S(values_of(other)[i]);
  }
}

template <typename S>
Params<S>& Params<S>::operator=(const Params& other) {
  for (int i = 0; i < param_count; ++i) {
    values_of(*this)[i] = values_of(other)[i];
  }
  return *this;
}

// The same machine in another scalar type.
template <typename T, typename S>
Params<T> cast(const Params<S>& from) {
  Params<T> to;
  for (int i = 0; i < param_count; ++i) {
    values_of(to)[i] = T(values_of(from)[i]);
  }
  return to;
}

// Parameter number `index` in the order of params.def; index must be in 0 .. param_count - 1.
template <typename S>
S& param(Params<S>& params, int index) {
  return values_of(params)[index];
}

template <typename S>
const S& param(const Params<S>& params, int index) {
  return values_of(params)[index];
}

}  // namespace sms
