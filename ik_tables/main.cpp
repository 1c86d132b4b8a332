// ik_tables: solves a table of extensions, writes it, reads it back, verifies what it read, and only then puts the file
// in place.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>

#include "geometry_hash.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

enum ExitCode { kWritten = 0, kNotAccurate = 1, kBadInput = 2 };

Table solved(const Options& options, const sms::Geometry<double>& geometry, Progress& progress, Report& report) {
  Table table = {
      options.roll, options.pitch, options.height, {}, options.precision, sms_version(), geometry_hash(options.params)};
  progress.begin("solving");
  const auto start = std::chrono::steady_clock::now();
  solve(geometry, options.threads, progress, table);
  report.solving = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.stroke = geometry.stroke;
  report.use = stroke_use(table, geometry.stroke);
  if (report.use.beyond == report.use.of_nodes) {
    throw BadInput("out of reach: every node needs an extension beyond the stroke of 0 to " + text(geometry.stroke) +
                   " m (they run from " + text(float(report.use.least)) + " to " + text(float(report.use.most)) +
                   " m); choose another height or smaller ranges");
  }
  return table;
}

// Writes the table, and gives what stands in the file.
Table written(const Options& options, const Table& table, const std::string& file, Progress& progress) {
  progress.begin("writing");
  std::ofstream out(file, std::ios::binary);
  options.format->write(table, options.name, out);
  out.close();
  if (!out) {
    throw BadInput("--output " + options.output + ": could not be written to its end; is the disk full?");
  }
  progress.begin("reading back");
  std::ifstream in(file, std::ios::binary);
  return options.format->read(in);
}

bool same(const Table& a, const Table& b) {
  return a.roll == b.roll && a.pitch == b.pitch && a.height == b.height && a.extension == b.extension &&
         a.precision == b.precision && a.version == b.version && a.geometry_hash == b.geometry_hash;
}

Report make(const Options& options, const std::string& file) {
  const sms::Geometry<double> geometry = sms::make_geometry(options.params);
  Progress progress(options.quiet);
  Report report;
  Table table = solved(options, geometry, progress, report);
  const Table back = written(options, table, file, progress);
  if (!same(table, back)) {
    throw std::runtime_error("it does not read back as it was written");
  }
  report.shape = shape(back);
  report.version = back.version;
  report.geometry_hash = back.geometry_hash;
  report.bytes = double(std::filesystem::file_size(file));
  progress.begin("verifying");
  report.errors = verify(back, geometry, options.points, options.seed, progress);
  return report;
}

ExitCode run(const Options& options) {
  OutputFile file(options.output);
  const Report report = make(options, file.temporary());
  if (!options.quiet) {
    std::fputs((options.json ? as_json(options, report) : as_text(options, report)).c_str(), stdout);
    std::fflush(stdout);
  }
  if (report.use.beyond > 0) {
    std::fprintf(stderr, "ik_tables: warning: %ld of %ld nodes need an extension beyond the stroke\n",
                 report.use.beyond, report.use.of_nodes);
  }
  const double error = chosen_error(options, report);
  if (chosen(options, report).lost > 0 || !(error <= options.max_error)) {
    std::fprintf(
        stderr,
        "ik_tables: %s is not written: its %s error of %.2g is above --max-error %g; choose a smaller --step%s\n",
        options.output.c_str(), chosen_name(options).c_str(), error, options.max_error,
        options.cubic ? "" : ", or --interpolation cubic");
    return kNotAccurate;
  }
  file.put_in_place();
  return kWritten;
}

// A word of the command line may hold a line's end; what is said of it is one line.
std::string in_one_line(std::string text) {
  for (char& c : text) {
    c = static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  }
  return text;
}

int main_of(const std::vector<std::string>& arguments) {
  try {
    const std::optional<Options> options = parse(arguments);
    return options ? run(*options) : kWritten;
  } catch (const BadInput& mistake) {
    std::fprintf(stderr, "ik_tables: %s\n", in_one_line(mistake.what()).c_str());
  } catch (const std::bad_alloc&) {
    std::fputs("ik_tables: the table does not fit into memory; choose a larger --step\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ik_tables: the file could not be verified: %s\n", error.what());
    return kNotAccurate;
  }
  return kBadInput;
}

}  // namespace
}  // namespace ik_tables

int main(int count, char** arguments) { return ik_tables::main_of({arguments + 1, arguments + count}); }
