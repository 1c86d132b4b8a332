// Parameters and choices of a model, out of the values of its variables.
#pragma once

#include <string>

#include "sms/params.hpp"
#include "variables.hpp"

namespace sms_fmi {

class Reader {
 public:
  Reader(Kind kind, const Values& values) : kind_(kind), values_(values) {}

  double number(const std::string& name) const {
    const int place = place_of(kind_, name);
    return place < 0 ? 0.0 : values_[std::size_t(place)];
  }
  // From 0 on, as the enumerations of the core count.
  int choice(const std::string& name) const { return place_of(kind_, name) < 0 ? 0 : int(number(name)) - 1; }
  bool option(const std::string& name) const { return number(name) > 0.5; }

  // Those that the model does not read keep their defaults.
  sms::Params<double> params() const {
    sms::Params<double> p;
    for (int i = 0; i < sms_param_count(); ++i) {
      const int place = place_of(kind_, sms_param_describe(i)->name);
      if (place >= 0) {
        sms::param(p, i) = values_[std::size_t(place)];
      }
    }
    return p;
  }
  // Of one actuator of a platform, 1 to 3: what all have, and what it has more.
  sms::Params<double> params(int leg) const {
    sms::Params<double> p = params();
    for (int i = 0; i < sms_param_count(); ++i) {
      const int place = place_of(kind_, "actuator_" + std::to_string(leg) + "." + sms_param_describe(i)->name);
      if (place >= 0) {
        sms::param(p, i) += values_[std::size_t(place)];
      }
    }
    return p;
  }

 private:
  Kind kind_;
  const Values& values_;
};

}  // namespace sms_fmi
