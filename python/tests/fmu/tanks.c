/* The two tanks of python/examples/two_tanks.py as an FMU for model exchange and co-simulation, of FMI 2.0 (FMI = 2) or
 * 3.0: written against the standards, with nothing of this project's own export. Built by fmu_plants.py. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if FMI == 2
#include "fmi2Functions.h"
typedef fmi2Status Status;
#define OK fmi2OK
#define ERROR fmi2Error
#define API FMI2_Export
#else
#include "fmi3Functions.h"
typedef fmi3Status Status;
#define OK fmi3OK
#define ERROR fmi3Error
#define API FMI3_Export
#endif

/* Value references. */
enum { H1, H2, DER1, DER2, VOLT, Y1, Y2, GAIN, OUT1, OUT2, BAND, LEAK1, LEAK2, GAIN1, GAIN2, ZERO1, ZERO2, COUNT };

typedef struct {
  double v[COUNT];
  double late; /* s, of time that has passed and not been stepped over */
  double time; /* s, of model exchange */
} Tanks;

/* s, of the steps in which it moves; 0: of any length. */
#ifndef INTERNAL
#define INTERNAL 0.0
#endif

/* m^3/s, of rain into the upper tank that swings with time itself. */
#ifndef RAIN
#define RAIN 0.0
#endif

/* s, of an event that is planned; 0: none. */
#ifndef PLANNED
#define PLANNED 0.0
#endif

static const double start[COUNT] = {0.05, 0.05, 0, 0, 0, 0, 0, 3.3e-6, 17.8e-6, 17.8e-6};

static double outflow(double level) { return sqrt(2.0 * 9.81 * fmax(level, 1e-6)); }

static void update(Tanks* t) {
  double* v = t->v;
  const double first = outflow(v[H1]), second = outflow(v[H2]);
  const double pumped = v[GAIN] * fmax(v[VOLT] - v[BAND], 0.0) + RAIN * sin(t->time);
  v[DER1] = (pumped - (v[OUT1] + v[LEAK1]) * first) / 15.5e-4;
  v[DER2] = (v[OUT1] * first - (v[OUT2] + v[LEAK2]) * second) / 15.5e-4;
  v[Y1] = (1.0 + v[GAIN1]) * v[H1] + v[ZERO1];
  v[Y2] = (1.0 + v[GAIN2]) * v[H2] + v[ZERO2];
}

/* d unknown / d state. */
static double slope(Tanks* t, unsigned unknown, unsigned state) {
  const double* v = t->v;
  const double level = v[state == H1 ? H1 : H2];
  const double d = level > 1e-6 ? 9.81 / outflow(level) : 0.0;
  if (state == H1) {
    return unknown == DER1   ? -(v[OUT1] + v[LEAK1]) * d / 15.5e-4
           : unknown == DER2 ? v[OUT1] * d / 15.5e-4
           : unknown == Y1   ? 1.0 + v[GAIN1]
                             : 0.0;
  }
  return unknown == DER2 ? -(v[OUT2] + v[LEAK2]) * d / 15.5e-4 : unknown == Y2 ? 1.0 + v[GAIN2] : 0.0;
}

static Status set(void* instance, const unsigned* reference, size_t n, const double* value) {
  for (size_t i = 0; i < n; ++i) {
    if (reference[i] >= COUNT || !isfinite(value[i])) {
      return ERROR;
    }
    ((Tanks*)instance)->v[reference[i]] = value[i];
  }
  return OK;
}

static Status get(void* instance, const unsigned* reference, size_t n, double* value) {
  update(instance);
  for (size_t i = 0; i < n; ++i) {
    if (reference[i] >= COUNT) {
      return ERROR;
    }
    value[i] = ((Tanks*)instance)->v[reference[i]];
  }
  return OK;
}

static Status set_states(void* instance, const double* x) {
  memcpy(((Tanks*)instance)->v, x, 2 * sizeof *x);
  return OK;
}

static Status set_time(void* instance, double time) {
  ((Tanks*)instance)->time = time;
  return OK;
}

static Status get_rates(void* instance, double* rates) {
  update(instance);
  memcpy(rates, ((Tanks*)instance)->v + DER1, 2 * sizeof *rates);
  return OK;
}

/* Heun's step, a hundredth of a second at most. */
static Status step(void* instance, double length) {
  double* v = ((Tanks*)instance)->v;
  if (INTERNAL > 0.0) {
    double* late = &((Tanks*)instance)->late;
    *late += length;
    length = INTERNAL * floor(*late / INTERNAL + 1e-9);
    *late -= length;
    if (length == 0.0) {
      return OK;
    }
  }
  const int n = (int)ceil(length / 0.01);
  const double h = length / n;
  for (int i = 0; i < n; ++i) {
    double before[2], rate[2];
    memcpy(before, v, sizeof before);
    get_rates(instance, rate);
    for (int k = 0; k < 2; ++k) {
      v[k] = before[k] + h * rate[k];
    }
    update(instance);
    for (int k = 0; k < 2; ++k) {
      v[k] = before[k] + 0.5 * h * (rate[k] + v[DER1 + k]);
    }
  }
  return OK;
}

static void* made(void) {
  Tanks* t = malloc(sizeof *t);
  memcpy(t->v, start, sizeof start);
  t->late = t->time = 0.0;
  return t;
}

static Status begin(void* instance) {
  memcpy(((Tanks*)instance)->v, start, sizeof start);
  ((Tanks*)instance)->late = ((Tanks*)instance)->time = 0.0;
  return OK;
}

