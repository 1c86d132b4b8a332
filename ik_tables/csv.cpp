// .csv: what every table carries as lines of remarks, the names of the columns with their units, a line a node.
#include <algorithm>
#include <istream>
#include <ostream>

#include "formats.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

constexpr const char* kColumns = "roll [rad],pitch [rad],height [m],extension_1 [m],extension_2 [m],extension_3 [m]";

void write(const Table& table, const std::string& /*name*/, std::ostream& out) {
  const char* precision = table.precision == Precision::kFloat ? "float" : "double";
  out << description(table, "# ") << "# precision: " << precision << "\n" << kColumns << "\n";
  const double* node = table.extension.data();
  for (const double roll : table.roll) {
    for (const double pitch : table.pitch) {
      for (const double height : table.height) {
        std::string line = text(roll, table.precision);
        for (const double x : {pitch, height, node[0], node[1], node[2]}) {
          line += "," + text(x, table.precision);
        }
        out << line << "\n";
        node += 3;
      }
    }
  }
}

// Rows run with the height fastest, then pitch, then roll: a node that is not there yet is the next of its axis.
void add_node(std::vector<double>& axis, double value) {
  if (axis.empty() || value > axis.back()) {
    axis.push_back(value);
  }
}

Table read(std::istream& in) {
  std::string remarks, line;
  while (std::getline(in, line) && line.rfind("# ", 0) == 0) {
    remarks += line + "\n";
  }
  if (line != kColumns) {
    throw std::runtime_error("it has other columns");
  }
  const bool is_float = described(remarks, "precision") == "float";
  Table table = {{},
                 {},
                 {},
                 {},
                 is_float ? Precision::kFloat : Precision::kDouble,
                 described(remarks, "version"),
                 described(remarks, "geometry_hash")};
  while (std::getline(in, line)) {
    double row[6];
    const char* at = line.c_str();
    for (double& x : row) {
      char* after = nullptr;
      x = is_float ? double(std::strtof(at, &after)) : std::strtod(at, &after);
      if (after == at) {
        throw std::runtime_error("this line of it is no node: " + line);
      }
      at = *after == ',' ? after + 1 : after;
    }
    add_node(table.roll, row[0]);
    add_node(table.pitch, row[1]);
    add_node(table.height, row[2]);
    table.extension.insert(table.extension.end(), row + 3, row + 6);
  }
  return table;
}

}  // namespace

const Format kCsv = {"csv", ".csv", Precision::kDouble, "a line a node, the units in the names of the columns",
                     write, read};

}  // namespace ik_tables
