#include "arguments.hpp"

#include <algorithm>
#include <numeric>

#include "grid.hpp"

namespace ik_tables {
namespace {

// Letters to insert, delete or replace to turn one word into the other (Levenshtein).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[k - 1] ? 0 : 1);
      diagonal = row[k];
      row[k] = std::min({replaced, row[k] + 1, row[k - 1] + 1});
    }
  }
  return row.back();
}

const Option& find(const std::string& name, const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& option : options) {
    if (name == option.name || name == option.letter) {
      return option;
    }
    names.emplace_back(option.name);
  }
  throw BadInput("there is no option " + name + suggestion(name, names) + "; ik_tables --help lists them");
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && (word[1] == '-' || (word[1] >= 'a' && word[1] <= 'z'));
}

}  // namespace

std::string suggestion(const std::string& wrong, const std::vector<std::string>& words) {
  const auto nearer = [&](const std::string& a, const std::string& b) {
    return distance(wrong, a) < distance(wrong, b);
  };
  const auto best = std::min_element(words.begin(), words.end(), nearer);
  return best != words.end() && distance(wrong, *best) <= 1 + wrong.size() / 4 ? ", did you mean " + *best + "?" : "";
}

Given take_apart(const std::vector<std::string>& arguments, const std::vector<Option>& options) {
  Given given;
  for (std::size_t i = 0; i < arguments.size();) {
    const std::string& word = arguments[i++];
    if (!is_option(word)) {
      throw BadInput("'" + word + "' does not belong to an option; ik_tables --help lists them");
    }
    const std::size_t equals = word.rfind("--", 0) == 0 ? word.find('=') : std::string::npos;
    const Option& option = find(word.substr(0, equals), options);
    std::vector<std::string>& values = given[option.name];
    const std::size_t before = values.size();
    if (equals != std::string::npos) {
      values.push_back(word.substr(equals + 1));
    }
    const std::size_t most = option.takes == Takes::kOne ? before + 1 : std::string::npos;
    while (option.takes != Takes::kNothing && values.size() < most && i < arguments.size() &&
           !is_option(arguments[i]) && !(equals != std::string::npos)) {
      values.push_back(arguments[i++]);
    }
    if (option.takes == Takes::kNothing && values.size() > before) {
      throw BadInput(std::string(option.name) + " takes no value");
    }
    if (option.takes != Takes::kNothing && values.size() == before) {
      throw BadInput(std::string(option.name) + " needs a value: " + option.name + " " + option.value);
    }
    if (option.takes == Takes::kOne && values.size() > 1) {
      throw BadInput(std::string(option.name) + " is given twice");
    }
  }
  return given;
}

std::string help_of(const std::vector<Option>& options) {
  constexpr std::size_t kIndent = 29;
  std::string text;
  for (const Option& option : options) {
    const std::string letter = *option.letter == '\0' ? "" : std::string(option.letter) + ", ";
    std::string line = "  " + letter + option.name + " " + option.value;
    line.resize(std::max(line.size() + 1, kIndent), ' ');
    for (const char* c = option.help; *c != '\0'; ++c) {
      line += *c;
      if (*c == '\n') {
        line += std::string(kIndent, ' ');
      }
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace ik_tables
