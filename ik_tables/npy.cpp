#include "npy.hpp"

#include <ostream>

#include "bytes.hpp"
#include "formats.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

const std::string kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kAlignment = 64;
const std::string kRemark = " # ";

std::string replaced(std::string whole, const std::string& old, const std::string& now) {
  for (std::size_t i = whole.find(old); i != std::string::npos; i = whole.find(old, i + now.size())) {
    whole.replace(i, old.size(), now);
  }
  return whole;
}

// What stands between the first `before` and the next `after`.
std::string between(const std::string& whole, const std::string& before, const std::string& after) {
  const std::size_t found = whole.find(before);
  const std::size_t end = found == std::string::npos ? found : whole.find(after, found + before.size());
  if (end == std::string::npos) {
    throw std::runtime_error("it has no " + before);
  }
  return whole.substr(found + before.size(), end - found - before.size());
}

std::string tuple(const std::vector<std::size_t>& numbers) {
  std::string inside;
  for (const std::size_t n : numbers) {
    inside += (inside.empty() ? "" : ", ") + text(n);
  }
  return "(" + inside + (numbers.size() == 1 ? ",)" : ")");
}

std::vector<std::size_t> parse_tuple(const std::string& inside) {
  std::vector<std::size_t> numbers;
  for (std::size_t at = inside.find_first_of("0123456789"); at != std::string::npos;
       at = inside.find_first_of("0123456789", inside.find(',', at))) {
    numbers.push_back(std::stoul(inside.substr(at)));
  }
  return numbers;
}

std::string with_header(const std::string& type, const std::vector<std::size_t>& shape, const std::string& remark) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + tuple(shape) + ", }";
  header += remark.empty() ? "" : kRemark + remark;
  const std::size_t used = kMagic.size() + 2 + header.size() + 1;
  header += std::string((kAlignment - used % kAlignment) % kAlignment, ' ') + "\n";
  std::string bytes = kMagic;
  append(bytes, std::uint16_t(header.size()));
  return bytes + header;
}

// Nodes from "-0.1 to 0.1 rad, 201 nodes" or "0.5 m".
std::vector<double> parse_range(const std::string& range, Precision precision) {
  const double lower = std::stod(range);
  if (range.find(" to ") == std::string::npos) {
    return {rounded(lower, precision)};
  }
  return nodes(lower, std::stod(between(range, " to ", " ")), std::stoi(between(range, ", ", " nodes")), precision);
}

void write(const Table& table, const std::string& /*name*/, std::ostream& out) {
  std::string lines = description(table, "");
  lines.pop_back();
  out << npy(table.extension, shape(table), table.precision, replaced(lines, "\n", "; "));
}

Table read(std::istream& in) {
  const Array array = parse_npy(whole(in));
  const std::string lines = replaced(array.remark, "; ", "\n");
  const auto axis = [&](const char* key) { return parse_range(described(lines, key), array.precision); };
  return {axis("roll"),
          axis("pitch"),
          axis("height"),
          array.numbers,
          array.precision,
          described(lines, "version"),
          described(lines, "geometry_hash")};
}

}  // namespace

std::string npy(const std::vector<double>& numbers, const std::vector<std::size_t>& shape, Precision precision,
                const std::string& remark) {
  std::string bytes = with_header(precision == Precision::kFloat ? "<f4" : "<f8", shape, remark);
  append_numbers(bytes, numbers, precision);
  return bytes;
}

std::string npy(const std::string& characters) {
  std::string bytes = with_header("<U" + text(characters.size()), {}, "");
  for (const char c : characters) {
    append(bytes, std::uint32_t(static_cast<unsigned char>(c)));
  }
  return bytes;
}

Array parse_npy(const std::string& bytes) {
  Reader reader(bytes);
  if (reader.take(kMagic.size()) != kMagic) {
    throw std::runtime_error("it is not an array of numpy");
  }
  const std::string header = reader.take(reader.number<std::uint16_t>());
  const std::string type = between(header, "'descr': '", "'");
  Array array;
  array.precision = type == "<f4" ? Precision::kFloat : Precision::kDouble;
  array.shape = parse_tuple(between(header, "'shape': (", ")"));
  if (header.find(kRemark) != std::string::npos) {
    array.remark = header.substr(header.find(kRemark) + kRemark.size());
    array.remark.erase(array.remark.find_last_not_of(" \n") + 1);
  }
  if (type.rfind("<U", 0) == 0) {
    while (reader.left() > 0) {
      array.characters += char(reader.number<std::uint32_t>());
    }
    return array;
  }
  std::size_t count = 1;
  for (const std::size_t n : array.shape) {
    count *= n;
  }
  array.numbers = reader.numbers(count, array.precision);
  return array;
}

const Format kNpy = {"npy", ".npy", Precision::kDouble, "numpy.load: the extensions, described in a remark",
                     write, read};

}  // namespace ik_tables
