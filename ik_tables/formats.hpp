// The file formats. Each is written and read back by the same file, so that what is verified is what lies on the disk.
#pragma once

#include <iosfwd>
#include <string>

#include "grid.hpp"

namespace ik_tables {

struct Format {
  const char* name;    // as --format takes it
  const char* ending;  // of a file
  Precision usual;     // what --precision is unless it is given
  const char* meaning;
  // `name` is what a C header calls the table.
  void (*write)(const Table& table, const std::string& name, std::ostream& out);
  // Throws std::runtime_error when the file is not what write() makes.
  Table (*read)(std::istream& in);
};

extern const Format kNpz, kNpy, kMat, kCsv, kHeader, kRaw;
constexpr const Format* kFormats[] = {&kNpz, &kNpy, &kMat, &kCsv, &kHeader, &kRaw};

// nullptr when there is none.
const Format* format_named(const std::string& name);
const Format* format_of_file(const std::string& file);

constexpr const char* kUnits = "roll rad, pitch rad, height m, extension m";

// What every table carries, as lines "key: value": version, geometry_hash, units, the ranges, the order of the numbers.
std::string description(const Table& table, const std::string& before_each_line);

// The value of such a line; throws std::runtime_error when there is none.
std::string described(const std::string& lines, const std::string& key);

}  // namespace ik_tables
