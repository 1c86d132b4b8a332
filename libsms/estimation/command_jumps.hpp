// When a recorded command jumped, as far as the record tells: a controller that is faster than its logger switches the
// valve anywhere in the sampling period before the sample that shows it.
//
// By how much a jump comes ahead of that sample is no parameter of the machine but an unknown of each jump. To first order
// it adds the jump, for so long, to the integral of the command over the step in which it comes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimation/sample_steps.hpp"

namespace sms {
namespace estimation {

// A change between two samples is a jump where it is so many times the larger of the two beside it. Sampling theory: a sine
// has such changes only above 0.21 of the sampling rate, where nothing straight between samples is a likeness of it.
constexpr double kJump = 4.0;

// Of a window's jumps the largest are taken, as many as one pass of derivatives has room for.
constexpr int kJumps = 8;

namespace detail {

// From a sample to the next; 0 beyond the record.
inline double change_after(const Eigen::VectorXd& command, Eigen::Index sample) {
  return sample < 0 || sample + 1 >= command.size() ? 0.0 : command[sample + 1] - command[sample];
}

// Whether the command jumps between this sample and the next.
inline bool jumps(const Eigen::VectorXd& command, Eigen::Index sample) {
  const auto size = [&](Eigen::Index k) { return std::fabs(change_after(command, k)); };
  return size(sample) > kJump * std::max(size(sample - 1), size(sample + 1));
}

}  // namespace detail

// The largest jumps of a command within a window, and by how much each comes ahead of the sample that shows it.
template <typename S>
class CommandJumps {
 public:
  // None.
  CommandJumps() = default;

  // ahead: s, kJumps values in order of time, or nullptr for none. record_step: s.
  CommandJumps(const Eigen::VectorXd& command, int first, int samples, double record_step, const S* ahead) {
    if (ahead == nullptr) {
      return;
    }
    const auto size = [&](int sample) { return std::fabs(detail::change_after(command, sample)); };
    int found[kJumps];
    for (int k = first; k + 1 < first + samples; ++k) {
      if (!detail::jumps(command, k)) {
        continue;
      }
      int* const end = found + count_;
      if (count_ < kJumps) {
        found[count_++] = k;
        continue;
      }
      int* const least = std::min_element(found, end, [&](int a, int b) { return size(a) < size(b); });
      if (size(*least) < size(k)) {
        std::copy(least + 1, end, least);
        *(end - 1) = k;
      }
    }
    for (int i = 0; i < count_; ++i) {
      shown_[i] = found[i] + 1;
      added_[i] = S(detail::change_after(command, found[i]) / record_step) * ahead[i];
    }
  }

  // V: what they add to the mean of the command over a step from `from`, of `length`; both in samples of the record.
  S mean(double from, double length) const {
    S sum(0);
    for (int i = 0; i < count_; ++i) {
      if (from + 1e-9 < shown_[i] && !(from + length + 1e-9 < shown_[i])) {
        sum += added_[i];
      }
    }
    return sum * S(1.0 / length);
  }

  explicit operator bool() const { return count_ > 0; }

 private:
  int count_ = 0;
  int shown_[kJumps] = {};  // by this sample
  S added_[kJumps] = {};    // V, times samples
};

}  // namespace estimation
}  // namespace sms
