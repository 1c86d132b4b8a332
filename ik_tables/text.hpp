// Numbers as text: the shortest that reads back as the same number.
#pragma once

#include <charconv>
#include <string>

#include "grid.hpp"

namespace ik_tables {

template <typename Number>
std::string text(Number number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

inline std::string text(double number, Precision precision) {
  return precision == Precision::kFloat ? text(float(number)) : text(number);
}

}  // namespace ik_tables
