#include "output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <system_error>

#include "grid.hpp"
#include "text.hpp"

namespace ik_tables {

namespace fs = std::filesystem;

OutputFile::OutputFile(const std::string& path)
    : path_(path), temporary_(path + "." + text(std::random_device{}()) + ".part") {
  std::error_code ignored;
  if (fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored)) {
    throw BadInput("--output " + path_ + ": it exists and is not a file that could be replaced");
  }
  errno = 0;
  if (!std::ofstream(temporary_)) {
    throw BadInput("--output " + path_ + ": cannot be written: " + std::strerror(errno));
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::put_in_place() {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) {
    throw BadInput("--output " + path_ + ": cannot be written: " + error.message());
  }
}

}  // namespace ik_tables
