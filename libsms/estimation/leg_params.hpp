// The parameters of a machine with three legs: what all have in common, and by how much one leg differs.
//
//   leg i has  common + shift_i
//
// A fit moves either: a leak of all three cylinders is `common`, a leak of the second alone `shift[1]`. Zero shifts leave
// every leg as the common parameters say, to the bit.
//
// Index space: the parameters of all legs first, in the order of params.def, then those of leg 1, 2 and 3.
#pragma once

#include <algorithm>

#include "sms/params.hpp"
#include "sms/scalar.hpp"

namespace sms {

// Itself the common ones.
template <typename S>
struct LegParams : Params<S> {
  Params<S> shift[3];

  explicit LegParams(const Params<S>& common = Params<S>()) : Params<S>(common) {
    for (Params<S>& leg : shift) {
      std::fill_n(values_of(leg), int(param_count), S(0));
    }
  }
};

// leg: 0 for all three, 1 to 3 for one.
constexpr int leg_param_index(int param, int leg) { return leg * param_count + param; }

template <typename S>
S& param(LegParams<S>& params, int index) {
  const int leg = index / param_count;
  Params<S>& common = params;
  return param(leg == 0 ? common : params.shift[leg - 1], index % param_count);
}

template <typename T, typename S>
LegParams<T> cast(const LegParams<S>& from) {
  const Params<S>& common = from;
  LegParams<T> to(cast<T>(common));
  for (int i = 0; i < 3; ++i) {
    to.shift[i] = cast<T>(from.shift[i]);
  }
  return to;
}

// Leg i, from 0.
template <typename S>
Params<S> params_of_leg(const LegParams<S>& params, int i) {
  Params<S> leg = params;
  for (int k = 0; k < param_count; ++k) {
    values_of(leg)[k] += values_of(params.shift[i])[k];
  }
  return leg;
}

}  // namespace sms
