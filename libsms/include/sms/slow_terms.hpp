// What of a plant hardly changes within an integrator's step, such as the masses of a mechanism: evaluated where a step
// ends, and inside the next one taken from the polynomial through the last four such places, in Lagrange's form
//
//   y(t) = sum_i y_i prod_{j != i} (t - t_j) / (t_i - t_j)
//
// It misses y by the fourth power of the step. What jumps, a load from outside, begins a new polynomial; until that has
// its places every stage has terms of its own.
#pragma once

#include "sms/integrate.hpp"

namespace sms {

// Of a plant all of whose terms are evaluated in every stage.
struct NoSlowTerms {};

// Where they were evaluated, the last first.
template <typename Slow>
struct SlowPath {
  using S = typename Slow::Scalar;
  static constexpr int needed = 4;
  Slow place[needed];
  S time[needed];  // s
  int count;
};

template <>
struct SlowPath<NoSlowTerms> {
  int count;
};

template <typename Slow, typename S>
void add_place(SlowPath<Slow>& path, const Slow& slow, const S& time) {
  for (int i = SlowPath<Slow>::needed - 1; i > 0; --i) {
    path.place[i] = path.place[i - 1];
    path.time[i] = path.time[i - 1];
  }
  path.place[0] = slow;
  path.time[0] = time;
  path.count += path.count < SlowPath<Slow>::needed ? 1 : 0;
}

template <typename S>
void add_place(SlowPath<NoSlowTerms>&, const NoSlowTerms&, const S&) {}

// Whether the polynomial holds until a time, s: not far beyond the stretch that it was laid through, where the rounding of
// places that lie close together would grow.
template <typename Slow, typename S>
bool reaches(const SlowPath<Slow>& path, const S& time) {
  constexpr int first = SlowPath<Slow>::needed - 1;
  return path.count > first && time - path.time[0] < S(10) * (path.time[0] - path.time[first]);
}

// At a time that it reaches.
template <typename Slow, typename S>
void slow_at(const SlowPath<Slow>& path, const S& time, Slow& slow) {
  constexpr int n = SlowPath<Slow>::needed;
  S weight[n];
  for (int i = 0; i < n; ++i) {
    S above(1), below(1);
    for (int j = 0; j < n; ++j) {
      if (j != i) {
        above *= time - path.time[j];
        below *= path.time[i] - path.time[j];
      }
    }
    weight[i] = above / below;
  }
  vector_of(slow) = weight[0] * vector_of(path.place[0]) + weight[1] * vector_of(path.place[1]) +
                    weight[2] * vector_of(path.place[2]) + weight[3] * vector_of(path.place[3]);
}

}  // namespace sms
