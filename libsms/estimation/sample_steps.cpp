#include "estimation/sample_steps.hpp"

namespace sms {
namespace estimation {
namespace {

// Five times the speed at which dry friction has risen from rest (stiction_velocity, params.def): a piston that is faster
// is beyond its kink.
constexpr double kFast = 0.025;  // m/s
// On either side: longer than a valve and a chamber take to stop a piston that is not seen slowing down.
constexpr double kAround = 0.01;  // s

// Of the time since a tank's command has moved, a step: what it has started fades over as long as it has lasted, and a step
// of second order follows it to the square of that. Where steps grow faster, the trace of a late command differs from that
// of an initial state by more than it should, and its standard error comes out too small: 3 % at twice the share.
constexpr double kStepOverRest = 0.005;

// From the longest step at each sample, s: none goes on to where a shorter one is asked for.
SampleSteps within(const std::vector<double>& longest, double step) {
  std::vector<Pace> paces(longest.size());
  int ahead = 0;
  for (std::size_t k = longest.size(); k-- > 0;) {
    ahead = k + 1 < longest.size() && !(longest[k + 1] < longest[k]) ? ahead + 1 : 1;
    paces[k].parts = steps_over(step, longest[k]);
    paces[k].samples = std::max(1, std::min(ahead, static_cast<int>(longest[k] / step + 1e-9)));
  }
  return SampleSteps(std::move(paces));
}

}  // namespace

SampleSteps steps_by_motion(const std::vector<const Eigen::VectorXd*>& extensions, double step,
                            const LongestSteps& longest) {
  const int around = steps_over(kAround, step);
  const int samples = static_cast<int>(extensions.front()->size());
  // The speed at a sample, by the readings around it, is that of them all.
  std::vector<int> slow_since(static_cast<std::size_t>(samples) + 1, 0);  // slow samples before each
  for (int k = 0; k < samples; ++k) {
    const int from = std::max(0, k - around), to = std::min(samples - 1, k + around);
    const auto is_slow = [&](const Eigen::VectorXd* x) {
      return !(std::abs((*x)[to] - (*x)[from]) > kFast * step * (to - from));
    };
    slow_since[static_cast<std::size_t>(k) + 1] =
        slow_since[static_cast<std::size_t>(k)] + (std::any_of(extensions.begin(), extensions.end(), is_slow) ? 1 : 0);
  }
  std::vector<double> longest_at(static_cast<std::size_t>(samples), longest.near_events);
  for (int k = around; k + around + 1 < samples; ++k) {
    const int slow =
        slow_since[static_cast<std::size_t>(k + around + 2)] - slow_since[static_cast<std::size_t>(k - around)];
    longest_at[static_cast<std::size_t>(k)] = slow > 0 ? longest.near_events : longest.elsewhere;
  }
  return within(longest_at, step);
}

SampleSteps steps_by_command(const Eigen::VectorXd& command, double step, const LongestSteps& longest) {
  constexpr double kBefore = 1e3;  // s: the first value was held before the record
  const int samples = static_cast<int>(command.size());
  const auto differ = [&](int k) { return k > 0 && k < samples && std::abs(command[k] - command[k - 1]) > 0.0; };
  std::vector<double> longest_at(static_cast<std::size_t>(samples));
  double since = kBefore;
  for (int k = 0; k < samples; ++k) {
    since = differ(k) ? 0.0 : since + step;
    const double rested = differ(k + 1) ? 0.0 : since;
    longest_at[static_cast<std::size_t>(k)] = longest.allowed(kStepOverRest * rested);
  }
  return within(longest_at, step);
}

}  // namespace estimation
}  // namespace sms
