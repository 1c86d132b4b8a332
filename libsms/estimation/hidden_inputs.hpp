// Inputs that are hidden in a plant's equations: of each a number of values over a window, straight in between.
#pragma once

#include <algorithm>

namespace sms {
namespace estimation {

template <typename S>
class HiddenInputs {
 public:
  // values: `knots` of each input, one input after the other; nullptr for none. samples: of the window.
  HiddenInputs(const S* values, int knots, int samples) : values_(values), knots_(knots), samples_(samples) {}

  explicit operator bool() const { return values_ != nullptr; }

  // Input number `input` at a time counted in samples from the window's first.
  S at(int input, double time) const {
    const S* const values = values_ + input * knots_;
    const double place = std::min(time / samples_ * (knots_ - 1), knots_ - 1.001);
    const int k = static_cast<int>(place);
    return values[k] + S(place - k) * (values[k + 1] - values[k]);
  }

  // From input number `first` on.
  HiddenInputs from(int first) const {
    return {values_ == nullptr ? nullptr : values_ + first * knots_, knots_, samples_};
  }

 private:
  const S* values_;
  int knots_;
  int samples_;
};

}  // namespace estimation
}  // namespace sms
