// The variables of an exported model, once: fmi2.cpp and fmi3.cpp read and write them by their place in this list, which
// is their value reference, and `sms export fmu` writes modelDescription.xml from it.
//
// Parameters are rows of params.def with their units, bounds and defaults; outputs are the columns of a simulated run.
#pragma once

#include <string>
#include <vector>

namespace sms_fmi {

enum class Kind : int { bench, platform, tank, controller };
constexpr int kind_count() { return 4; }

enum class Type : int { real, enumeration, boolean };

enum class Causality : int { independent, parameter, input, output, local };

struct Variable {
  std::string name;
  std::string unit;  // SI, as pint reads it; "1" where there is none
  std::string doc;
  Type type;
  Causality causality;
  bool sampled;  // changes at multiples of the control period alone
  double start, lower, upper;
  std::string choices;  // of an enumeration, from 1 on: "pid state_feedback"
};

using Values = std::vector<double>;

// "bench", ...
const char* kind_name(Kind kind);

const std::vector<Variable>& variables_of(Kind kind);

// Place of a variable; -1: there is none.
int place_of(Kind kind, const std::string& name);

// What a column of a run is called here: supply_pressure is the parameter, and reservoir_pressure what is left of it at the
// valve.
std::string name_of_column(const std::string& column);

// What modelDescription.xml must carry for this binary: kind, version and a sum over all names and units.
const std::string& token_of(Kind kind);

}  // namespace sms_fmi
