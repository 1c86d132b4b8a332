#include "options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <thread>

#include "arguments.hpp"
#include "axes.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

constexpr const char* kHead =
    R"(ik_tables writes a table of actuator extensions over roll and pitch at a height, for a controller that looks them up
instead of solving the inverse kinematics. It reads the file back, holds it against the solver, and keeps it only if the
error is below --max-error.

usage: ik_tables --height H... --range R --step S -o FILE [options]

  ik_tables --height 0.5 --range 0.1 --step 0.001 -o table.npz
      the table of section 3.5 of the dissertation, 201 x 201 x 3: roll and pitch from -0.1 to 0.1 rad at 0.5 m
  ik_tables --height 0.5 --range 0.1 --step 0.02 --interpolation cubic -o ik_table.h
      11 x 11 x 3 floats for flash, looked up by sms_table_bicubicf() of libsms
  ik_tables --height 0.49:0.51:0.005 --roll-range -5:5 --pitch-range -4:4 --step 0.25 --deg -o table.mat
      five heights: 41 x 33 x 5 x 3, the ranges in degrees, for MATLAB

)";

constexpr const char* kTail = R"(
The table holds extension[roll][pitch][height][actuator] in m, without the index height when there is one height only,
the nodes of its axes in rad and m, the version of libsms and a hash of the geometry. Two runs write the same bytes.
Exit code: 0 written and verified; 1 not written, because an error is above --max-error; 2 not written, bad input.
)";

const std::vector<Option>& options_known() {
  static const std::vector<Option> options = {
      {"--height", "", Takes::kSeveral, "H...",
       "height above ground of the platform's reference point, m: one (0.5), several,\n"
       "evenly spaced (0.45 0.5 0.55), or first:last:step (0.45:0.55:0.05)"},
      {"--range", "", Takes::kOne, "R", "roll and pitch from -R to R, or from A to B as A:B; rad"},
      {"--roll-range", "", Takes::kOne, "R", "the same for roll alone"},
      {"--pitch-range", "", Takes::kOne, "R", "the same for pitch alone"},
      {"--step", "", Takes::kOne, "S", "from node to node of roll and pitch, rad; it must divide the ranges"},
      {"--deg", "", Takes::kNothing, "", "ranges and step are in degrees; the table is in rad nevertheless"},
      {"--output", "-o", Takes::kOne, "FILE", "the file to write; an old one is replaced, but not by a bad one"},
      {"--format", "", Takes::kOne, "F", "npz, npy, mat, csv, header or raw; else by the ending of FILE:"},
      {"--precision", "", Takes::kOne, "P", "float or double; default double, in a C header float"},
      {"--name", "", Takes::kOne, "NAME", "of the table in a C header; default: FILE without its ending"},
      {"--params", "", Takes::kSeveral, "KEY=VALUE...",
       "parameters of the machine that are not at their default, SI units,\ne.g. platform_joint_1_z=-0.855"},
      {"--interpolation", "", Takes::kOne, "I", "linear or cubic: the one whose error decides; default linear"},
      {"--max-error", "", Takes::kOne, "E",
       "largest error allowed at any point, m of extension and height, rad of the angles\n"
       "that come back; default 1e-4: the machine's position sensors resolve 1.1e-4 m"},
      {"--points", "", Takes::kOne, "N", "random points to verify at; default 10000"},
      {"--seed", "", Takes::kOne, "N", "draw the same points again; default: another seed each time, printed"},
      {"--threads", "", Takes::kOne, "N", "that share the work; default: as many as the machine has"},
      {"--json", "", Takes::kNothing, "", "print the result as JSON"},
      {"--quiet", "-q", Takes::kNothing, "", "print nothing but errors and warnings"},
      {"--version", "", Takes::kNothing, "", "print the version of libsms"},
      {"--help", "-h", Takes::kNothing, "", "print this text"},
  };
  return options;
}

void set_param(const std::string& assignment, sms::Params<double>& params) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw BadInput("--params " + assignment + ": write NAME=VALUE, e.g. platform_joint_1_z=-0.855");
  }
  const std::string name = assignment.substr(0, equals);
  std::vector<std::string> names;
  for (int i = 0; i < sms::param_count; ++i) {
    const sms_param_info& info = *sms_param_describe(i);
    names.emplace_back(info.name);
    if (name != info.name) {
      continue;
    }
    const double value = number("--params", assignment.substr(equals + 1));
    if (value < info.lower || value > info.upper) {
      throw BadInput("--params " + assignment + ": must be within " + text(info.lower) + " to " + text(info.upper) +
                     " " + info.unit);
    }
    sms::param(params, i) = value;
    return;
  }
  throw BadInput("--params " + assignment + ": there is no parameter " + name + suggestion(name, names));
}

// The name of a file without folder and ending, made a name in C.
std::string identifier_of(const std::string& path) {
  std::string name = path.substr(path.find_last_of('/') + 1);
  name = name.substr(0, name.find('.', 1));
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 ? "table_" + name : name;
}

double node_count(const Options& options) {
  return double(options.roll.size()) * double(options.pitch.size()) * double(options.height.size());
}

std::string formats_known() {
  std::string lines;
  for (const Format* f : kFormats) {
    std::string line = std::string(31, ' ') + f->ending;
    line.resize(37, ' ');
    lines += line + f->meaning + "\n";
  }
  return lines;
}

