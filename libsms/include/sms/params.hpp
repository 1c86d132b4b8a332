// The parameters of params.def as a C++ struct over the scalar: float on the controller, double in simulation,
// ceres::Jet in a fit. Params<double> and Params<float> are the C structs of sms.h with defaults, so that firmware and
// desk share one layout and no call copies anything.
#pragma once

#include "sms/sms.h"

namespace sms {

template <typename S>
struct Params {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) S name = S(value);
#include "sms/params.def"
};

template <>
struct Params<double> : sms_params {
  Params() {
#define SMS_PARAM(name_, unit, lower, value, upper, uncertainty, source, doc) name_ = value;
#include "sms/params.def"
  }
};

template <>
struct Params<float> : sms_paramsf {
  Params() {
#define SMS_PARAM(name_, unit, lower, value, upper, uncertainty, source, doc) name_ = float(value);
#include "sms/params.def"
  }
};

// The same machine in another scalar type.
template <typename T, typename S>
Params<T> cast(const Params<S>& from) {
  Params<T> to;
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) to.name = T(from.name);
#include "sms/params.def"
  return to;
}

enum ParamIndex : int {
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) index_of_##name,
#include "sms/params.def"
  param_count
};

// Parameter number `index` in the order of params.def; index must be in 0 .. param_count - 1.
template <typename S>
S& param(Params<S>& params, int index) {
  switch (index) {
    default:
#define SMS_PARAM(name, unit, lower, value, upper, uncertainty, source, doc) \
  case index_of_##name:                                                      \
    return params.name;
#include "sms/params.def"
  }
}

template <typename S>
const S& param(const Params<S>& params, int index) {
  return param(const_cast<Params<S>&>(params), index);
}

}  // namespace sms
