// Level, then excite (dissertation, section 7.3.1): the platform is brought to its mid-position under position control,
// and when it has settled the excitation takes over for a given time; then the loop is closed again, for as many cycles
// as asked. The first cycle of the machine differs from the rest, which is why the source evaluates the second.
//
// The sequencer counts samples, so that a run is the same on every machine. During the excitation an open-loop test
// sends the excitation to the valve as it is (the source does it through the controller's gain, divided out before), a
// closed-loop test makes it the setpoint.
#pragma once

namespace sms {

enum class TestPhase : int { level, excite, finished };

struct SequencerSettings {
  unsigned long level_samples;   // per cycle, before the excitation
  unsigned long excite_samples;  // per cycle
  unsigned long cycles;          // 0: level for ever
};

// All zero: the start of the first cycle.
struct Sequencer {
  unsigned long cycle;   // 0 first
  unsigned long sample;  // since the cycle began; 32 bits run over after 49 days at 1 kHz, without harm
};

// What holds for one sample.
struct SequencerStep {
  TestPhase phase;
  unsigned long cycle;
  unsigned long sample;  // since the phase began: times the period, the excitation's time
};

// The present sample; the state moves on to the next.
inline SequencerStep sequencer_step(const SequencerSettings& settings, Sequencer& state) {
  if (settings.cycles > 0 && state.cycle >= settings.cycles) {
    return {TestPhase::finished, settings.cycles, state.sample++};
  }
  const bool exciting = settings.cycles > 0 && state.sample >= settings.level_samples;
  const SequencerStep step = {exciting ? TestPhase::excite : TestPhase::level, state.cycle,
                              exciting ? state.sample - settings.level_samples : state.sample};
  ++state.sample;
  if (settings.cycles > 0 && state.sample >= settings.level_samples + settings.excite_samples) {
    ++state.cycle;
    state.sample = 0;
  }
  return step;
}

// Ends the test: from the next sample on it is finished, and the loop closed.
inline void sequencer_stop(const SequencerSettings& settings, Sequencer& state) {
  state.cycle = settings.cycles;
  state.sample = 0;
}

}  // namespace sms
