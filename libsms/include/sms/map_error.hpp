// What is not known of a map that was measured: its relative error, from its values at some knots, linear in between and
// constant beyond. Zero everywhere, with its derivatives, where the values are.
//
// The values are parameters: of the valve's flow over the opening (valve.hpp), of friction over the speed (friction.hpp).
#pragma once

#include "sms/limit.hpp"
#include "sms/params.hpp"
#include "sms/scalar.hpp"

namespace sms {

// Where the values belong, ascending; and one over the distance of each knot from the one below.
template <typename V, int kKnots>
struct MapKnots {
  V at[kKnots] = {};
  V per_span[kKnots] = {};

  constexpr explicit MapKnots(const V (&places)[kKnots]) {
    for (int i = 0; i < kKnots; ++i) {
      at[i] = places[i];
      per_span[i] = i > 0 ? V(1) / (places[i] - places[i - 1]) : V(0);
    }
  }
};

// Between which two knots a place lies, and how far from the lower one to the upper one, 0 to 1.
template <typename S>
struct MapPlace {
  int above;
  S share;
};

template <typename S, int kKnots>
MapPlace<S> map_place(const MapKnots<ValueOf<S>, kKnots>& knots, const S& x) {
  int above = 1;
  for (int i = 1; i < kKnots - 1; ++i) {  // counts, without a branch
    above += x > S(knots.at[i]) ? 1 : 0;
  }
  return {above, limited<S>((x - S(knots.at[above - 1])) * S(knots.per_span[above]), S(0), S(1))};
}

template <typename S, int kKnots>
S map_error(const Params<S>& p, S Params<S>::*const (&at_knot)[kKnots], const MapPlace<S>& place) {
  const S& below = p.*at_knot[place.above - 1];
  return below + place.share * (p.*at_knot[place.above] - below);
}

}  // namespace sms
