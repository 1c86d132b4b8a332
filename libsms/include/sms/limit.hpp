// x held between two limits.
#pragma once

namespace sms {

template <typename S>
S limited(const S& x, const S& lower, const S& upper) {
  return x < lower ? lower : (x > upper ? upper : x);
}

}  // namespace sms
