// One numpy array as the bytes of an .npy file, version 1.0 (numpy.lib.format).
#pragma once

#include <string>
#include <vector>

#include "grid.hpp"

namespace ik_tables {

// The header is a Python literal; `remark` goes into it as a comment, where numpy leaves it alone.
std::string npy(const std::vector<double>& numbers, const std::vector<std::size_t>& shape, Precision precision,
                const std::string& remark = "");
std::string npy(const std::string& characters);  // a string, as an array without dimensions

struct Array {
  std::vector<double> numbers;
  std::vector<std::size_t> shape;
  Precision precision;
  std::string characters;  // of a string, which has no numbers
  std::string remark;      // the comment in the header
};
Array parse_npy(const std::string& bytes);

}  // namespace ik_tables