#if FMI == 2
API fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String place,
                                  const fmi2CallbackFunctions* calls, fmi2Boolean visible, fmi2Boolean log) {
  (void)name, (void)type, (void)guid, (void)place, (void)calls, (void)visible, (void)log;
  return made();
}
API void fmi2FreeInstance(fmi2Component c) { free(c); }
API const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
API const char* fmi2GetVersion(void) { return fmi2Version; }
API fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String x[]) {
  (void)c, (void)on, (void)n, (void)x;
  return OK;
}
API fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean a, fmi2Real b, fmi2Real d, fmi2Boolean e, fmi2Real f) {
  (void)c, (void)a, (void)b, (void)d, (void)e, (void)f;
  return OK;
}
API fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return (void)c, OK; }
API fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return (void)c, OK; }
API fmi2Status fmi2EnterEventMode(fmi2Component c) { return (void)c, OK; }
API fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return (void)c, OK; }
API fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  (void)c;
  memset(info, 0, sizeof *info);
  info->nextEventTimeDefined = PLANNED > 0.0;
  info->nextEventTime = PLANNED;
  return OK;
}
API fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean a, fmi2Boolean* b, fmi2Boolean* d) {
  (void)c, (void)a;
  *b = *d = fmi2False;
  return OK;
}
API fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) { return set_time(c, t); }
API fmi2Status fmi2Terminate(fmi2Component c) { return (void)c, OK; }
API fmi2Status fmi2Reset(fmi2Component c) { return begin(c); }
API fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real v[]) {
  return get(c, r, n, v);
}
API fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real v[]) {
  return set(c, r, n, v);
}
API fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
  return n == 2 ? set_states(c, x) : ERROR;
}
API fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
  memcpy(x, ((Tanks*)c)->v, n * sizeof *x);
  return OK;
}
API fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real x[], size_t n) { return n == 2 ? get_rates(c, x) : ERROR; }
API fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz,
                                            const fmi2ValueReference k[], size_t nk, const fmi2Real dk[],
                                            fmi2Real dz[]) {
  for (size_t i = 0; i < nz; ++i) {
    dz[i] = 0.0;
    for (size_t j = 0; j < nk; ++j) {
      dz[i] += slope(c, z[i], k[j]) * dk[j];
    }
  }
  return OK;
}
API fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean keep) {
  return (void)t, (void)keep, step(c, h);
}
#else
static fmi3Instance made3(void) { return made(); }
API fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String place, fmi3Boolean visible,
                                              fmi3Boolean log, fmi3InstanceEnvironment e, fmi3LogMessageCallback m) {
  (void)name, (void)token, (void)place, (void)visible, (void)log, (void)e, (void)m;
  return made3();
}
API fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String place, fmi3Boolean visible,
                                             fmi3Boolean log, fmi3Boolean events, fmi3Boolean early,
                                             const fmi3ValueReference r[], size_t n, fmi3InstanceEnvironment e,
                                             fmi3LogMessageCallback m, fmi3IntermediateUpdateCallback u) {
  (void)name, (void)token, (void)place, (void)visible, (void)log, (void)events, (void)early, (void)r, (void)n, (void)e;
  (void)m, (void)u;
  return made3();
}
API void fmi3FreeInstance(fmi3Instance c) { free(c); }
API const char* fmi3GetVersion(void) { return fmi3Version; }
API fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean a, fmi3Float64 b, fmi3Float64 d, fmi3Boolean e,
                                           fmi3Float64 f) {
  (void)c, (void)a, (void)b, (void)d, (void)e, (void)f;
  return OK;
}
API fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return (void)c, OK; }
API fmi3Status fmi3EnterEventMode(fmi3Instance c) { return (void)c, OK; }
API fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return (void)c, OK; }
API fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean* a, fmi3Boolean* b, fmi3Boolean* d, fmi3Boolean* e,
                                        fmi3Boolean* f, fmi3Float64* g) {
  (void)c;
  *a = *b = *d = *e = fmi3False;
  *f = PLANNED > 0.0;
  *g = PLANNED;
  return OK;
}
API fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t) { return set_time(c, t); }
API fmi3Status fmi3Terminate(fmi3Instance c) { return (void)c, OK; }
API fmi3Status fmi3Reset(fmi3Instance c) { return begin(c); }
API fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 v[], size_t m) {
  return m == n ? get(c, r, n, v) : ERROR;
}
API fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[], size_t m) {
  return m == n ? set(c, r, n, v) : ERROR;
}
API fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
  return n == 2 ? set_states(c, x) : ERROR;
}
API fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 x[], size_t n) {
  return n == 2 ? get_rates(c, x) : ERROR;
}
API fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference z[], size_t nz,
                                            const fmi3ValueReference k[], size_t nk, const fmi3Float64 dk[], size_t ndk,
                                            fmi3Float64 dz[], size_t ndz) {
  if (ndk != nk || ndz != nz) {
    return ERROR;
  }
  for (size_t i = 0; i < nz; ++i) {
    dz[i] = 0.0;
    for (size_t j = 0; j < nk; ++j) {
      dz[i] += slope(c, z[i], k[j]) * dk[j];
    }
  }
  return OK;
}
API fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 t, fmi3Float64 h, fmi3Boolean keep, fmi3Boolean* a,
                          fmi3Boolean* b, fmi3Boolean* d, fmi3Float64* last) {
  (void)keep;
  *a = *b = *d = fmi3False;
  *last = t + h;
  return step(c, h);
}
#endif
