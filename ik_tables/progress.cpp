#include "progress.hpp"

#include <chrono>
#include <cstdio>

namespace ik_tables {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);
constexpr auto kInterval = std::chrono::seconds(1);

}  // namespace

Progress::Progress(bool quiet) {
  if (!quiet) {
    watcher_ = std::thread(&Progress::watch, this);
  }
}

Progress::~Progress() {
  if (watcher_.joinable()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      finished_ = true;
    }
    over_.notify_one();
    watcher_.join();
  }
}

void Progress::begin(const char* what) {
  what_ = what;
  share_ = -1.0;
}

void Progress::watch() {
  std::unique_lock<std::mutex> lock(mutex_);
  auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(kPatience);
  for (int seconds = int(kPatience.count()); !over_.wait_for(lock, wait, [this] { return finished_; }); ++seconds) {
    wait = kInterval;
    const double share = share_;
    if (share >= 0.0) {
      std::fprintf(stderr, "ik_tables: %d s, %s, %.0f %%\n", seconds, what_.load(), 100.0 * share);
    } else {
      std::fprintf(stderr, "ik_tables: %d s, %s\n", seconds, what_.load());
    }
  }
}

}  // namespace ik_tables
