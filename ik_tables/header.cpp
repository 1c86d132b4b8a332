// .h: a C99 header with constant arrays, which a linker puts into flash. It needs no other header; included after
// sms/sms.h it also has the struct that the lookups of libsms take.
#include <algorithm>
#include <cctype>
#include <ostream>

#include "bytes.hpp"
#include "formats.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

std::string capitals(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return name;
}

// A constant of C: with a point or an exponent, so that it is no integer.
std::string constant(double x, Precision precision) {
  std::string digits = text(x, precision);
  if (digits.find_first_of(".e") == std::string::npos) {
    digits += ".0";
  }
  return precision == Precision::kFloat ? digits + "f" : digits;
}

const char* type_of(const Table& table) { return table.precision == Precision::kFloat ? "float" : "double"; }

void write_array(std::ostream& out, const Table& table, const std::string& name, const std::vector<double>& numbers,
                 std::size_t per_line) {
  out << "static const " << type_of(table) << " " << name << "[" << numbers.size() << "] = {";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    out << (i % per_line == 0 ? "\n  " : " ") << constant(numbers[i], table.precision)
        << (i + 1 < numbers.size() ? "," : "");
  }
  out << "\n};\n\n";
}

std::string axis_struct(const std::vector<double>& axis, Precision precision) {
  const double step_count = double(axis.size() - 1);
  const double per_unit = axis.size() == 1 ? 0.0 : step_count / (axis.back() - axis.front());
  std::string fields = text(axis.size());
  for (const double x : {axis.front(), axis.back(), per_unit}) {
    fields += ", " + constant(x, precision);
  }
  return "{" + fields + "}";
}

// The place of a number in the array, in terms of the indices i, k and l of roll, pitch and height.
std::string index(const Table& table) {
  const std::string place = "i * " + text(table.pitch.size()) + " + k";
  return table.height.size() == 1 ? place : "(" + place + ") * " + text(table.height.size()) + " + l";
}

void write_head(std::ostream& out, const Table& table, const std::string& name) {
  const bool one_height = table.height.size() == 1;
  const std::string upper = capitals(name), f = table.precision == Precision::kFloat ? "f" : "";
  out << "/* Extensions of the actuators over roll" << (one_height ? " and pitch" : ", pitch and height")
      << ", for a controller's flash.\n *\n"
      << description(table, " * ") << " *\n * The extension of actuator m (0, 1, 2) at roll[i], pitch[k]"
      << (one_height ? "" : ", height[l]") << " is\n *   " << name << "_extension[(" << index(table)
      << ") * 3 + m]\n * whose index may need 32 bits. Include this file in one source file; after sms/sms.h it also"
      << " defines\n *   const sms_table" << f << " " << name << "\n * for sms_table_" << (one_height ? "bi" : "tri")
      << "linear" << f << "() and sms_table_" << (one_height ? "bi" : "tri") << "cubic" << f << "(). */\n"
      << "#ifndef " << upper << "_H\n#define " << upper << "_H\n\n"
      << "#define " << upper << "_VERSION \"" << table.version << "\"\n"
      << "#define " << upper << "_GEOMETRY_HASH \"" << table.geometry_hash << "\"\n"
      << "#define " << upper << "_UNITS \"" << kUnits << "\"\n"
      << "#define " << upper << "_ROLL_COUNT " << table.roll.size() << "\n"
      << "#define " << upper << "_PITCH_COUNT " << table.pitch.size() << "\n"
      << "#define " << upper << "_HEIGHT_COUNT " << table.height.size() << "\n\n";
}

void write(const Table& table, const std::string& name, std::ostream& out) {
  const char* f = table.precision == Precision::kFloat ? "f" : "";
  write_head(out, table, name);
  write_array(out, table, name + "_roll", table.roll, 10);
  write_array(out, table, name + "_pitch", table.pitch, 10);
  write_array(out, table, name + "_height", table.height, 10);
  write_array(out, table, name + "_extension", table.extension, 3);
  out << "#ifdef SMS_SMS_H\nstatic const sms_table" << f << " " << name << " = {\n"
      << "  " << axis_struct(table.roll, table.precision) << ",\n"
      << "  " << axis_struct(table.pitch, table.precision) << ",\n"
      << "  " << axis_struct(table.height, table.precision) << ",\n"
      << "  " << name << "_extension,\n};\n#endif\n\n#endif\n";
}

std::vector<double> read_array(const std::string& all, const std::string& end_of_name, bool is_float) {
  const std::size_t found = all.find(end_of_name + "[", all.find("static const"));
  const std::size_t open = found == std::string::npos ? found : all.find("= {", found);
  if (open == std::string::npos) {
    throw std::runtime_error("it has no array " + end_of_name);
  }
  std::vector<double> numbers;
  for (const char* at = all.c_str() + open + 3;;) {
    char* after = nullptr;
    const double x = is_float ? double(std::strtof(at, &after)) : std::strtod(at, &after);
    if (after == at) {
      return numbers;
    }
    numbers.push_back(x);
    at = *after == 'f' ? after + 1 : after;
    at = *at == ',' ? at + 1 : at;
  }
}

Table read(std::istream& in) {
  const std::string all = whole(in);
  const bool is_float = all.find("static const float") != std::string::npos;
  const auto array = [&](const char* name) { return read_array(all, name, is_float); };
  return {array("_roll"),
          array("_pitch"),
          array("_height"),
          array("_extension"),
          is_float ? Precision::kFloat : Precision::kDouble,
          described(all, "version"),
          described(all, "geometry_hash")};
}

}  // namespace

const Format kHeader = {
    "header", ".h", Precision::kFloat, "C99: constant arrays for flash, and the struct of sms/table.h", write, read};

}  // namespace ik_tables
