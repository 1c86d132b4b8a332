// What became of a table, for a person and as JSON.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"
#include "verify.hpp"

namespace ik_tables {

struct Report {
  std::vector<std::size_t> shape;
  std::string version;
  std::string geometry_hash;
  double bytes = 0.0;    // of the file
  double solving = 0.0;  // s
  double stroke = 0.0;   // m
  StrokeUse use = {};
  Verification errors;
};

// The interpolation that --interpolation chose, and its error: in m or rad, nodes included.
const Interpolation& chosen(const Options& options, const Report& report);
double chosen_error(const Options& options, const Report& report);
std::string chosen_name(const Options& options);  // "bilinear"

std::string as_text(const Options& options, const Report& report);
std::string as_json(const Options& options, const Report& report);

}  // namespace ik_tables
