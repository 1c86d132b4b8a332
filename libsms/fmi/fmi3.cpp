// The functions of FMI 3.0 for co-simulation, over an Instance. What this FMU does not offer is in fmi3_absent.cpp.
#include "fmi3Functions.h"
#include "instance.hpp"

namespace {

using sms_fmi::Instance;
using sms_fmi::Snapshot;
using sms_fmi::Type;

Instance& of(fmi3Instance c) { return *static_cast<Instance*>(c); }

fmi3Status status_of(bool done) { return done ? fmi3OK : fmi3Error; }

bool as_many(fmi3Instance c, size_t references, size_t values) {
  return references == values ||
         of(c).refuse("every variable has one value; the numbers of references and values differ");
}

template <typename Value>
fmi3Status get(fmi3Instance c, Type type, const fmi3ValueReference* vr, size_t count, Value* to, size_t values) {
  if (!as_many(c, count, values)) {
    return fmi3Error;
  }
  for (size_t i = 0; i < count; ++i) {
    double value = 0.0;
    if (!of(c).get(vr[i], type, value)) {
      return fmi3Error;
    }
    to[i] = static_cast<Value>(value);
  }
  return fmi3OK;
}

template <typename Value>
fmi3Status set(fmi3Instance c, Type type, const fmi3ValueReference* vr, size_t count, const Value* from,
               size_t values) {
  if (!as_many(c, count, values)) {
    return fmi3Error;
  }
  for (size_t i = 0; i < count; ++i) {
    if (!of(c).set(vr[i], type, static_cast<double>(from[i]))) {
      return fmi3Error;
    }
  }
  return fmi3OK;
}

}  // namespace

extern "C" {

const char* fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance, fmi3Boolean, size_t, const fmi3String*) { return fmi3OK; }

// ---- life ----

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String, fmi3Boolean, fmi3Boolean,
                                         fmi3Boolean events, fmi3Boolean, const fmi3ValueReference*,
                                         size_t intermediate, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log_message, fmi3IntermediateUpdateCallback) {
  const Instance::Log log = [log_message, environment](const std::string& sentence) {
    if (log_message != nullptr) {
      log_message(environment, fmi3Error, "logStatusError", sentence.c_str());
    }
  };
  sms_fmi::Kind kind = sms_fmi::Kind::bench;
  sms_fmi::Values start;
  const bool known = sms_fmi::read_token(token, kind, start);
  if (!known || events || intermediate != 0) {
    log(!known ? "modelDescription.xml is not that of this binary; export the FMU again"
               : "this FMU has no event mode and no intermediate variables");
    return nullptr;
  }
  return new Instance(kind, start, name == nullptr ? "" : name, log);
}

void fmi3FreeInstance(fmi3Instance c) { delete static_cast<Instance*>(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean, fmi3Float64, fmi3Float64 start, fmi3Boolean,
                                       fmi3Float64) {
  return status_of(of(c).plan_start(start) && of(c).enter_initialization());
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return status_of(of(c).exit_initialization()); }

fmi3Status fmi3Terminate(fmi3Instance c) { return status_of(of(c).terminate()); }

fmi3Status fmi3Reset(fmi3Instance c) {
  of(c).reset();
  return fmi3OK;
}

// ---- values ----

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference* vr, size_t count, fmi3Float64* to, size_t values) {
  return get(c, Type::real, vr, count, to, values);
}

fmi3Status fmi3GetInt64(fmi3Instance c, const fmi3ValueReference* vr, size_t count, fmi3Int64* to, size_t values) {
  return get(c, Type::enumeration, vr, count, to, values);
}

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference* vr, size_t count, fmi3Boolean* to, size_t values) {
  double value = 0.0;
  for (size_t i = 0; i < count; ++i) {
    if (get(c, Type::boolean, vr + i, 1, &value, 1 + values - count) != fmi3OK) {
      return fmi3Error;
    }
    to[i] = value > 0.5;
  }
  return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference* vr, size_t count, const fmi3Float64* from,
                          size_t values) {
  return set(c, Type::real, vr, count, from, values);
}

fmi3Status fmi3SetInt64(fmi3Instance c, const fmi3ValueReference* vr, size_t count, const fmi3Int64* from,
                        size_t values) {
  return set(c, Type::enumeration, vr, count, from, values);
}

fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference* vr, size_t count, const fmi3Boolean* from,
                          size_t values) {
  return set(c, Type::boolean, vr, count, from, values);
}

// ---- states ----

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* state) {
  if (*state == nullptr) {
    *state = new Snapshot(of(c).snapshot());
  } else {
    *static_cast<Snapshot*>(*state) = of(c).snapshot();
  }
  return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
  return status_of(state == nullptr ? of(c).refuse("there is no state to go to")
                                    : of(c).go_to(*static_cast<Snapshot*>(state)));
}

fmi3Status fmi3FreeFMUState(fmi3Instance, fmi3FMUState* state) {
  if (state != nullptr) {
    delete static_cast<Snapshot*>(*state);
    *state = nullptr;
  }
  return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance, fmi3FMUState state, size_t* size) {
  *size = sms_fmi::octets_of(*static_cast<Snapshot*>(state)).size();
  return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte* to, size_t size) {
  const std::string octets = sms_fmi::octets_of(*static_cast<Snapshot*>(state));
  if (size < octets.size()) {
    return status_of(of(c).refuse("a state needs " + std::to_string(octets.size()) + " octets"));
  }
  octets.copy(reinterpret_cast<char*>(to), octets.size());
  return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte* from, size_t size, fmi3FMUState* state) {
  std::unique_ptr<Snapshot> snapshot = sms_fmi::snapshot_of(reinterpret_cast<const char*>(from), size);
  if (snapshot == nullptr) {
    return status_of(of(c).refuse("these octets are no state of this FMU"));
  }
  *state = snapshot.release();
  return fmi3OK;
}

// ---- co-simulation ----

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 size, fmi3Boolean, fmi3Boolean* events,
                      fmi3Boolean* terminate, fmi3Boolean* early, fmi3Float64* time) {
  *events = *terminate = *early = fmi3False;
  const bool done = of(c).step(from, size);
  *time = of(c).time();
  return status_of(done);
}

}  // extern "C"
