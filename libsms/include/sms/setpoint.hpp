// A set-point that moves no faster than allowed: range, rate and acceleration of one coordinate are limited, in steps
// of the control period T.
//
// The follower has a position p and a rate v, and chooses the next rate v', |v' - v| <= q = a T, |v'| <= v_max; then
// p' = p + v' T. From a distance D it can come to rest without passing over when it takes
//
//   approach(D) = D / (n T) + q (n - 1) / 2,    n = ceil((sqrt(1 + 8 D / (q T)) - 1) / 2)
//
// for then the n rates v', v' - q, ..., v' - (n - 1) q are all within 0 and v', the last is at most q, and together they
// go D exactly. It is the largest such rate (time-optimal, without chatter at the end).
//
// Towards a target that stands it takes approach(|target - p|), towards one that moves at w the rate w +- approach(|D|)
// with D = target - p - w T, what it is behind: then a target within the limits is followed without lag. Range: v' <=
// approach(upper - p), and so below. That never asks for more braking than q: if v <= approach(D) then v - q <=
// approach(D - v T), because those same rates are still there to be taken. So by induction position, rate and
// acceleration stay within their limits at every step, whatever the target does, once the follower has started inside
// and at a rate it can stop from. One that starts outside the range comes in and stays. In floating point the bounds
// hold up to rounding.
#pragma once

#include <cmath>

#include "sms/limit.hpp"

namespace sms {

template <typename S>
struct SetpointLimits {
  S lower;         // m
  S upper;         // m
  S rate;          // m/s, above 0
  S acceleration;  // m/s^2, above 0
  S period;        // T, s
};

template <typename S>
struct Setpoint {
  S position;  // m
  S rate;      // m/s
};

// Which limit kept the set-point from its target in this step.
struct SetpointLimited {
  bool range;
  bool rate;
  bool acceleration;
};

// The largest rate that still comes to rest within `distance`, 0 when that is not positive.
template <typename S>
S approach_rate(const SetpointLimits<S>& limits, const S& distance) {
  using std::ceil;
  using std::sqrt;
  if (!(distance > S(0))) {
    return S(0);
  }
  const S change = limits.acceleration * limits.period;
  const S steps = ceil(S(0.5) * (sqrt(S(1) + S(8) * distance / (change * limits.period)) - S(1)));
  const S n = steps < S(1) ? S(1) : steps;
  return distance / (n * limits.period) + S(0.5) * change * (n - S(1));
}

// One step towards the target, which moves at target_rate.
template <typename S>
SetpointLimited setpoint_step(const SetpointLimits<S>& limits, Setpoint<S>& state, const S& target,
                              const S& target_rate) {
  using std::abs;
  const bool outside = target < limits.lower || target > limits.upper;
  const S goal = limited<S>(target, limits.lower, limits.upper), moving = outside ? S(0) : target_rate;
  const S change = limits.acceleration * limits.period;
  const S behind = goal - state.position - moving * limits.period;
  const S nearer = behind < S(0) ? -approach_rate<S>(limits, -behind) : approach_rate<S>(limits, behind);
  const S wanted = moving + nearer;
  const S slowed = limited<S>(wanted, -limits.rate, limits.rate);
  const S up = approach_rate<S>(limits, limits.upper - state.position);
  const S down = approach_rate<S>(limits, state.position - limits.lower);
  const S rate = limited<S>(limited<S>(slowed, -down, up), state.rate - change, state.rate + change);
  state.rate = rate;
  state.position += rate * limits.period;
  return {outside, abs(wanted) > limits.rate, abs(rate - slowed) > S(0)};
}

}  // namespace sms
