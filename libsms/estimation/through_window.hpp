// A plant through a window: the loop that its simulations share. Where a step goes over several samples, those within it are
// read from the cubic through both ends and their rates (Hermite; Hairer, Norsett and Wanner, Solving Ordinary Differential
// Equations I, section II.6).
#pragma once

#include <algorithm>

#include "estimation/sample_steps.hpp"
#include "sms/integrate_stiff.hpp"

namespace sms {
namespace estimation {

// At a share of a step of length h; rate: there.
template <typename State>
State within_step(const State& from, const State& from_rate, const State& to, const State& to_rate, double share,
                  double h, State* rate) {
  using S = typename State::Scalar;
  const double rest = 1.0 - share;
  State rise, state;  // rise: over the step, per second
  vector_of(rise) = S(1.0 / h) * (vector_of(to) - vector_of(from));
  vector_of(state) = S(rest) * vector_of(from) + S(share) * vector_of(to) +
                     S(h * share * rest) * (S(rest) * (vector_of(from_rate) - vector_of(rise)) -
                                            S(share) * (vector_of(to_rate) - vector_of(rise)));
  vector_of(*rate) = S(6.0 * share * rest) * vector_of(rise) + S(rest * (rest - 2.0 * share)) * vector_of(from_rate) +
                     S(share * (share - 2.0 * rest)) * vector_of(to_rate);
  return state;
}

// From `state` at sample `first` of a record, through `samples`. Samples count from the first.
//
//   rates(step, state, rate)        the plant's rates where a step begins
//   look(sample, part, state, rate) its sensors see it, that part after a sample
//   driven(step, state, rate)       what drives it has its say
//   read(sample, state, rate)       a sample is held against the record
//   advance(step, h, rate, state)   one step of h; rate is used up
//   look_every(time)                from the next look on they are so far apart, s
template <typename S, typename State, typename Rates, typename Look, typename Driven, typename Read, typename Advance,
          typename LookEvery>
void through_window(const SampleSteps& steps, int first, int samples, double record_step, State& state,
                    const Rates& rates, const Look& look, const Driven& driven, const Read& read,
                    const Advance& advance, const LookEvery& look_every) {
  Pace pace{steps.most(), 1};         // of the step that has led here
  State rate{}, from{}, from_rate{};  // the last two where it began
  S h(record_step / pace.parts);
  for (int k = 0;; k += pace.samples) {
    Pace next = steps.of(first + k);
    next.samples = std::max(1, std::min(next.samples, samples - 1 - k));
    for (int i = 0; i < next.parts; ++i) {
      const Step step{k, i, next};
      rates(step, state, rate);
      for (int ago = i == 0 ? pace.samples - 1 : 0; ago > 0; --ago) {
        State there_rate;
        const State there = within_step<State>(from, from_rate, state, rate, 1.0 - double(ago) / pace.samples,
                                               pace.samples * record_step, &there_rate);
        look(k - ago, 0.0, there, there_rate);
        read(k - ago, there, there_rate);
      }
      look(k, double(i) / next.parts, state, rate);
      driven(step, state, rate);
      if (i == 0) {
        read(k, state, rate);
        if (k == samples - 1) {
          return;
        }
        if (!(next == pace)) {
          pace = next;
          h = S(pace.samples * record_step / pace.parts);
          look_every(S(record_step / pace.parts));
        }
      }
      if (pace.samples > 1) {
        from = state;
        from_rate = rate;
      }
      advance(step, h, rate, state);
    }
  }
}

}  // namespace estimation
}  // namespace sms
