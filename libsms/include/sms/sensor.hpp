// What a sensor says, against what is there: reading = (1 + gain) truth + offset.
//
// Gain and offset are effects (sensor_gain, sensor_offset of each measured signal), zero for a good sensor. The model
// computes with truths; a record holds readings. A gauge sensor compares with ambient, so that its gain acts on the
// difference.
//
// Late sensors. What is slow beside the sensor's filter or the logger's clock is read as it was tau ago, to first order
// y - tau y'; whole samples of a clock are taken by the index. Effects, absent at zero: sensor_lag, clock_skew.
//
// What stands between the piston and a position sensor: a mount that yields under the force (frame_compliance) and play
// at the rod's eye (backlash). Play has a memory: the sensor is pushed by one side of the eye or the other, and rests
// while the rod crosses the gap.
#pragma once

#include "sms/friction.hpp"

namespace sms {

template <typename S>
S sensor_reading(const S& truth, const S& gain, const S& offset) {
  return (S(1) + gain) * truth + offset;
}

template <typename S>
S sensor_truth(const S& reading, const S& gain, const S& offset) {
  return (reading - offset) / (S(1) + gain);
}

// y as it was `late` ago.
template <typename S>
S late_reading(const S& value, const S& rate, const S& late) {
  return value - late * rate;
}

// Where the eye of a position sensor on this mount is; `force` is that of the cylinder on it, N.
template <typename S>
S yielded_extension(const Params<S>& p, const S& extension, const S& force) {
  return extension - p.frame_compliance * force;
}

// Where the sensor is when the eye it was at `before` has come to `now`.
template <typename S>
S played(const S& before, const S& now, const S& backlash) {
  const S half = S(0.5) * backlash;
  return before < now - half ? S(now - half) : before > now + half ? S(now + half) : before;
}

}  // namespace sms
