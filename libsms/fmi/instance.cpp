#include "instance.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace sms_fmi {
namespace {

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.10g", value);
  return out;
}

std::string with_unit(double value, const Variable& v) { return text(value) + (v.unit == "1" ? "" : " " + v.unit); }

Values published(Kind kind) {
  Values values;
  for (const Variable& v : variables_of(kind)) {
    values.push_back(v.start);
  }
  return values;
}

const char* named(Type type) {
  constexpr const char* names[] = {"a real number", "an enumeration", "a boolean"};
  return names[int(type)];
}

}  // namespace

Instance::Instance(Kind kind, const Values& start, const std::string& name, Log log)
    : kind_(kind), name_(name), log_(std::move(log)), model_(make_model(kind)), start_values_(start), values_(start) {}

bool Instance::refuse(const std::string& sentence) const {
  log_(sentence);
  return false;
}

bool Instance::fail(const std::string& what, sms_status status) {
  phase_ = Phase::failed;
  return refuse(what + ": " + model_->why(status));
}

// ---- initialization ----

bool Instance::plan_start(double start) {
  if (phase_ != Phase::instantiated) {
    return refuse("the start time is set before initialization");
  }
  if (!std::isfinite(start)) {
    return refuse("the start time is not a finite number");
  }
  start_ = time_ = start;
  return true;
}

bool Instance::enter_initialization() {
  if (phase_ != Phase::instantiated) {
    return refuse("initialization begins once, right after the instance was made or reset");
  }
  phase_ = Phase::initialization;
  begun_ = false;
  return true;
}

bool Instance::parameters_are_allowed() const {
  const std::vector<Variable>& all = variables_of(kind_);
  const int of_actuators = int(all.size());
  for (int i = 0; i < of_actuators; ++i) {
    const Variable& v = all[std::size_t(i)];
    const double value = values_[std::size_t(i)];
    const bool inside = value >= v.lower && value <= v.upper;  // NaN is not
    if (v.causality == Causality::parameter && !inside) {
      return refuse("the parameter " + v.name + " is " + with_unit(value, v) + "; allowed are " + text(v.lower) +
                    " to " + with_unit(v.upper, v));
    }
    const std::size_t dot = v.name.find('.');
    const int common = dot == std::string::npos ? -1 : place_of(kind_, v.name.substr(dot + 1));
    if (common >= 0) {
      const Variable& of_all = all[std::size_t(common)];
      const double sum = values_[std::size_t(common)] + value;
      if (!(sum >= of_all.lower && sum <= of_all.upper)) {
        return refuse("with " + v.name + " the parameter " + of_all.name + " of that actuator is " +
                      with_unit(sum, of_all) + "; allowed are " + text(of_all.lower) + " to " +
                      with_unit(of_all.upper, of_all));
      }
    }
  }
  const int bore = place_of(kind_, "bore_diameter"), rod = place_of(kind_, "rod_diameter");
  if (bore >= 0 && !(values_[std::size_t(rod)] < values_[std::size_t(bore)])) {
    return refuse("the parameter rod_diameter is " + text(values_[std::size_t(rod)]) +
                  " m, which does not go into a bore_diameter of " + text(values_[std::size_t(bore)]) + " m");
  }
  const int stroke = place_of(kind_, "stroke"), start = place_of(kind_, "start_extension");
  if (start >= 0 && values_[std::size_t(start)] > values_[std::size_t(stroke)]) {
    return refuse("the parameter start_extension is " + text(values_[std::size_t(start)]) +
                  " m; allowed are 0 to the stroke, " + text(values_[std::size_t(stroke)]) + " m");
  }
  return true;
}

bool Instance::inputs_are_numbers() const {
  const std::vector<Variable>& all = variables_of(kind_);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].causality == Causality::input && !std::isfinite(values_[i])) {
      return refuse("the input " + all[i].name + " is " + text(values_[i]) + ", which is not a finite number");
    }
  }
  return true;
}

// Outputs are asked for during initialization, too: the model begins as often as the values change.
bool Instance::begin() {
  if (begun_) {
    return true;
  }
  if (!parameters_are_allowed() || !inputs_are_numbers()) {
    return false;
  }
  sms_status status = model_->begin(values_);
  status = status == SMS_OK ? model_->write_outputs(values_) : status;
  if (status != SMS_OK) {
    return refuse("the model cannot begin: " + model_->why(status));
  }
  begun_ = true;
  return true;
}

bool Instance::exit_initialization() {
  if (phase_ != Phase::initialization) {
    return refuse("initialization ends where it has begun");
  }
  if (!begin()) {
    return false;
  }
  phase_ = Phase::stepping;
  return true;
}

// ---- running ----

bool Instance::step(double from, double size) {
  if (phase_ != Phase::stepping) {
    return refuse("a step can be done after initialization, and not after an error or the end");
  }
  if (!(std::isfinite(size) && size > 0.0)) {
    return refuse("a communication step of " + text(size) + " s is not possible; its size is a number above 0");
  }
  if (!(std::abs(from - time_) <= 1e-9 * (1.0 + std::abs(time_)))) {
    return refuse("a step from " + text(from) + " s is not possible; the instance is at " + text(time_) + " s");
  }
  if (!inputs_are_numbers()) {
    return false;
  }
  const double end = from + size;
  sms_status status = model_->advance(values_, end - start_);
  status = status == SMS_OK ? model_->write_outputs(values_) : status;
  if (status != SMS_OK) {
    return fail("the step from " + text(from) + " s to " + text(end) + " s cannot be done", status);
  }
  time_ = end;
  return true;
}

