// .bin: lines of text that say all about the numbers after them, padded to a multiple of 64 bytes, then the numbers,
// little-endian: roll, pitch, height (the nodes of the axes), extension.
#include <ostream>

#include "bytes.hpp"
#include "formats.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr const char* kMagic = "sms_table 1\n";

void write(const Table& table, const std::string& /*name*/, std::ostream& out) {
  const auto count = [](const std::vector<double>& axis) { return "[" + text(axis.size()) + "]"; };
  const std::string roll = count(table.roll), pitch = count(table.pitch), height = count(table.height);
  const std::string data = "roll" + roll + " pitch" + pitch + " height" + height + " extension" + roll + pitch +
                           (table.height.size() == 1 ? "" : height) + "[3]";
  const std::string before = std::string(kMagic) + "header_bytes: ";
  const std::string after = "\n" + description(table, "") +
                            "precision: " + (table.precision == Precision::kFloat ? "float" : "double") +
                            "\nbyte_order: little\ndata: " + data + "\n";
  constexpr std::size_t kDigits = 4;
  const std::size_t used = before.size() + kDigits + after.size() + 1;
  const std::size_t size = (used + kAlignment - 1) / kAlignment * kAlignment;
  std::string bytes = before + std::string(kDigits - text(size).size(), ' ') + text(size) + after;
  bytes.resize(size - 1, ' ');
  bytes += '\n';
  append_numbers(bytes, table.roll, table.precision);
  append_numbers(bytes, table.pitch, table.precision);
  append_numbers(bytes, table.height, table.precision);
  append_numbers(bytes, table.extension, table.precision);
  out << bytes;
}

Table read(std::istream& in) {
  const std::string bytes = whole(in);
  if (bytes.rfind(kMagic, 0) != 0) {
    throw std::runtime_error("it does not begin with sms_table 1");
  }
  const std::string lines = bytes.substr(0, std::stoul(described(bytes, "header_bytes")));
  Reader reader(bytes, lines.size());
  const Precision precision = described(lines, "precision") == "float" ? Precision::kFloat : Precision::kDouble;
  const std::string data = described(lines, "data");
  const auto numbers = [&](const std::string& name) {
    return reader.numbers(std::stoul(data.substr(data.find(name + "[") + name.size() + 1)), precision);
  };
  Table table;
  table.roll = numbers("roll");
  table.pitch = numbers("pitch");
  table.height = numbers("height");
  table.extension = reader.numbers(3 * table.roll.size() * table.pitch.size() * table.height.size(), precision);
  table.precision = precision;
  table.version = described(lines, "version");
  table.geometry_hash = described(lines, "geometry_hash");
  return table;
}

}  // namespace

const Format kRaw = {"raw", ".bin", Precision::kDouble, "numbers after a header that reads as text: head -n 12 FILE",
                     write, read};

}  // namespace ik_tables
