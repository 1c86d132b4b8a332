// Tells on a terminal or in a log how far the work is, once it takes longer than two seconds.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace ik_tables {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // From now on this is being done, e.g. "writing"; how much of it is done is not known until share() says so.
  void begin(const char* what);
  void share(double done) { share_ = done; }

 private:
  void watch();

  std::atomic<const char*> what_{""};
  std::atomic<double> share_{-1.0};
  std::mutex mutex_;
  std::condition_variable over_;
  bool finished_ = false;
  std::thread watcher_;
};

}  // namespace ik_tables
