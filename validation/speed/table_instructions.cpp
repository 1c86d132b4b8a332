// One lookup or one solve after the other, for a program that counts instructions: table_instructions WORK SCALAR,
// where WORK is bilinear, bicubic, trilinear, tricubic, warm or cold, and SCALAR float or double. What is to be counted
// lies in measured(). Prints how many calls there were, the mean number of Newton steps, and the largest error, m.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "sms/inverse_kinematics.hpp"
#include "sms/table.hpp"

namespace {

constexpr int kCalls = 2000;
constexpr int kNodes = 21, kHeights = 5;
constexpr double kAngle = 0.1, kLow = 0.49, kHigh = 0.51;

template <typename Work>
[[gnu::noinline]] bool measured(const Work& work) {
  return work() == SMS_OK;
}

// The ship's motion as a controller samples it, at 1 kHz: one pose follows the other closely.
sms::Vec3<double> pose_at(int sample) {
  const double time = 1e-3 * sample;
  return {0.095 * std::sin(1.9 * time), 0.095 * std::sin(2.3 * time + 1.0), 0.5 + 0.009 * std::sin(3.1 * time)};
}

template <typename S>
struct Bench {
  sms::Geometry<S> geometry = sms::make_geometry(sms::Params<S>());
  sms::Pose<S> pose = sms::rest_pose(geometry);
  sms::Convergence<S> convergence = {};
  std::vector<S> numbers;
  sms::Table<S> table = {};

  sms_status solve(const sms::Vec3<S>& q, const sms::Pose<S>& start, sms::Vec3<S>& extension) {
    return sms::inverse_kinematics(geometry, q, start, pose, extension, &convergence);
  }

  void fill(int heights) {
    const S step = S(2 * kAngle / (kNodes - 1)), height_step = heights == 1 ? S(0) : S((kHigh - kLow) / (heights - 1));
    const S lowest = heights == 1 ? S(0.5) : S(kLow), per_height = heights == 1 ? S(0) : S(1) / height_step;
    for (int i = 0; i < kNodes * kNodes * heights; ++i) {
      const int roll = i / (kNodes * heights), pitch = i / heights % kNodes, height = i % heights;
      sms::Vec3<S> node;
      solve({S(-kAngle) + step * S(roll), S(-kAngle) + step * S(pitch), lowest + height_step * S(height)},
            sms::rest_pose(geometry), node);
      numbers.insert(numbers.end(), node.data(), node.data() + 3);
    }
    const sms::TableAxis<S> angle = {kNodes, S(-kAngle), S(kAngle), S(1) / step};
    table = {angle, angle, {heights, lowest, heights == 1 ? lowest : S(kHigh), per_height}, numbers.data()};
  }

  template <typename Work>
  int run(bool one_height, const Work& work) {
    sms::Geometry<double> exact = sms::make_geometry(sms::Params<double>());
    double error = 0.0;
    long steps = 0;
    for (int i = 0; i < kCalls; ++i) {
      sms::Vec3<double> q = pose_at(i);
      q(2) = one_height ? 0.5 : q(2);
      const sms::Vec3<S> asked = q.template cast<S>();
      sms::Vec3<S> extension;
      if (!measured([&] { return work(asked, extension); })) {
        return 1;
      }
      steps += convergence.iterations;
      sms::Pose<double> truth_pose;
      sms::Vec3<double> truth;
      sms::inverse_kinematics(exact, q, sms::rest_pose(exact), truth_pose, truth);
      error = std::max(error, (extension.template cast<double>() - truth).cwiseAbs().maxCoeff());
    }
    std::printf("%d %g %g\n", kCalls, double(steps) / kCalls, error);
    return 0;
  }

  int main_of(const std::string& what) {
    using Vec = sms::Vec3<S>;
    if (what == "warm") {
      return run(false, [this](const Vec& q, Vec& e) { return solve(q, pose, e); });
    }
    if (what == "cold") {
      const sms::Pose<S> rest = sms::rest_pose(geometry);
      return run(false, [this, rest](const Vec& q, Vec& e) { return solve(q, rest, e); });
    }
    fill(what[0] == 'b' ? 1 : kHeights);
    convergence.iterations = 0;
    if (what == "bilinear") {
      return run(true, [this](const Vec& q, Vec& e) { return sms::table_bilinear(table, q(0), q(1), e); });
    }
    if (what == "bicubic") {
      return run(true, [this](const Vec& q, Vec& e) { return sms::table_bicubic(table, q(0), q(1), e); });
    }
    if (what == "trilinear") {
      return run(false, [this](const Vec& q, Vec& e) { return sms::table_trilinear(table, q(0), q(1), q(2), e); });
    }
    return run(false, [this](const Vec& q, Vec& e) { return sms::table_tricubic(table, q(0), q(1), q(2), e); });
  }
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    return 2;
  }
  return std::string(arguments[2]) == "float" ? Bench<float>().main_of(arguments[1])
                                              : Bench<double>().main_of(arguments[1]);
}
