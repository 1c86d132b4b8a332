// A call without Python's lock, of an object that remembers what it found: a second thread that calls it waits.
#pragma once

#include <array>
#include <functional>
#include <mutex>

#include "bind.hpp"

namespace sms_python {

class Exclusive {
 public:
  explicit Exclusive(const void* object) : lock_(mutex_of(object)) {}

 private:
  // Objects share a few hundred mutexes: to have one each they would have to be known to the core.
  static std::mutex& mutex_of(const void* object) {
    static std::array<std::mutex, 509> mutexes;
    return mutexes[std::hash<const void*>()(object) % mutexes.size()];
  }

  py::gil_scoped_release no_python_;  // first, so that who waits for the object does not keep Python waiting
  std::lock_guard<std::mutex> lock_;
};

}  // namespace sms_python
