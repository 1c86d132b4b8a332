// The laws that Python chooses by their name.
#pragma once

#include "choice.hpp"
#include "sms/force_balance.hpp"

namespace sms_python {

inline sms::FrictionLaw friction_law(const std::string& name, const char* what = "law") {
  using sms::FrictionLaw;
  return choice<FrictionLaw>(what, name,
                             {{"acceleration_dependent", FrictionLaw::acceleration_dependent},
                              {"two_branch", FrictionLaw::two_branch},
                              {"stribeck", FrictionLaw::stribeck},
                              {"dahl", FrictionLaw::dahl},
                              {"lugre", FrictionLaw::lugre}});
}

}  // namespace sms_python