const Format& format(const Given& given, const std::string& output) {
  const auto named = given.find("--format");
  const Format* found = named == given.end() ? format_of_file(output) : format_named(named->second[0]);
  if (found != nullptr) {
    return *found;
  }
  if (named != given.end()) {
    throw BadInput("--format " + named->second[0] + ": must be npz, npy, mat, csv, header or raw");
  }
  throw BadInput("--output " + output + ": the ending is none of .npz, .npy, .mat, .csv, .h, .bin; give --format");
}

// What was given for an option that takes one value, or what is usual.
std::string word(const Given& given, const std::string& option, const std::string& usual) {
  const auto found = given.find(option);
  return found == given.end() ? usual : found->second[0];
}

// The first of two words, unless the second was given.
bool is_first(const Given& given, const std::string& option, const std::string& first, const std::string& second) {
  const std::string chosen = word(given, option, first);
  if (chosen != first && chosen != second) {
    throw BadInput(option + " " + chosen + ": must be " + first + " or " + second);
  }
  return chosen == first;
}

std::vector<double> angle_axis(const Given& given, const std::string& own_option, Precision precision) {
  const std::string option = given.count(own_option) != 0 ? own_option : "--range";
  if (given.count(option) == 0) {
    throw BadInput("--range is missing, or " + own_option + ": e.g. --range 0.1 for -0.1 to 0.1 rad");
  }
  if (given.count("--step") == 0) {
    throw BadInput("--step is missing: from node to node of roll and pitch, rad, e.g. --step 0.001");
  }
  const double step = number("--step", word(given, "--step", ""));
  if (step <= 0.0) {
    throw BadInput("--step " + word(given, "--step", "") + ": must be larger than 0, e.g. --step 0.001");
  }
  constexpr double kDegree = 0.017453292519943295;
  const double unit = given.count("--deg") != 0 ? kDegree : 1.0;
  return angles(range(option, word(given, option, "")), step, unit, precision);
}

void set_output(const Given& given, Options& options) {
  options.output = word(given, "--output", "");
  if (options.output.empty()) {
    throw BadInput("--output is missing: the file to write, e.g. -o table.npz");
  }
  options.format = &format(given, options.output);
  options.precision = options.format->usual;
  if (given.count("--precision") != 0) {
    options.precision = is_first(given, "--precision", "double", "float") ? Precision::kDouble : Precision::kFloat;
  }
  options.name = word(given, "--name", identifier_of(options.output));
  if (options.name != identifier_of(options.name)) {
    throw BadInput("--name " + options.name + ": is not a name in C");
  }
}

void set_axes(const Given& given, Options& options) {
  if (given.count("--height") == 0) {
    throw BadInput("--height is missing: height of the platform above ground, m, e.g. --height 0.5");
  }
  options.height = heights("--height", given.at("--height"), options.precision);
  options.roll = angle_axis(given, "--roll-range", options.precision);
  options.pitch = angle_axis(given, "--pitch-range", options.precision);
  for (const std::vector<double>* axis : {&options.roll, &options.pitch, &options.height}) {
    if (std::adjacent_find(axis->begin(), axis->end(), std::greater_equal<>()) != axis->end()) {
      throw BadInput("the nodes are too close to each other for --precision float");
    }
  }
  if (node_count(options) > double(kMostNodes)) {
    throw BadInput(text(options.roll.size()) + " x " + text(options.pitch.size()) + " x " +
                   text(options.height.size()) + " nodes are more than " + text(kMostNodes) + "; choose a larger step");
  }
}

void set_verification(const Given& given, Options& options) {
  options.cubic = !is_first(given, "--interpolation", "linear", "cubic");
  const std::size_t heights = options.height.size(), angles = std::min(options.roll.size(), options.pitch.size());
  if (options.cubic && (angles < 4 || (heights > 1 && heights < 4))) {
    throw BadInput("--interpolation cubic: needs four nodes on every axis, or a single height; choose a smaller step");
  }
  options.max_error = number("--max-error", word(given, "--max-error", "1e-4"));
  if (options.max_error <= 0.0) {
    throw BadInput("--max-error " + word(given, "--max-error", "") + ": must be larger than 0");
  }
  options.points = int(whole_number("--points", word(given, "--points", "10000"), 1, 100'000'000));
  options.seed = std::random_device{}();
  if (given.count("--seed") != 0) {
    options.seed = whole_number("--seed", word(given, "--seed", ""), 0, UINT64_MAX);
  }
}

}  // namespace

std::string help() {
  std::string options = help_of(options_known());
  const std::string heading = "by the ending of FILE:\n";
  options.insert(options.find(heading) + heading.size(), formats_known());
  return kHead + options + kTail;
}

std::optional<Options> parse(const std::vector<std::string>& arguments) {
  Given given = take_apart(arguments, options_known());
  if (arguments.empty() || given.count("--help") != 0) {
    std::fputs(help().c_str(), stdout);
    return std::nullopt;
  }
  if (given.count("--version") != 0) {
    std::printf("ik_tables, %s\n", sms_build_info());
    return std::nullopt;
  }
  Options options;
  set_output(given, options);
  set_axes(given, options);
  set_verification(given, options);
  for (const std::string& assignment : given["--params"]) {
    set_param(assignment, options.params);
  }
  constexpr double kWorthAThread = 5000.0;
  const unsigned useful = node_count(options) < kWorthAThread ? 1 : std::max(1U, std::thread::hardware_concurrency());
  options.threads = unsigned(whole_number("--threads", word(given, "--threads", text(useful)), 1, 256));
  options.json = given.count("--json") != 0;
  options.quiet = given.count("--quiet") != 0;
  return options;
}

}  // namespace ik_tables
