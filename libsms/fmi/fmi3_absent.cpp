// What FMI 3.0 declares and this FMU does not offer: other types than its own, clocks, events, derivatives, and the two
// other interfaces. Each call is refused in a sentence.
#include "fmi3Functions.h"
#include "instance.hpp"

namespace {

fmi3Status not_here(fmi3Instance c, const char* what) {
  if (c != nullptr) {
    static_cast<sms_fmi::Instance*>(c)->refuse(std::string(what) + " is not offered by this FMU");
  }
  return fmi3Error;
}

}  // namespace

extern "C" {

// ---- interfaces ----

fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
  if (log != nullptr) {
    log(environment, fmi3Error, "logStatusError", "this FMU is for co-simulation, not for model exchange");
  }
  return nullptr;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                               fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
                                               fmi3UnlockPreemptionCallback) {
  if (log != nullptr) {
    log(environment, fmi3Error, "logStatusError", "this FMU is for co-simulation, not for scheduled execution");
  }
  return nullptr;
}

// ---- other types ----

fmi3Status fmi3GetFloat32(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Float32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetFloat32(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Float32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetInt8(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Int8*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetInt8(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Int8*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetUInt8(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt8*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetUInt8(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt8*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetInt16(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Int16*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetInt16(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Int16*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetUInt16(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt16*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetUInt16(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt16*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Int32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetInt32(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Int32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetUInt32(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetUInt32(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt32*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetUInt64(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt64*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetUInt64(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt64*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3String*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3String*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference*, size_t, size_t*, fmi3Binary*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference*, size_t, const size_t*, const fmi3Binary*, size_t) {
  return not_here(c, "a variable of this type");
}
fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Clock*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Clock*) {
  return not_here(c, "a clock");
}

// ---- clocks and events ----

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Float64*,
                                  fmi3IntervalQualifier*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt64*, fmi3UInt64*,
                                   fmi3IntervalQualifier*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3Float64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference*, size_t, fmi3UInt64*, fmi3UInt64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Float64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt64*,
                                   const fmi3UInt64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Float64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3UInt64*,
                                const fmi3UInt64*) {
  return not_here(c, "a clock");
}
fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference, fmi3Float64) {
  return not_here(c, "a clock");
}
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return not_here(c, "an event mode"); }
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*,
                                    fmi3Boolean*, fmi3Float64*) {
  return not_here(c, "an event mode");
}
fmi3Status fmi3EnterEventMode(fmi3Instance c) { return not_here(c, "an event mode"); }
fmi3Status fmi3EnterStepMode(fmi3Instance c) { return not_here(c, "an event mode"); }
fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return not_here(c, "a structural parameter"); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return not_here(c, "a structural parameter"); }

// ---- derivatives and dependencies ----

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference, size_t*) {
  return not_here(c, "a list of dependencies");
}
fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference, size_t*, fmi3ValueReference*, size_t*,
                                       fmi3DependencyKind*, size_t) {
  return not_here(c, "a list of dependencies");
}
fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3ValueReference*,
                                        size_t, const fmi3Float64*, size_t, fmi3Float64*, size_t) {
  return not_here(c, "a derivative");
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3ValueReference*,
                                    size_t, const fmi3Float64*, size_t, fmi3Float64*, size_t) {
  return not_here(c, "a derivative");
}
fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference*, size_t, const fmi3Int32*, fmi3Float64*,
                                    size_t) {
  return not_here(c, "a derivative");
}

// ---- model exchange ----

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return not_here(c, "model exchange"); }
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean, fmi3Boolean*, fmi3Boolean*) {
  return not_here(c, "model exchange");
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64) { return not_here(c, "model exchange"); }
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64*, size_t) { return not_here(c, "model exchange"); }
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64*, size_t) {
  return not_here(c, "model exchange");
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64*, size_t) { return not_here(c, "model exchange"); }
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64*, size_t) { return not_here(c, "model exchange"); }
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64*, size_t) {
  return not_here(c, "model exchange");
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t*) { return not_here(c, "model exchange"); }
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t*) { return not_here(c, "model exchange"); }

}  // extern "C"
