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
// at the rod's eye (backlash, half of it each way).
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

// What a position sensor sees of the piston; `force` is that of the cylinder on its mount, N.
template <typename S>
S seen_extension(const Params<S>& p, const S& extension, const S& velocity, const S& force) {
  return extension - p.frame_compliance * force - S(0.5) * p.backlash * friction_ramp(velocity, p.stiction_velocity);
}

}  // namespace sms
