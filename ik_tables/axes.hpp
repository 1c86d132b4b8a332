// From words on the command line to numbers and to the nodes of an axis. All throw BadInput that names the option.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grid.hpp"

namespace ik_tables {

double number(const std::string& option, const std::string& word);
std::uint64_t whole_number(const std::string& option, const std::string& word, std::uint64_t least, std::uint64_t most);

struct Range {
  double lower;
  double upper;
};
Range range(const std::string& option, const std::string& word);  // "R" for -R to R, or "A:B"

// Nodes a step apart, whose unit is in rad: 1, or that of a degree.
std::vector<double> angles(const Range& range, double step, double unit, Precision precision);

// "0.5", or several that ascend evenly: as words, with commas, or "first:last:step".
std::vector<double> heights(const std::string& option, const std::vector<std::string>& words, Precision precision);

}  // namespace ik_tables
