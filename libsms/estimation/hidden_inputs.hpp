// What a record does not tell of a window, and a simulation takes beside its parameters: inputs that are hidden in the
// plant's equations, of each a number of values over the window, straight in between; and when the command jumped.
#pragma once

#include <algorithm>

namespace sms {
namespace estimation {

// Nothing by default.
template <typename S>
struct Hidden {
  const S* inputs = nullptr;  // `knots` values of each of the plant's kHidden inputs, one input after the other
  int knots = 0;
  const S* further = nullptr;  // s, of kJumps jumps of each of the plant's kCommands commands (command_jumps.hpp)
};

template <typename S>
class HiddenInputs {
 public:
  // samples: of the window.
  HiddenInputs(const Hidden<S>& hidden, int samples) : HiddenInputs(hidden.inputs, hidden.knots, samples) {}

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
  HiddenInputs(const S* values, int knots, int samples) : values_(values), knots_(knots), samples_(samples) {}

  const S* values_;
  int knots_;
  int samples_;
};

}  // namespace estimation
}  // namespace sms
