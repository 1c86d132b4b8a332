// x held between two limits.
#pragma once

namespace sms {

template <typename S>
S limited(const S& x, const S& lower, const S& upper) {
  const S raised = x < lower ? lower : x;  // one at a time: a maximum and a minimum, without a branch
  return upper < raised ? upper : raised;
}

}  // namespace sms
