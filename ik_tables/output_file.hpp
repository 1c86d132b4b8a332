// A file that is there whole or not at all: written under a temporary name beside its own, and renamed at the end.
#pragma once

#include <string>

namespace ik_tables {

class OutputFile {
 public:
  // Throws BadInput when the file could not be written.
  explicit OutputFile(const std::string& path);
  ~OutputFile();  // removes what was not put in place
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  void put_in_place();

 private:
  std::string path_, temporary_;
};

}  // namespace ik_tables
