// An FMU instance, for both standards: what may be called when, the values of the variables, and sentences for the log.
//
// Nothing is shared between two instances. A call that is refused says so in one sentence and leaves everything as it was;
// a run that the plant itself ends (a chamber without volume) can only be reset or taken back to a state.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "model.hpp"

namespace sms_fmi {

enum class Phase : int { instantiated, initialization, stepping, terminated, failed };

// All of an instance that its master may keep.
struct Snapshot {
  Kind kind;
  Phase phase;
  double start;  // s
  double time;   // s
  Values values;
  std::string moment;  // of the model; empty before it has begun
};

class Instance {
 public:
  using Log = std::function<void(const std::string& sentence)>;

  // start: of every variable, as read_token() gives them.
  Instance(Kind kind, const Values& start, const std::string& name, Log log);

  const std::string& name() const { return name_; }

  // All of these: false when refused.
  bool plan_start(double start);
  bool enter_initialization();
  bool exit_initialization();
  bool step(double from, double size);
  bool terminate();
  void reset();
  bool get(unsigned place, Type type, double& value);
  bool set(unsigned place, Type type, double value);
  bool go_to(const Snapshot& snapshot);

  Snapshot snapshot() const;
  double time() const { return time_; }
  bool refuse(const std::string& sentence) const;

 private:
  bool parameters_are_allowed() const;
  bool inputs_are_numbers() const;
  bool begin();
  bool fail(const std::string& what, sms_status status);

  Kind kind_;
  std::string name_;
  Log log_;
  std::unique_ptr<Model> model_;
  Values start_values_;
  Values values_;
  Phase phase_ = Phase::instantiated;
  bool begun_ = false;  // the model stands where the values say
  double start_ = 0.0;
  double time_ = 0.0;
};

// The model that a token of modelDescription.xml names, and the start values of its variables; false: it is not of this
// binary. Behind token_of(kind) the token has what is other than the published machine, " 17=3f50624dd2f1a9fc": value
// reference and the bits of the number, which no locale reads in another way.
bool read_token(const char* token, Kind& kind, Values& start);

std::string octets_of(const Snapshot& snapshot);
// Empty when these are no octets of this binary.
std::unique_ptr<Snapshot> snapshot_of(const char* octets, std::size_t size);

}  // namespace sms_fmi
