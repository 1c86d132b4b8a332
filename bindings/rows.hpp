// Calls of the C ABI over the rows of numpy arrays: one status a row, NaN where it failed, both cores for many rows.
#pragma once

#include <algorithm>
#include <future>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "bind.hpp"

namespace sms_python {

// n rows of so many numbers, as they lie in memory in C.
using Rows = py::array_t<double, kInOrder>;
// One number a row, as far apart in memory as numpy keeps them.
using Column = py::array_t<double, kAnyOrder>;
using Status = py::array_t<int>;

inline py::ssize_t row_count(const Rows& rows, py::ssize_t width) {
  if (rows.ndim() != 2 || rows.shape(1) != width) {
    throw py::value_error("an array of shape (n, " + std::to_string(width) + ") is needed, not " +
                          py::str(rows.attr("shape")).cast<std::string>());
  }
  return rows.shape(0);
}

// Row i of every array belongs to row i of the others.
inline py::ssize_t common_row_count(std::initializer_list<const Rows*> arrays, py::ssize_t width) {
  const py::ssize_t n = row_count(**arrays.begin(), width);
  for (const Rows* array : arrays) {
    if (row_count(*array, width) != n) {
      throw py::value_error("as many rows in every array are needed");
    }
  }
  return n;
}

inline py::ssize_t common_size(std::initializer_list<const Column*> columns) {
  for (const Column* column : columns) {
    if (column->ndim() != 1 || column->size() != (*columns.begin())->size()) {
      throw py::value_error("as many numbers in every array are needed");
    }
  }
  return (*columns.begin())->size();
}

// Rows that a call writes.
class Output {
 public:
  Output(py::ssize_t rows, py::ssize_t width) : array_({rows, width}), data_(array_.mutable_data()), width_(width) {}
  double* row(py::ssize_t i) const { return data_ + i * width_; }
  template <typename Struct>
  Struct* row_as(py::ssize_t i) const {
    return reinterpret_cast<Struct*>(row(i));
  }
  void clear(py::ssize_t i) const { std::fill_n(row(i), width_, std::numeric_limits<double>::quiet_NaN()); }
  const Rows& array() const { return array_; }

 private:
  Rows array_;
  double* data_;
  py::ssize_t width_;
};

// work(begin, end) over all rows, in blocks that as many threads as there are cores take one after the other. The caller
// only waits: what `work` refers to lies on its stack, and a thread that writes its own variables beside it would take
// the line of cache from all others, row by row. Large blocks first: two threads that touch the same fresh page of
// memory would both have it cleared, and a page has two megabytes. Small ones last, so that none waits long for another.
template <typename Work>
void in_blocks(py::ssize_t rows, const Work& work) {
  constexpr py::ssize_t kSmallest = 4096, kRowsThatPay = 20000;
  const py::gil_scoped_release no_python;
  if (rows < kRowsThatPay) {
    work(py::ssize_t(0), rows);
    return;
  }
  const py::ssize_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::mutex one_at_a_time;
  py::ssize_t next = 0;
  const auto next_block = [&] {
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    const py::ssize_t begin = next, left = rows - begin;
    next += std::min(left, std::max(kSmallest, left / (2 * threads)));
    return std::make_pair(begin, next);
  };
  const auto take = [&] {
    for (auto block = next_block(); block.first < block.second; block = next_block()) {
      work(block.first, block.second);
    }
  };
  std::vector<std::future<void>> workers;
  for (py::ssize_t i = 0; i < threads; ++i) {
    workers.push_back(std::async(std::launch::async, take));
  }
  for (std::future<void>& worker : workers) {
    worker.get();
  }
}

// call(i), which gives a status, for every row; outputs of a row that failed become NaN.
template <typename Call>
Status each_row(py::ssize_t rows, std::initializer_list<const Output*> outputs, const Call& call) {
  Status status(rows);
  int* const written = status.mutable_data();
  in_blocks(rows, [&](py::ssize_t begin, py::ssize_t end) {
    for (py::ssize_t i = begin; i < end; ++i) {
      written[i] = call(i);
      if (written[i] != SMS_OK) {
        for (const Output* output : outputs) {
          output->clear(i);
        }
      }
    }
  });
  return status;
}

// Rows with a status each.
using Answer = py::typing::Tuple<Rows, Status>;

inline Answer answer(const Output& output, const Status& status) {
  return Answer(py::make_tuple(output.array(), status));
}

}  // namespace sms_python
