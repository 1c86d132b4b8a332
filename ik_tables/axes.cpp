#include "axes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "text.hpp"

namespace ik_tables {
namespace {

std::vector<double> split(const std::string& option, const std::string& word, char separator) {
  std::vector<double> numbers;
  for (std::size_t start = 0, end = 0; end != std::string::npos; start = end + 1) {
    end = word.find(separator, start);
    numbers.push_back(number(option, word.substr(start, end == std::string::npos ? end : end - start)));
  }
  return numbers;
}

// How many nodes a step makes of a range.
int node_count(const std::string& option, const Range& r, double step) {
  const double width = r.upper - r.lower, steps = width / step, whole = std::round(steps);
  if (steps > double(kMostNodes)) {
    throw BadInput(option + " " + text(step) + ": makes more than " + text(kMostNodes) +
                   " nodes; choose a larger step");
  }
  if (whole < 1.0 || std::abs(steps - whole) > 1e-6) {
    const double fewer = std::max(1.0, std::floor(steps));
    char steps_that_do[64];
    std::snprintf(steps_that_do, sizeof steps_that_do, "%.9g or %.9g", width / fewer, width / (fewer + 1.0));
    throw BadInput(option + " " + text(step) + ": does not divide the range from " + text(r.lower) + " to " +
                   text(r.upper) + "; " + steps_that_do + " would");
  }
  return int(whole) + 1;
}

}  // namespace

double number(const std::string& option, const std::string& word) {
  char* after = nullptr;
  const double value = std::strtod(word.c_str(), &after);
  if (word.empty() || *after != '\0' || !std::isfinite(value)) {
    throw BadInput(option + ": '" + word + "' is not a number");
  }
  return value;
}

std::uint64_t whole_number(const std::string& option, const std::string& word, std::uint64_t least,
                           std::uint64_t most) {
  std::uint64_t value = 0;
  const char* end = word.data() + word.size();
  const auto [after, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || after != end || value < least || value > most) {
    throw BadInput(option + " " + word + ": must be a whole number from " + text(least) + " to " + text(most));
  }
  return value;
}

Range range(const std::string& option, const std::string& word) {
  const std::vector<double> ends = split(option, word, ':');
  if (ends.size() > 2) {
    throw BadInput(option + " " + word + ": write R for -R to R, or A:B");
  }
  const Range result = ends.size() == 1 ? Range{-ends[0], ends[0]} : Range{ends[0], ends[1]};
  if (result.lower >= result.upper) {
    throw BadInput(option + " " + word + ": there is nothing from " + text(result.lower) + " to " + text(result.upper) +
                   "; the second must be larger than the first");
  }
  return result;
}

std::vector<double> angles(const Range& range, double step, double unit, Precision precision) {
  return nodes(range.lower * unit, range.upper * unit, node_count("--step", range, step), precision);
}

std::vector<double> heights(const std::string& option, const std::vector<std::string>& words, Precision precision) {
  if (words.size() == 1 && words[0].find(':') != std::string::npos) {
    const std::vector<double> f = split(option, words[0], ':');
    if (f.size() != 3 || f[0] >= f[1] || f[2] <= 0.0) {
      throw BadInput(option + " " + words[0] + ": write first:last:step, e.g. 0.45:0.55:0.05");
    }
    return nodes(f[0], f[1], node_count(option + " " + words[0] + ": step", {f[0], f[1]}, f[2]), precision);
  }
  std::vector<double> given;
  for (const std::string& word : words) {
    const std::vector<double> some = split(option, word, ',');
    given.insert(given.end(), some.begin(), some.end());
  }
  if (given.size() == 1) {
    return {rounded(given[0], precision)};
  }
  std::vector<double> even = nodes(given.front(), given.back(), int(given.size()), precision);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (std::abs(given[i] - even[i]) > 1e-7 || (i > 0 && even[i] <= even[i - 1])) {
      throw BadInput(option + ": several heights must ascend in equal steps, as the lookup expects; " + text(given[i]) +
                     " m does not");
    }
  }
  return even;
}

}  // namespace ik_tables
