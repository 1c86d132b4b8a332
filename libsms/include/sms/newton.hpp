// Newton's method as the kinematics use it: a bounded number of damped steps, then a last one.
//
// Near a solution a step of size d leaves an error of the order of d^2. Once d is below close_step, one more step with
// the slope of the one before is as good as exact: it leaves d^3, below rounding, and needs the lengths only. That last
// step is taken in the caller's scalar. Far from the solution a step is shortened to largest_step, which keeps the
// iteration on the branch of solutions it started on, the built assembly mode.
#pragma once

#include <limits>

#include "sms/scalar.hpp"

namespace sms {

// Steps taken; of numbers side by side a count for each (lanes.hpp).
template <typename V>
struct CountOf {
  using type = int;
};
template <typename V>
using Count = typename CountOf<V>::type;

// How an iteration ended; written for whoever asks, whatever the status.
template <typename V>
struct Convergence {
  Count<V> iterations;  // Newton steps taken
  V residual;           // m, largest error of a link's length; NaN when no pose was tried
};

template <typename V>
Convergence<V> not_begun() {
  return {Count<V>(0), V(std::numeric_limits<V>::quiet_NaN())};
}

constexpr int largest_iteration_count() { return 20; }

// rad and m, which weigh alike here: the joints are about 1 m from the middle.
template <typename V>
constexpr V largest_step() {
  return V(0.2);
}

template <typename V>
constexpr V close_step() {
  return std::numeric_limits<V>::digits > 24 ? V(2e-6) : V(2e-3);
}

// The square of such a step is below rounding: nothing is left to do.
template <typename V>
constexpr V negligible_step() {
  return std::numeric_limits<V>::digits > 24 ? V(1e-8) : V(1e-4);
}

// Factor that brings the largest of a step's components down to largest_step.
template <typename V>
V damping(const V& largest_component) {
  const auto too_far = largest_component > largest_step<V>();
  return any(too_far) ? select(too_far, largest_step<V>() / largest_component, V(1)) : V(1);
}

}  // namespace sms
