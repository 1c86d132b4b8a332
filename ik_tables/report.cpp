#include "report.hpp"

#include <algorithm>
#include <cstdio>

#include "text.hpp"

namespace ik_tables {
namespace {

std::string name_of(const Options& options, bool cubic) {
  return std::string(options.height.size() == 1 ? "bi" : "tri") + (cubic ? "cubic" : "linear");
}

const char* precision_of(const Options& options) { return options.precision == Precision::kFloat ? "float" : "double"; }

std::string product(const std::vector<std::size_t>& factors) {
  std::string all;
  for (const std::size_t n : factors) {
    all += (all.empty() ? "" : " x ") + text(n);
  }
  return all;
}

std::string row(const std::string& what, const Spread& error, const char* unit) {
  char line[96];
  std::snprintf(line, sizeof line, "  %-40s %9.1e %9.1e  %s\n", what.c_str(), error.largest, error.rms(), unit);
  return line;
}

std::string rows(const std::string& name, const Interpolation& errors) {
  if (!errors.possible) {
    return "  " + name + ": needs four nodes on every axis\n";
  }
  std::string all = row(name + ", extension", errors.extension, "m") +
                    row("  by forward kinematics back to roll", errors.roll, "rad") +
                    row("  to pitch", errors.pitch, "rad") + row("  to height", errors.height, "m");
  if (errors.lost > 0) {
    all += "  " + text(errors.lost) + " points have extensions that no pose fits\n";
  }
  return all;
}

std::string quoted(const std::string& characters) {
  std::string all = "\"";
  for (const char c : characters) {
    if (c == '"' || c == '\\') {
      all += '\\';
    }
    if (static_cast<unsigned char>(c) < ' ') {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      all += code;
    } else {
      all += c;
    }
  }
  return all + "\"";
}

std::string spread(const Spread& error) {
  return "{\"largest\": " + text(error.largest) + ", \"rms\": " + text(error.rms()) + "}";
}

std::string object(const Interpolation& errors) {
  if (!errors.possible) {
    return "null";
  }
  return "{\"extension_m\": " + spread(errors.extension) + ", \"roll_rad\": " + spread(errors.roll) +
         ", \"pitch_rad\": " + spread(errors.pitch) + ", \"height_m\": " + spread(errors.height) +
         ", \"lost\": " + text(errors.lost) + "}";
}

}  // namespace

const Interpolation& chosen(const Options& options, const Report& report) {
  return options.cubic ? report.errors.cubic : report.errors.linear;
}

double chosen_error(const Options& options, const Report& report) {
  return std::max(chosen(options, report).largest(), report.errors.nodes.largest);
}

std::string chosen_name(const Options& options) { return name_of(options, options.cubic); }

std::string as_text(const Options& options, const Report& report) {
  char line[256];
  std::string all = options.output + ": " + product(report.shape) + " " + precision_of(options) + ", " +
                    text(long(report.bytes)) + " bytes, geometry " + report.geometry_hash + "\n";
  std::snprintf(line, sizeof line,
                "solved in %.3g ms on %u thread%s; extensions from %.4f to %.4f m, stroke 0 to %g m\n",
                1e3 * report.solving, options.threads, options.threads == 1 ? "" : "s", report.use.least,
                report.use.most, report.stroke);
  all += line;
  all += "read back and verified at " + text(options.points) + " random points, --seed " + text(options.seed) + "\n\n";
  std::snprintf(line, sizeof line, "  %-40s %9s %9s\n", "error", "largest", "rms");
  all += line;
  return all + row("nodes against the solver, extension", report.errors.nodes, "m") +
         rows(name_of(options, false), report.errors.linear) + rows(name_of(options, true), report.errors.cubic);
}

std::string as_json(const Options& options, const Report& report) {
  std::string shape;
  for (const std::size_t n : report.shape) {
    shape += (shape.empty() ? "" : ", ") + text(n);
  }
  return "{\"schema\": \"sms.table\", \"schema_version\": 1,\n \"file\": " + quoted(options.output) +
         ", \"format\": " + quoted(options.format->name) + ", \"precision\": " + quoted(precision_of(options)) +
         ", \"shape\": [" + shape + "], \"bytes\": " + text(long(report.bytes)) +
         ",\n \"version\": " + quoted(report.version) + ", \"geometry_hash\": " + quoted(report.geometry_hash) +
         ", \"solving_s\": " + text(report.solving) + ", \"threads\": " + text(options.threads) +
         ",\n \"stroke_m\": " + text(report.stroke) + ", \"least_extension_m\": " + text(report.use.least) +
         ", \"most_extension_m\": " + text(report.use.most) + ", \"nodes_beyond_stroke\": " + text(report.use.beyond) +
         ",\n \"points\": " + text(options.points) + ", \"seed\": " + text(options.seed) +
         ", \"interpolation\": " + quoted(options.cubic ? "cubic" : "linear") +
         ", \"error\": " + text(chosen_error(options, report)) + ", \"max_error\": " + text(options.max_error) +
         ",\n \"nodes_m\": " + spread(report.errors.nodes) + ",\n \"linear\": " + object(report.errors.linear) +
         ",\n \"cubic\": " + object(report.errors.cubic) + "}\n";
}

}  // namespace ik_tables
