// What a sensor says, against what is there. One chain for simulation, virtual rig and estimation:
//
//   truth -> mount, play -> lag of its filter -> gain, zero, linearity -> noise -> range -> rounding -> clock of its logger
//
// Gain and zero: reading = datum + (1 + gain) (truth - datum) + offset. The datum is where the sensor itself reads nothing:
// at mid-stroke for one whose record counts from there, at the ambient pressure for one that reads against it, at its cold
// junction for a thermocouple. The model computes with truths; a record holds readings.
//
// Linearity. What a data sheet calls so is how far a sensor is off its best straight line; the simplest way to be off is
// a bow over its span, the second Chebyshev polynomial,
//
//   linearity (to - from) (1 - 2 u^2),   u = (2 truth - from - to) / (to - from)
//
// of all parabolas the one that no line fits better. With it a truth is the root of a quadratic.
//
// Lag. A sensor follows by a first-order lag, x' = (truth - x) / lag, stepped exactly for a truth that runs straight from
// one look to the next. Where the lag is shorter than such a step the sensor is read as it was that long ago, to first
// order, y - lag y': the limit of the same. A delay by the same time differs from a lag by half its square times the
// acceleration; that distinguishes a slow sensor from a late clock.
//
// Clock. A logger whose clock is late by tau writes at t what was there at t - tau: whole samples by the index, the rest to
// first order. Only the record has it; a controller reads its own converter.
//
// What stands between the piston and a position sensor: a mount that yields under the force (frame_compliance) and play
// at the rod's eye (backlash). Play has a memory: the sensor is pushed by one side of the eye or the other, and rests
// while the rod crosses the gap.
//
// Which signals there are, and which parameters their sensors have, is in signals.def. All are effects: absent at zero.
#pragma once

#include <cmath>
#include <limits>

#include "sms/effect.hpp"
#include "sms/filter.hpp"
#include "sms/limit.hpp"

namespace sms {

// ---- gain and zero ----

template <typename S>
S sensor_reading(const S& truth, const S& gain, const S& offset) {
  return (S(1) + gain) * truth + offset;
}

template <typename S>
S sensor_truth(const S& reading, const S& gain, const S& offset) {
  return (reading - offset) / (S(1) + gain);
}

// What is wrong with one sensor, by the parameters.
template <typename S>
struct SensorErrors {
  S gain, offset;    // offset in the signal's unit
  S lag;             // s, of its filter
  S clock;           // s, of its logger
  S datum;           // in the signal's unit
  S linearity{0};    // of its span
  S from{0}, to{1};  // its span, in the signal's unit

  S reading(const S& truth) const {
    const S straight = has_datum() ? S(truth + gain * (truth - datum) + offset) : sensor_reading(truth, gain, offset);
    if (is_absent(linearity)) {
      return straight;
    }
    const S u = place(truth);
    return straight + linearity * (to - from) * (S(1) - S(2) * u * u);
  }

  S truth(const S& reading) const {
    const S straight = sensor_truth(has_datum() ? S(reading + gain * datum) : reading, gain, offset);
    return is_absent(linearity) ? straight : bowed_truth(straight);
  }

  // By how much the reading rises with the truth.
  S slope(const S& truth) const {
    return is_absent(linearity) ? S(S(1) + gain) : S(S(1) + gain - S(8) * linearity * place(truth));
  }

 private:
  bool has_datum() const { return !is_absent(datum); }

  // From -1 to 1 over the span.
  S place(const S& truth) const { return (S(2) * truth - from - to) / (to - from); }

  // The root u of  u + bow (1 - 2 u^2) = w  at the straight line's w, in units of half the span.
  S bowed_truth(const S& straight) const {
    using std::sqrt;
    const S bow = S(2) * linearity / (S(1) + gain);
    const S above = place(straight) - bow;
    const S square = S(1) - S(8) * bow * above;
    const S root = sqrt(square > S(0.25) ? square : S(0.25));  // less is far outside of the span
    return S(0.5) * (from + to) + (to - from) * above / (S(1) + root);
  }
};

// extension_sensor(p), supply_pressure_sensor(p), ...
#define SMS_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate, lag, clock, datum, \
                   from, to, ...)                                                                                    \
  template <typename S>                                                                                              \
  SensorErrors<S> name##_sensor(const Params<S>& p) {                                                                \
    return {p.sensor_gain_##name,                                                                                    \
            p.sensor_offset_##name,                                                                                  \
            S(lag),                                                                                                  \
            S(clock),                                                                                                \
            S(datum),                                                                                                \
            p.sensor_linearity_##name,                                                                               \
            S(from),                                                                                                 \
            S(to)};                                                                                                  \
  }
