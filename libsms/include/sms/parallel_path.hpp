// Is there a singular pose on the way from one pose to the next?
//
// The determinant of the Jacobian (parallel_mechanism.hpp) is a continuous function along the way, so where it has
// another sign at the end than at the beginning, it has passed zero, and halving finds where. The way is straight in
// the pose's driven coordinates; it is sampled, so that of two zeros closer than a sample both can be missed.
#pragma once

#include "sms/parallel_kinematics.hpp"

namespace sms {

template <typename V>
struct Crossing {
  bool found;
  V fraction;           // of the way, 0 to 1
  Vec6<V> coordinates;  // of the singular pose
};

constexpr int samples_of_a_way() { return 32; }

template <typename V>
struct WayPoint {
  Vec6<V> coordinates;
  V determinant;
};

// The pose at a fraction of the way, its other coordinates searched from those of `near`.
template <typename V>
sms_status at_fraction(const ParallelMechanism<V>& m, const LegEquation equation[6], const Vec6<V>& from,
                       const Vec6<V>& to, const V& fraction, const Vec6<V>& near, WayPoint<V>& point) {
  const int freedoms = actuated_count(m);
  Vec6<V> c = near;
  for (int k = 0; k < freedoms; ++k) {
    const int d = freedoms == 6 ? k : m.driven[k];
    c(d) = from(d) + fraction * (to(d) - from(d));
  }
  Search<V> search;
  const sms_status status = complete_coordinates(m, c, search);
  if (status == SMS_OK) {
    point = {c, distance_from_singularity(m, equation, pose_of(c)).determinant};
  }
  return status;
}

// Both ends are whole poses that fit the rods and planes. On any status but SMS_OK nothing is written; that status is
// then of a pose on the way that cannot be completed.
template <typename V>
sms_status crossing_between(const ParallelMechanism<V>& m, const Vec6<V>& from, const Vec6<V>& to,
                            Crossing<V>& crossing) {
  LegEquation equation[6];
  if (equations_of(m, equation) != 6) {
    return SMS_OUT_OF_RANGE;
  }
  WayPoint<V> before, here;
  sms_status status = at_fraction(m, equation, from, to, V(0), from, before);
  for (int i = 1; status == SMS_OK && i <= samples_of_a_way(); ++i) {
    const V end = V(i) / V(samples_of_a_way());
    status = at_fraction(m, equation, from, to, end, before.coordinates, here);
    if (status == SMS_OK && (here.determinant > V(0)) != (before.determinant > V(0))) {
      V inside = V(i - 1) / V(samples_of_a_way()), outside = end;
      for (int halving = 0; status == SMS_OK && halving < std::numeric_limits<V>::digits - 6; ++halving) {
        const V middle = V(0.5) * (inside + outside);
        WayPoint<V> between;
        status = at_fraction(m, equation, from, to, middle, before.coordinates, between);
        const bool same = (between.determinant > V(0)) == (before.determinant > V(0));
        (same ? inside : outside) = middle;
        before = same ? between : before;
      }
      if (status == SMS_OK) {
        crossing = {true, inside, before.coordinates};
      }
      return status;
    }
    before = here;
  }
  if (status == SMS_OK) {
    crossing = {false, V(1), to};
  }
  return status;
}

}  // namespace sms
