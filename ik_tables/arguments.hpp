// A command line taken apart by a list of options; the same list makes the help. It stands in for a library because it
// is short, takes several values after one option (--height 0.45 0.5 0.55), takes -0.1:0.1 as a value, and words its
// refusals as one sentence.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ik_tables {

enum class Takes { kNothing, kOne, kSeveral };

struct Option {
  const char* name;    // "--height"
  const char* letter;  // "-o", or ""
  Takes takes;
  const char* value;  // as the help calls it: "H..."
  const char* help;   // lines
};

// Values by name of option; repeated options collect. Throws BadInput for anything that is not in the list.
using Given = std::map<std::string, std::vector<std::string>>;
Given take_apart(const std::vector<std::string>& arguments, const std::vector<Option>& options);

std::string help_of(const std::vector<Option>& options);

// ", did you mean --height?", when one of the words is close enough to be meant; else nothing.
std::string suggestion(const std::string& wrong, const std::vector<std::string>& words);

}  // namespace ik_tables