#include "sms/signals.def"

// ---- lag ----

// y as it was `late` ago.
template <typename S>
S late_reading(const S& value, const S& rate, const S& late) {
  return value - late * rate;
}

// A sensor and its filter in time.
template <typename S>
class Sensor {
 public:
  Sensor() = default;
  // step: from one look at the truth to the next, s.
  Sensor(const SensorErrors<S>& errors, const S& step) : errors_(errors), step_(step) {
    if (value_of(errors.lag) > value_of(step)) {
      follows_ = true;
      weight_ = low_pass_weight<S>(S(1) / errors.lag, step);
    }
  }

  // From the next look on they are this far apart, s.
  void look_every(const S& step) {
    step_ = step;
    if (follows_) {
      weight_ = low_pass_weight<S>(S(1) / errors_.lag, step);
    }
  }

  // The ends of its range, in the signal's unit: it says no less and no more.
  void limit(const S& lowest, const S& highest) {
    lowest_ = lowest;
    highest_ = highest;
    ends_ = true;
  }

  const SensorErrors<S>& errors() const { return errors_; }
  bool follows() const { return follows_; }

  // Where its filter stands at the first look, if it is not that of a truth that has been rising steadily for long.
  void begin(const S& filtered) {
    filtered_ = filtered;
    given_ = true;
  }

  // The truth a step after the last call.
  void follow(const S& truth, const S& rate) {
    if (!follows_) {
      return;
    }
    if (begun_) {
      filtered_ = low_pass_ramp_step<S>(S(1) / errors_.lag, step_, weight_, filtered_, before_, truth);
    } else if (!given_) {
      filtered_ = late_reading<S>(truth, rate, errors_.lag);
    }
    before_ = truth;
    begun_ = true;
  }

  // What it says at this truth, `late` seconds ago.
  S reading(const S& truth, const S& rate, const S& late = S(0)) const {
    const S said = errors_.reading(follows_ ? late_reading<S>(filtered_, (truth - filtered_) / errors_.lag, late)
                                            : late_reading<S>(truth, rate, late + errors_.lag));
    return ends_ ? limited(said, lowest_, highest_) : said;
  }

 private:
  SensorErrors<S> errors_{};
  S step_{0}, filtered_{0}, weight_{0}, before_{0}, lowest_{0}, highest_{0};
  bool follows_ = false, given_ = false, begun_ = false, ends_ = false;
};

// ---- mount and play ----

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

// ---- noise, range, rounding ----

enum class Rounding : int {
  nearest,
  down  // what a converter does that counts full steps
};

template <typename S>
S rounded(const S& value, const S& step, Rounding rounding) {
  using std::floor;
  return step * floor(value / step + (rounding == Rounding::nearest ? S(0.5) : S(0)));
}

// What a logger's channel makes of a reading; as it stands here: nothing.
template <typename S>
struct Channel {
  S noise = S(0);                            // standard deviation, in the signal's unit
  S low = std::numeric_limits<S>::lowest();  // ends of the range, where the reading stays
  S high = std::numeric_limits<S>::max();
  S resolution = S(0);  // step of its converter
  Rounding rounding = Rounding::nearest;

  // draw: standard normal.
  S recorded(const S& reading, const S& draw) const {
    const S seen = limited<S>(reading + noise * draw, low, high);
    return resolution > S(0) ? rounded(seen, resolution, rounding) : seen;
  }
};

// ---- clock ----

// How many whole samples a clock is late, and what is left of it, s.
template <typename S>
int whole_samples(const ValueOf<S>& step, const S& late, S* rest) {
  using std::floor;
  const int samples = static_cast<int>(floor(value_of(late) / step + ValueOf<S>(0.5)));
  *rest = late - S(ValueOf<S>(samples) * step);
  return samples;
}

}  // namespace sms
