#include "grid.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "sms/inverse_kinematics.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

using Pose = sms::Pose<double>;

// A node without a solution.
struct Failure {
  std::size_t roll;  // its index
  sms::Vec3<double> q;
  sms_status status;
};

// The parasitic coordinates are smooth along a row. The parabola through the last three poses meets the next one so
// closely that a single Newton step is left, where the last pose alone leaves two.
Pose extrapolated(const std::vector<Pose>& solved) {
  const std::size_t n = solved.size();
  if (n < 3) {
    return solved.back();
  }
  const Pose &a = solved[n - 1], &b = solved[n - 2], &c = solved[n - 3];
  const auto next = [](double last, double before, double first) { return 3.0 * (last - before) + first; };
  return {a.roll, a.pitch, a.height, next(a.yaw, b.yaw, c.yaw), next(a.x, b.x, c.x), next(a.y, b.y, c.y)};
}

// A row is one roll and one height; its nodes are the pitches.
std::optional<Failure> solve_row(const sms::Geometry<double>& geometry, std::size_t i, std::size_t l, Table& table) {
  const Pose rest = sms::rest_pose(geometry);
  std::vector<Pose> solved = {rest};
  solved.reserve(table.pitch.size() + 1);
  for (std::size_t k = 0; k < table.pitch.size(); ++k) {
    const sms::Vec3<double> q(table.roll[i], table.pitch[k], table.height[l]);
    Pose pose;
    sms::Vec3<double> extension;
    sms_status status = sms::inverse_kinematics(geometry, q, extrapolated(solved), pose, extension);
    if (status != SMS_OK) {
      status = sms::inverse_kinematics(geometry, q, rest, pose, extension);
    }
    if (status != SMS_OK) {
      return Failure{i, q, status};
    }
    if (k == 0) {
      solved.clear();  // the rest pose is no node
    }
    solved.push_back(pose);
    double* node = &table.extension[3 * ((i * table.pitch.size() + k) * table.height.size() + l)];
    std::copy_n(extension.data(), 3, node);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> shape(const Table& table) {
  if (table.height.size() == 1) {
    return {table.roll.size(), table.pitch.size(), 3};
  }
  return {table.roll.size(), table.pitch.size(), table.height.size(), 3};
}

double rounded(double number, Precision precision) {
  return precision == Precision::kFloat ? double(float(number)) : number;
}

std::vector<double> nodes(double lower, double upper, int count, Precision precision) {
  const double first = rounded(lower, precision), last = rounded(upper, precision);
  std::vector<double> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(rounded((first * (count - 1 - i) + last * i) / (count - 1), precision));
  }
  result.front() = first;
  result.back() = last;
  return result;
}

void solve(const sms::Geometry<double>& geometry, unsigned threads, Progress& progress, Table& table) {
  const std::size_t rolls = table.roll.size();
  table.extension.resize(3 * rolls * table.pitch.size() * table.height.size());
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex mutex;
  std::optional<Failure> first;
  // A thread takes all heights of a roll, which lie next to each other in memory.
  const auto work = [&] {
    for (std::size_t i = next++; i < rolls; i = next++) {
      std::optional<Failure> failure;
      for (std::size_t l = 0; l < table.height.size() && !failure; ++l) {
        failure = solve_row(geometry, i, l, table);
      }
      if (failure) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!first || failure->roll < first->roll) {
          first = failure;
        }
        next = rolls;
      }
      progress.share(double(++done) / double(rolls));
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < threads; ++i) {
    helpers.emplace_back(work);
  }
  work();
  for (std::thread& helper : helpers) {
    helper.join();
  }
  if (first) {
    throw BadInput("at roll " + text(first->q(0)) + " rad, pitch " + text(first->q(1)) + " rad, height " +
                   text(first->q(2)) + " m: " + sms_status_string(first->status) +
                   "; choose smaller ranges or another height");
  }
  for (double& extension : table.extension) {
    extension = rounded(extension, table.precision);
  }
}

StrokeUse stroke_use(const Table& table, double stroke) {
  StrokeUse use = {table.extension[0], table.extension[0], 0, long(table.extension.size() / 3)};
  for (std::size_t i = 0; i < table.extension.size(); i += 3) {
    const auto [least, most] = std::minmax({table.extension[i], table.extension[i + 1], table.extension[i + 2]});
    use.least = std::min(use.least, least);
    use.most = std::max(use.most, most);
    use.beyond += least < 0.0 || most > stroke ? 1 : 0;
  }
  return use;
}

}  // namespace ik_tables
