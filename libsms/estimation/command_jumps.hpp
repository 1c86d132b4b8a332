// When a recorded command jumped, as far as the record tells: a controller that is faster than its logger switches the
// valve anywhere in the sampling period before the sample that shows it.
//
// By how much a jump comes ahead of that sample is no parameter of the machine but an unknown of each jump, which the
// readings tell (python/sms/estimation/jump_times.py). To first order a jump that comes earlier adds its size, for so long, to
// the integral of the command over the step in which it comes.
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

// The largest jumps of a command within a window, in order of time: the samples that show them. Returns how many.
inline int largest_jumps(const Eigen::VectorXd& command, int first, int samples, int (&shown)[kJumps]) {
  const auto size = [&](int sample) { return std::fabs(detail::change_after(command, sample - 1)); };
  int count = 0;
  for (int k = first + 1; k < first + samples; ++k) {
    if (!detail::jumps(command, k - 1)) {
      continue;
    }
    if (count < kJumps) {
      shown[count++] = k;
      continue;
    }
    int* const end = shown + count;
    int* const least = std::min_element(shown, end, [&](int a, int b) { return size(a) < size(b); });
    if (size(*least) < size(k)) {
      std::copy(least + 1, end, least);
      *(end - 1) = k;
    }
  }
  return count;
}

// Of a command within a window, when it jumped: as far ahead of the samples that show it as is known of the record, and the
// largest jumps by a little more.
template <typename S>
class CommandJumps {
 public:
  // None.
  CommandJumps() = default;

  // known: s, of each sample by how much the jump that it shows came ahead of it; empty: of none. further: s, of the largest
  // jumps, kJumps values in order of time, or nullptr for nothing. record_step: s. Command and known have to last.
  CommandJumps(const Eigen::VectorXd& command, const Eigen::VectorXd& known, int first, int samples, double record_step,
               const S* further)
      : known_(known.size() > 0 ? &known : nullptr), record_step_(record_step) {
    if (further == nullptr) {
      return;
    }
    count_ = largest_jumps(command, first, samples, shown_);
    for (int i = 0; i < count_; ++i) {
      added_[i] = S(detail::change_after(command, shown_[i] - 1) / record_step) * further[i];
    }
  }

  // In samples: by how much what this one shows came ahead of it.
  double ahead(int sample) const {
    return known_ != nullptr && sample >= 0 && sample < known_->size() ? (*known_)[sample] / record_step_ : 0.0;
  }

  // V: what the further ones add to the mean of the command over a step from `from`, of `length`; both in samples of the
  // record.
  S mean(double from, double length) const {
    S sum(0);
    for (int i = 0; i < count_; ++i) {
      const double comes = shown_[i] - ahead(shown_[i]);
      if (from + 1e-9 < comes && !(from + length + 1e-9 < comes)) {
        sum += added_[i];
      }
    }
    return sum * S(1.0 / length);
  }

  bool known() const { return known_ != nullptr; }
  bool further() const { return count_ > 0; }

 private:
  const Eigen::VectorXd* known_ = nullptr;
  double record_step_ = 0.0;  // s
  int count_ = 0;
  int shown_[kJumps] = {};  // by this sample
  S added_[kJumps] = {};    // V, times samples
};

}  // namespace estimation
}  // namespace sms
