// The excitation of a test of the whole platform, leg by leg (dissertation, sections 7.3.4 and 7.3.5).
//
//   sine    A_i sin(2 pi f_i t) + o_i
//   chirp   A_i sin(2 pi ((f_2 - f_i) t / (2 T) + f_i) t) + o_i      (eq. 7.3)
//
// Amplitude, frequency and offset are each leg's own: in phase the platform heaves, with signs apart it rolls or
// pitches. Open loop they are volts around the valve's centre, which go to the valve as they are; the offset keeps a
// loaded platform from sinking. Closed loop they are metres around the extension of the level pose, and the setpoint.
//
// The time is counted in samples and starts at zero in every cycle, so that firmware and desk generate the same.
#pragma once

#include "sms/signal.hpp"

namespace sms {

enum class Waveform : int { sine, chirp };

template <typename S>
struct Excitation {
  Waveform waveform;
  S amplitude[3];    // V or m
  S frequency[3];    // Hz; of a chirp: at its start
  S offset[3];       // V or m
  S last_frequency;  // Hz, of a chirp at its end
  S duration;        // T, s
};

template <typename S>
S excitation_at(const Excitation<S>& e, int leg, const S& time) {
  if (e.waveform == Waveform::sine) {
    return sine<S>(time, e.amplitude[leg], e.frequency[leg], e.offset[leg]);
  }
  const Chirp<S> c = {e.amplitude[leg], e.frequency[leg], e.last_frequency, e.duration};
  return chirp<S>(c, time) + e.offset[leg];
}

}  // namespace sms
