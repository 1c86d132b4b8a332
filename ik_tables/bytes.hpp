// Numbers as the binary formats hold them: little-endian, as this machine has them.
#pragma once

#include <cstring>
#include <istream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "grid.hpp"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "ik_tables writes binary files on little-endian machines");

namespace ik_tables {

inline std::size_t size_of(Precision precision) { return precision == Precision::kFloat ? 4 : 8; }

template <typename Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

inline void append_numbers(std::string& bytes, const std::vector<double>& numbers, Precision precision) {
  bytes.reserve(bytes.size() + numbers.size() * size_of(precision));
  for (const double number : numbers) {
    if (precision == Precision::kFloat) {
      append(bytes, float(number));
    } else {
      append(bytes, number);
    }
  }
}

inline std::string whole(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

// Takes a file apart from front to back.
class Reader {
 public:
  explicit Reader(const std::string& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}

  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t at() const { return at_; }

  std::string take(std::size_t size) {
    if (size > left()) {
      throw std::runtime_error("it ends too early");
    }
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  template <typename Number>
  Number number() {
    Number result;
    std::memcpy(&result, take(sizeof result).data(), sizeof result);
    return result;
  }

  std::vector<double> numbers(std::size_t count, Precision precision) {
    if (count > left() / size_of(precision)) {
      throw std::runtime_error("it ends too early");
    }
    std::vector<double> result(count);
    for (double& x : result) {
      x = precision == Precision::kFloat ? double(number<float>()) : number<double>();
    }
    return result;
  }

 private:
  const std::string& bytes_;
  std::size_t at_;
};

}  // namespace ik_tables
