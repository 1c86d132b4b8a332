#include "formats.hpp"

#include "text.hpp"

namespace ik_tables {
namespace {

std::string range(const std::vector<double>& nodes, Precision precision, const char* unit) {
  const std::string first = text(nodes.front(), precision);
  if (nodes.size() == 1) {
    return first + " " + unit;
  }
  return first + " to " + text(nodes.back(), precision) + " " + unit + ", " + text(nodes.size()) + " nodes";
}

bool ends_with(const std::string& whole, const std::string& end) {
  return whole.size() > end.size() && whole.compare(whole.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

const Format* format_named(const std::string& name) {
  for (const Format* format : kFormats) {
    if (format->name == name) {
      return format;
    }
  }
  return nullptr;
}

const Format* format_of_file(const std::string& file) {
  for (const Format* format : kFormats) {
    if (ends_with(file, format->ending)) {
      return format;
    }
  }
  return nullptr;
}

std::string description(const Table& table, const std::string& before_each_line) {
  const std::string height = table.height.size() == 1 ? "" : "[height]";
  const std::string lines[] = {
      "made_by: ik_tables of libsms",
      "version: " + table.version,
      "geometry_hash: " + table.geometry_hash,
      std::string("units: ") + kUnits,
      "roll: " + range(table.roll, table.precision, "rad"),
      "pitch: " + range(table.pitch, table.precision, "rad"),
      "height: " + range(table.height, table.precision, "m"),
      "order: extension[roll][pitch]" + height + "[actuator]",
  };
  std::string all;
  for (const std::string& line : lines) {
    all += before_each_line + line + "\n";
  }
  return all;
}

std::string described(const std::string& lines, const std::string& key) {
  const std::size_t start = lines.find(key + ": ");
  if (start == std::string::npos) {
    throw std::runtime_error("it has no " + key);
  }
  const std::size_t value = start + key.size() + 2;
  return lines.substr(value, lines.find('\n', value) - value);
}

}  // namespace ik_tables
