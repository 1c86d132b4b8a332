// A choice that Python makes by its name, or by its number.
#pragma once

#include <string>
#include <utility>

#include "bind.hpp"

namespace sms_python {

// The value that belongs to `name`; ValueError with the names that there are.
template <typename Value, std::size_t N>
Value choice(const char* what, const std::string& name, const std::pair<const char*, Value> (&choices)[N]) {
  std::string names;
  for (const auto& one : choices) {
    if (name == one.first) {
      return one.second;
    }
    names += std::string(names.empty() ? "" : ", ") + "'" + one.first + "'";
  }
  throw py::value_error(std::string(what) + " = '" + name + "' is none of " + names);
}

// The value that belongs to a number from 0 on, of so many; ValueError.
template <typename Value>
Value choice(const char* what, int number, int count) {
  if (number < 0 || number >= count) {
    throw py::value_error(std::string(what) + " = " + std::to_string(number) + " is none of the numbers from 0 to " +
                          std::to_string(count - 1));
  }
  return static_cast<Value>(number);
}

}  // namespace sms_python
