// .mat version 5 (MathWorks, MAT-File Format, "Level 5"), not compressed: a header of 128 bytes, then one matrix after
// the other, each a tag and within it flags, dimensions, name and numbers as tagged elements, padded to 8 bytes. The
// numbers of a matrix run with the first index fastest.
#include <ostream>

#include "bytes.hpp"
#include "formats.hpp"

namespace ik_tables {
namespace {

enum Type : std::uint32_t { kInt8 = 1, kUint16 = 4, kInt32 = 5, kUint32 = 6, kSingle = 7, kDouble = 9, kMatrix = 14 };
enum Class : std::uint32_t { kCharClass = 4, kDoubleClass = 6, kSingleClass = 7 };
constexpr std::size_t kHeaderSize = 128, kTextSize = 116;

void append_element(std::string& bytes, Type type, const std::string& content) {
  append(bytes, type);
  append(bytes, std::uint32_t(content.size()));
  bytes += content;
  bytes.append((8 - content.size() % 8) % 8, '\0');
}

std::string matrix(const std::string& name, Class kind, const std::vector<std::size_t>& shape, Type type,
                   const std::string& content) {
  std::string flags, dimensions, inside;
  append(flags, kind);
  append(flags, std::uint32_t(0));
  for (const std::size_t n : shape) {
    append(dimensions, std::int32_t(n));
  }
  append_element(inside, kUint32, flags);
  append_element(inside, kInt32, dimensions);
  append_element(inside, kInt8, name);
  append_element(inside, type, content);
  std::string bytes;
  append_element(bytes, kMatrix, inside);
  return bytes;
}

std::string matrix(const std::string& name, const std::vector<std::size_t>& shape, const std::vector<double>& numbers,
                   Precision precision) {
  std::string content;
  append_numbers(content, numbers, precision);
  return precision == Precision::kFloat ? matrix(name, kSingleClass, shape, kSingle, content)
                                        : matrix(name, kDoubleClass, shape, kDouble, content);
}

std::string matrix(const std::string& name, const std::string& characters) {
  std::string content;
  for (const char c : characters) {
    append(content, std::uint16_t(static_cast<unsigned char>(c)));
  }
  return matrix(name, kCharClass, {1, characters.size()}, kUint16, content);
}

// For every place in the order of a .mat file the place in the order of a table: the last index fastest.
template <typename Use>
void in_column_order(const Table& t, const Use& use) {
  std::size_t column = 0;
  for (std::size_t actuator = 0; actuator < 3; ++actuator) {
    for (std::size_t l = 0; l < t.height.size(); ++l) {
      for (std::size_t k = 0; k < t.pitch.size(); ++k) {
        for (std::size_t i = 0; i < t.roll.size(); ++i, ++column) {
          use(column, ((i * t.pitch.size() + k) * t.height.size() + l) * 3 + actuator);
        }
      }
    }
  }
}

void write(const Table& table, const std::string& /*name*/, std::ostream& out) {
  std::string header = "MATLAB 5.0 MAT-file, made by ik_tables of libsms " + table.version;
  header.resize(kTextSize, ' ');
  header.resize(kHeaderSize - 4, '\0');
  append(header, std::uint16_t(0x0100));  // the format's version
  header += "IM";                         // little-endian
  std::vector<double> columns(table.extension.size());
  in_column_order(table, [&](std::size_t to, std::size_t from) { columns[to] = table.extension[from]; });
  out << header << matrix("extension", shape(table), columns, table.precision)
      << matrix("roll", {1, table.roll.size()}, table.roll, table.precision)
      << matrix("pitch", {1, table.pitch.size()}, table.pitch, table.precision)
      << matrix("height", {1, table.height.size()}, table.height, table.precision) << matrix("version", table.version)
      << matrix("geometry_hash", table.geometry_hash) << matrix("units", kUnits);
}

struct Element {
  std::uint32_t type;
  std::string content;
};

Element next_element(Reader& reader) {
  Element element;
  element.type = reader.number<std::uint32_t>();
  const auto size = reader.number<std::uint32_t>();
  element.content = reader.take(size);
  reader.take((8 - size % 8) % 8);
  return element;
}

Table read(std::istream& in) {
  const std::string bytes = whole(in);
  Table table;
  std::vector<double> columns;
  for (Reader file(bytes, kHeaderSize); file.left() > 0;) {
    const Element element = next_element(file);
    Reader inside(element.content);
    next_element(inside);  // flags
    next_element(inside);  // dimensions
    const std::string name = next_element(inside).content;
    const Element data = next_element(inside);
    Reader reader(data.content);
    if (data.type == kUint16) {
      std::string& characters = name == "version" ? table.version : table.geometry_hash;
      while (name != "units" && reader.left() > 0) {
        characters += char(reader.number<std::uint16_t>());
      }
      continue;
    }
    const Precision precision = data.type == kSingle ? Precision::kFloat : Precision::kDouble;
    std::vector<double> numbers = reader.numbers(data.content.size() / size_of(precision), precision);
    if (name == "extension") {
      table.precision = precision;
      columns = numbers;
    }
    if (name == "roll") table.roll = numbers;
    if (name == "pitch") table.pitch = numbers;
    if (name == "height") table.height = numbers;
  }
  if (columns.size() != 3 * table.roll.size() * table.pitch.size() * table.height.size()) {
    throw std::runtime_error("its axes do not fit its extensions");
  }
  table.extension.resize(columns.size());
  in_column_order(table, [&](std::size_t from, std::size_t to) { table.extension[to] = columns[from]; });
  return table;
}

}  // namespace

const Format kMat = {
    "mat", ".mat", Precision::kDouble, "MATLAB, version 5: extension, roll, pitch, height, version, ...", write, read};

}  // namespace ik_tables