bool Instance::terminate() {
  if (phase_ != Phase::stepping && phase_ != Phase::initialization) {
    return refuse("only a run that goes on can be ended");
  }
  phase_ = Phase::terminated;
  return true;
}

void Instance::reset() {
  values_ = start_values_;
  phase_ = Phase::instantiated;
  begun_ = false;
  start_ = time_ = 0.0;
}

// ---- values ----

bool Instance::get(unsigned place, Type type, double& value) {
  const std::vector<Variable>& all = variables_of(kind_);
  if (place >= all.size() || all[place].type != type) {
    return refuse("value reference " + std::to_string(place) + " is not that of " + named(type));
  }
  const Causality causality = all[place].causality;
  if (causality == Causality::independent) {
    value = time_;
    return true;
  }
  const bool follows = causality == Causality::output || causality == Causality::local;
  if (follows && phase_ == Phase::initialization && !begin()) {
    return false;
  }
  value = values_[place];
  return true;
}

bool Instance::set(unsigned place, Type type, double value) {
  const std::vector<Variable>& all = variables_of(kind_);
  if (place >= all.size() || all[place].type != type) {
    return refuse("value reference " + std::to_string(place) + " is not that of " + named(type));
  }
  const Variable& v = all[place];
  if (v.causality != Causality::parameter && v.causality != Causality::input) {
    return refuse(v.name + " is neither a parameter nor an input, and cannot be set");
  }
  const bool before = phase_ == Phase::instantiated || phase_ == Phase::initialization;
  if (!before && v.causality == Causality::parameter) {
    return refuse("the parameter " + v.name + " is fixed; it can be set before initialization ends");
  }
  values_[place] = value;
  begun_ = begun_ && !before;
  return true;
}

// ---- states ----

Snapshot Instance::snapshot() const {
  return {kind_, phase_, start_, time_, values_, begun_ ? model_->moment() : std::string()};
}

bool Instance::go_to(const Snapshot& snapshot) {
  if (snapshot.kind != kind_) {
    return refuse("this is the state of another model");
  }
  const Values before = values_;
  values_ = snapshot.values;
  begun_ = false;
  const std::string& moment = snapshot.moment;
  if (!moment.empty() && (model_->begin(values_) != SMS_OK || !model_->go_to(moment))) {
    values_ = before;
    phase_ = Phase::failed;
    return refuse("this is no state of this model");
  }
  begun_ = !moment.empty();
  phase_ = snapshot.phase;
  start_ = snapshot.start;
  time_ = snapshot.time;
  return true;
}

bool read_token(const char* token, Kind& kind, Values& start) {
  int found = 0;
  const char* at = nullptr;
  for (; token != nullptr && at == nullptr && found < kind_count(); ++found) {
    const std::string& own = token_of(Kind(found));
    at = std::strncmp(token, own.c_str(), own.size()) == 0 ? token + own.size() : nullptr;
  }
  if (at == nullptr) {
    return false;
  }
  kind = Kind(found - 1);
  start = published(kind);
  while (*at == ' ') {
    char* end = nullptr;
    const unsigned long place = std::strtoul(at + 1, &end, 10);
    if (end == at + 1 || *end != '=' || place >= start.size()) {
      return false;
    }
    at = end + 1;
    const std::uint64_t bits = std::strtoull(at, &end, 16);
    if (end == at) {
      return false;
    }
    std::memcpy(&start[place], &bits, sizeof bits);
    at = end;
  }
  return *at == '\0';
}

// token, 0, phase, start, time, values, moment
std::string octets_of(const Snapshot& snapshot) {
  std::string octets = token_of(snapshot.kind);
  octets.push_back('\0');
  octets.push_back(char(snapshot.phase));
  const auto put = [&octets](const double* from, std::size_t count) {
    octets.append(reinterpret_cast<const char*>(from), count * sizeof(double));
  };
  put(&snapshot.start, 1);
  put(&snapshot.time, 1);
  put(snapshot.values.data(), snapshot.values.size());
  return octets + snapshot.moment;
}

std::unique_ptr<Snapshot> snapshot_of(const char* octets, std::size_t size) {
  const void* const end = octets == nullptr ? nullptr : std::memchr(octets, 0, size);
  Kind kind = Kind::bench;
  Values values;
  if (end == nullptr || !read_token(octets, kind, values)) {
    return nullptr;
  }
  std::unique_ptr<Snapshot> s(new Snapshot{kind, Phase::instantiated, 0.0, 0.0, values, ""});
  const std::size_t head = token_of(s->kind).size() + 2, numbers = (2 + s->values.size()) * sizeof(double);
  if (size < head + numbers || octets[head - 1] < 0 || octets[head - 1] > char(Phase::failed)) {
    return nullptr;
  }
  s->phase = Phase(octets[head - 1]);
  const char* at = octets + head;
  std::memcpy(&s->start, at, sizeof(double));
  std::memcpy(&s->time, at + sizeof(double), sizeof(double));
  std::memcpy(s->values.data(), at + 2 * sizeof(double), s->values.size() * sizeof(double));
  s->moment.assign(at + numbers, size - head - numbers);
  return s;
}

}  // namespace sms_fmi
