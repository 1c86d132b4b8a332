// The functions of FMI 2.0 for co-simulation, over an Instance.
#include "fmi2Functions.h"
#include "instance.hpp"

namespace {

using sms_fmi::Instance;
using sms_fmi::Snapshot;
using sms_fmi::Type;

Instance& of(fmi2Component c) { return *static_cast<Instance*>(c); }

fmi2Status status_of(bool done) { return done ? fmi2OK : fmi2Error; }

fmi2Status not_here(fmi2Component c, const char* what) {
  return c == nullptr ? fmi2Error : status_of(of(c).refuse(std::string(what) + " is not offered by this FMU"));
}

template <typename Value>
fmi2Status get(fmi2Component c, Type type, const fmi2ValueReference* vr, size_t count, Value* to) {
  for (size_t i = 0; i < count; ++i) {
    double value = 0.0;
    if (!of(c).get(vr[i], type, value)) {
      return fmi2Error;
    }
    to[i] = Value(value);
  }
  return fmi2OK;
}

template <typename Value>
fmi2Status set(fmi2Component c, Type type, const fmi2ValueReference* vr, size_t count, const Value* from) {
  for (size_t i = 0; i < count; ++i) {
    if (!of(c).set(vr[i], type, double(from[i]))) {
      return fmi2Error;
    }
  }
  return fmi2OK;
}

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, size_t, const fmi2String*) { return fmi2OK; }

// ---- life ----

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String,
                              const fmi2CallbackFunctions* functions, fmi2Boolean, fmi2Boolean) {
  const std::string named = name == nullptr ? "" : name;
  const fmi2CallbackLogger logger = functions == nullptr ? nullptr : functions->logger;
  const fmi2ComponentEnvironment environment = functions == nullptr ? nullptr : functions->componentEnvironment;
  const Instance::Log log = [logger, environment, named](const std::string& sentence) {
    if (logger != nullptr) {
      logger(environment, named.c_str(), fmi2Error, "logStatusError", "%s", sentence.c_str());
    }
  };
  sms_fmi::Kind kind = sms_fmi::Kind::bench;
  sms_fmi::Values start;
  const bool known = sms_fmi::read_token(token, kind, start);
  if (type != fmi2CoSimulation || !known) {
    log(!known ? "modelDescription.xml is not that of this binary; export the FMU again"
               : "this FMU is for co-simulation, not for model exchange");
    return nullptr;
  }
  return new Instance(kind, start, named, log);
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Instance*>(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean, fmi2Real) {
  return status_of(of(c).plan_start(start));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return status_of(of(c).enter_initialization()); }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return status_of(of(c).exit_initialization()); }

fmi2Status fmi2Terminate(fmi2Component c) { return status_of(of(c).terminate()); }

fmi2Status fmi2Reset(fmi2Component c) {
  of(c).reset();
  return fmi2OK;
}

// ---- values ----

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference* vr, size_t count, fmi2Real* to) {
  return get(c, Type::real, vr, count, to);
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference* vr, size_t count, fmi2Integer* to) {
  return get(c, Type::enumeration, vr, count, to);
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference* vr, size_t count, fmi2Boolean* to) {
  return get(c, Type::boolean, vr, count, to);
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference*, size_t count, fmi2String*) {
  return count == 0 ? fmi2OK : not_here(c, "a variable that is a text");
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference* vr, size_t count, const fmi2Real* from) {
  return set(c, Type::real, vr, count, from);
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference* vr, size_t count, const fmi2Integer* from) {
  return set(c, Type::enumeration, vr, count, from);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference* vr, size_t count, const fmi2Boolean* from) {
  return set(c, Type::boolean, vr, count, from);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference*, size_t count, const fmi2String*) {
  return count == 0 ? fmi2OK : not_here(c, "a variable that is a text");
}

// ---- states ----

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  if (*state == nullptr) {
    *state = new Snapshot(of(c).snapshot());
  } else {
    *static_cast<Snapshot*>(*state) = of(c).snapshot();
  }
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return status_of(state == nullptr ? of(c).refuse("there is no state to go to")
                                    : of(c).go_to(*static_cast<Snapshot*>(state)));
}

fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  if (state != nullptr) {
    delete static_cast<Snapshot*>(*state);
    *state = nullptr;
  }
  return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component, fmi2FMUstate state, size_t* size) {
  *size = sms_fmi::octets_of(*static_cast<Snapshot*>(state)).size();
  return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte* to, size_t size) {
  const std::string octets = sms_fmi::octets_of(*static_cast<Snapshot*>(state));
  if (size < octets.size()) {
    return status_of(of(c).refuse("a state needs " + std::to_string(octets.size()) + " octets"));
  }
  octets.copy(to, octets.size());
  return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte* from, size_t size, fmi2FMUstate* state) {
  std::unique_ptr<Snapshot> snapshot = sms_fmi::snapshot_of(from, size);
  if (snapshot == nullptr) {
    return status_of(of(c).refuse("these octets are no state of this FMU"));
  }
  *state = snapshot.release();
  return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference*, size_t, const fmi2ValueReference*,
                                        size_t, const fmi2Real*, fmi2Real*) {
  return not_here(c, "a directional derivative");
}

// ---- co-simulation ----

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference*, size_t, const fmi2Integer*,
                                       const fmi2Real*) {
  return not_here(c, "an input's derivative");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference*, size_t, const fmi2Integer*,
                                        fmi2Real*) {
  return not_here(c, "an output's derivative");
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real size, fmi2Boolean) {
  return status_of(of(c).step(from, size));
}

fmi2Status fmi2CancelStep(fmi2Component c) { return not_here(c, "a step that can be cancelled"); }

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind, fmi2Status*) { return not_here(c, "a pending status"); }

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) {
    return not_here(c, "this status");
  }
  *value = of(c).time();
  return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind, fmi2Integer*) {
  return not_here(c, "this status");
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
  if (kind != fmi2Terminated) {
    return not_here(c, "this status");
  }
  *value = fmi2False;
  return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind, fmi2String*) {
  return not_here(c, "this status");
}

}  // extern "C"
