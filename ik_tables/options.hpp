// What the user asked for on the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats.hpp"
#include "sms/params.hpp"

namespace ik_tables {

struct Options {
  sms::Params<double> params;
  std::vector<double> roll, pitch, height;  // nodes, rad and m, in the precision of the table
  std::string output;
  const Format* format = nullptr;
  Precision precision = Precision::kDouble;
  std::string name;  // of the table in a C header
  bool cubic = false;
  double max_error = 1e-4;
  int points = 10000;
  std::uint64_t seed = 0;
  unsigned threads = 1;
  bool json = false;
  bool quiet = false;
};

std::string help();

// Nothing when the user only asked for help or for the version, which then is printed. Throws BadInput.
std::optional<Options> parse(const std::vector<std::string>& arguments);

}  // namespace ik_tables
