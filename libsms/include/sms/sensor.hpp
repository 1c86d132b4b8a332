// What a sensor says, against what is there: reading = (1 + gain) truth + offset.
//
// Gain and offset are effects (sensor_gain, sensor_offset of each measured signal), zero for a good sensor. The model
// computes with truths; a record holds readings. A gauge sensor compares with ambient, so that its gain acts on the
// difference.
#pragma once

#include "sms/params.hpp"

namespace sms {

template <typename S>
S sensor_reading(const S& truth, const S& gain, const S& offset) {
  return (S(1) + gain) * truth + offset;
}

template <typename S>
S sensor_truth(const S& reading, const S& gain, const S& offset) {
  return (reading - offset) / (S(1) + gain);
}

}  // namespace sms
