// How the time of a record is cut into steps of the integration: into several from one sample to the next, or into one over
// several samples.
//
// What asks for short steps on an actuator is its friction: over the kink at standstill a piston that stops chatters
// where a step is long (integrate_stiff.hpp). Everywhere else the air sets the pace, and that is slower by far. So a
// sample gets short steps where the record says that a piston may stop, and longer ones where it is well on its way. On a
// tank an opening takes milliseconds, what follows seconds: steps are short while the command moves, and grow with the time
// since.
//
// What limits the longer ones are not the readings but their derivatives: a late command and a slow spool leave traces
// that hardly differ from that of another initial state, and over steps of unlike lengths they differ by more.
//
// The record says it and not the simulation: the steps are the same at whatever parameters, and a residual stays smooth in
// them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sms {
namespace estimation {

// From a sample on: `parts` steps to the next one, or one step over `samples`.
struct Pace {
  int parts = 1;
  int samples = 1;
  bool operator==(const Pace& o) const { return parts == o.parts && samples == o.samples; }
};

// One step of the integration: number `part` of those from a sample on.
struct Step {
  int sample, part;
  Pace pace;
  // In samples.
  double begins() const { return sample + double(part) / pace.parts; }
  double ends() const { return sample + double((part + 1) * pace.samples) / pace.parts; }
};

// Steps of an integration over a time, each within longest_step.
inline int steps_over(double time, double longest_step) {
  return std::max(1, static_cast<int>(std::ceil(time / longest_step - 1e-9)));
}

// The steps of a record.
class SampleSteps {
 public:
  explicit SampleSteps(int parts) : most_(parts) {}
  explicit SampleSteps(std::vector<Pace> of_sample) : of_(std::move(of_sample)) {
    for (const Pace& pace : of_) {
      most_ = std::max(most_, pace.parts);
    }
  }

  Pace of(int sample) const { return of_.empty() ? Pace{most_, 1} : of_[static_cast<std::size_t>(sample)]; }
  // From a sample to the next one at most.
  int most() const { return most_; }

 private:
  std::vector<Pace> of_;
  int most_ = 1;
};

// The longest steps, s.
struct LongestSteps {
  double near_events;  // where a piston may stop, or the command of a tank has just moved
  double elsewhere;
  LongestSteps(double everywhere)
      : LongestSteps(everywhere, everywhere) {}  // NOLINT(google-explicit-constructor): both
  LongestSteps(double near_events_, double elsewhere_) : near_events(near_events_), elsewhere(elsewhere_) {}
  // The nearest to a step that they allow.
  double allowed(double step) const { return std::max(near_events, std::min(step, elsewhere)); }
};

// Of a record of pistons, by their extensions, m; step: of the record, s.
SampleSteps steps_by_motion(const std::vector<const Eigen::VectorXd*>& extensions, double step,
                            const LongestSteps& longest);

// Of a record of a tank, by its command, V; step: of the record, s. Long where the command has rested for long.
SampleSteps steps_by_command(const Eigen::VectorXd& command, double step, const LongestSteps& longest);

}  // namespace estimation
}  // namespace sms
