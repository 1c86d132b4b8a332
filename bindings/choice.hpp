// A choice that Python makes by its name.
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

}  // namespace sms_python
