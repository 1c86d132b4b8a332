#include "grid.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "sms/kinematics.h"
#include "text.hpp"

namespace ik_tables {
namespace {

// A node without a solution.
struct Failure {
  std::size_t roll;  // its index
  sms::Vec3<double> q;
  sms_status status;
};

constexpr std::size_t kRowsAtATime = 8;  // the library solves four poses at once where the processor can

// Of a row, the last poses that were solved, the last one first.
struct Row {
  sms_pose last[3];
  std::size_t solved;

  // The parasitic coordinates are smooth along a row. The parabola through the last three poses meets the next one so
  // closely that a single Newton step is left, where the last pose alone leaves two.
  sms_pose extrapolated() const {
    const sms_pose &a = last[0], &b = last[1], &c = last[2];
    if (solved < 3) {
      return a;
    }
    const auto next = [](double latest, double before, double first) { return 3.0 * (latest - before) + first; };
    return {a.roll, a.pitch, a.height, next(a.yaw, b.yaw, c.yaw), next(a.x, b.x, c.x), next(a.y, b.y, c.y)};
  }

  void add(const sms_pose& pose) {
    last[2] = last[1];
    last[1] = last[0];
    last[0] = pose;
    ++solved;
  }
};

// A row is one roll and one height; its nodes are the pitches. Rows first to end - 1 side by side, node after node.
std::optional<Failure> solve_rows(const sms_geometry& geometry, std::size_t first, std::size_t end, std::size_t l,
                                  Table& table) {
  const std::size_t count = end - first;
  sms_pose rest;
  sms_rest_pose(&geometry, &rest);
  Row row[kRowsAtATime];
  std::fill_n(row, count, Row{{rest, rest, rest}, 0});
  double q[3 * kRowsAtATime], extension[3 * kRowsAtATime];
  sms_pose pose[kRowsAtATime];
  sms_status status[kRowsAtATime];
  for (std::size_t k = 0; k < table.pitch.size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      q[3 * i] = table.roll[first + i];
      q[3 * i + 1] = table.pitch[k];
      q[3 * i + 2] = table.height[l];
      pose[i] = row[i].extrapolated();
    }
    sms_inverse_kinematics_array(&geometry, count, q, pose, pose, extension, nullptr, status);
    for (std::size_t i = 0; i < count; ++i) {
      if (status[i] != SMS_OK) {
        status[i] = sms_inverse_kinematics(&geometry, q + 3 * i, &rest, &pose[i], extension + 3 * i, nullptr);
      }
      if (status[i] != SMS_OK) {
        return Failure{first + i, sms::Vec3<double>(q[3 * i], q[3 * i + 1], q[3 * i + 2]), status[i]};
      }
      row[i].add(pose[i]);
      double* node = &table.extension[3 * (((first + i) * table.pitch.size() + k) * table.height.size() + l)];
      std::copy_n(extension + 3 * i, 3, node);
    }
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
  const sms_geometry& machine = reinterpret_cast<const sms_geometry&>(geometry);
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex mutex;
  std::optional<Failure> first;
  // A thread takes all heights of some rolls, which lie next to each other in memory.
  const auto work = [&] {
    for (std::size_t i = next.fetch_add(kRowsAtATime); i < rolls; i = next.fetch_add(kRowsAtATime)) {
      const std::size_t end = std::min(rolls, i + kRowsAtATime);
      std::optional<Failure> failure;
      for (std::size_t l = 0; l < table.height.size() && !failure; ++l) {
        failure = solve_rows(machine, i, end, l, table);
      }
      if (failure) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!first || failure->roll < first->roll) {
          first = failure;
        }
        next = rolls;
      }
      progress.share(double(done += end - i) / double(rolls));
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
