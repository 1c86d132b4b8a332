// An effect is a group of parameters whose neutral value leaves every result unchanged to the bit. Where its term costs
// time it may be left out, but only if nobody asks for its derivative either: a fit screens an effect by the slope at
// its neutral value.
#pragma once

#include <type_traits>

#include "sms/scalar.hpp"

namespace sms {

template <typename S>
typename std::enable_if<std::is_same<S, ValueOf<S>>::value, bool>::type is_absent(const S& parameter) {
  return !(parameter < S(0)) && !(parameter > S(0));
}

template <typename S>
typename std::enable_if<!std::is_same<S, ValueOf<S>>::value, bool>::type is_absent(const S& parameter) {
  return is_absent(value_of(parameter)) && is_absent(parameter.v.squaredNorm());
}

}  // namespace sms
