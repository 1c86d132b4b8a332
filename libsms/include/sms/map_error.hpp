// What is not known of a map that was measured: its relative error, from its values at some knots, linear in between and
// constant beyond. Zero everywhere, with its derivatives, where the values are.
//
// The values are parameters: of the valve's flow over the opening (valve.hpp), of friction over the speed (friction.hpp).
#pragma once

#include "sms/limit.hpp"
#include "sms/params.hpp"
#include "sms/scalar.hpp"

namespace sms {

// Between which two knots a place lies, and how far from the lower one to the upper one, 0 to 1.
template <typename S>
struct MapPlace {
  int above;
  S share;
};

template <typename S, int kKnots>
MapPlace<S> map_place(const ValueOf<S> (&knot)[kKnots], const S& x) {
  int above = 1;
  while (above < kKnots - 1 && x > S(knot[above])) {
    ++above;
  }
  const S span(knot[above] - knot[above - 1]);
  return {above, limited<S>((x - S(knot[above - 1])) / span, S(0), S(1))};
}

template <typename S, int kKnots>
S map_error(const Params<S>& p, S Params<S>::*const (&at_knot)[kKnots], const MapPlace<S>& place) {
  const S& below = p.*at_knot[place.above - 1];
  return below + place.share * (p.*at_knot[place.above] - below);
}

}  // namespace sms
