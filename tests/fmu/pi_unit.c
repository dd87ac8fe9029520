/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* A PI controller as an FMU for co-simulation: FMI 2.0 with -DFMI=2, FMI 3.0 with -DFMI=3.
 *
 * It answers as ddct_controllers.pi does, demands the calls that the standard demands, and fails
 * on request. It keeps its state in static variables, as careless tools do: only a binary that is
 * loaded anew is without the past. */
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { ERROR_RPM, DEMAND, CLUTCH, ENGINE, KP, KI, FAULT_TIME, AHEAD, REALS };
enum { FIRST_INTEGER = 20, FAULT = 0, ORDER, INTEGERS };
enum { NO_FAULT, FAIL, DIE, NOT_A_NUMBER, STOP, LEAVE, ABORT, CRASH, LOOP, WARN };
enum { EULER = 1, TRAPEZOIDAL = 2 };

static double reals[REALS] = {0, 0, 0, 0, 0.1, 0.1, 0, 0};
static int64_t integers[INTEGERS] = {NO_FAULT, EULER};
static bool inverted;
static char remark[80];
static double integral;
static long steps;
static bool warned;
static enum { INSTANTIATED, INITIALISING, STEPPING } phase;

static void note(const char *event) {
    const char *path = getenv("PI_UNIT_EVENTS");
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file) {
        fprintf(file, "%s\n", event);
        fclose(file);
    }
}

/* Do what ends, or stops, the process in which it runs. */
static void harm(int fault) {
    if (fault == LEAVE) exit(0);
    if (fault == ABORT) abort();
    if (fault == CRASH) raise(SIGSEGV);
    while (fault == LOOP) pause();
}

static void instantiated(void) {
    const char *fault = getenv("PI_UNIT_LOAD_FAULT");
    note("instantiated");
    if (fault) harm(atoi(fault));
}

static int set_reals(const uint32_t *refs, size_t count, const double *values) {
    for (size_t i = 0; i < count; i++) {
        bool input = refs[i] == ERROR_RPM || refs[i] == DEMAND || refs[i] == AHEAD;
        if (refs[i] >= REALS || warned || (!input && phase != INSTANTIATED)) return ERROR;
        reals[refs[i]] = values[i];
    }
    return OK;
}

static int get_reals(const uint32_t *refs, size_t count, double *values) {
    for (size_t i = 0; i < count; i++) {
        if (refs[i] >= REALS) return ERROR;
        values[i] = reals[refs[i]];
    }
    return OK;
}

static int set_integer(uint32_t ref, int64_t value) {
    ref -= FIRST_INTEGER;
    if (ref >= INTEGERS || phase != INSTANTIATED) return ERROR;
    integers[ref] = value;
    return OK;
}

static int set_text(const char *text) {
    snprintf(remark, sizeof remark, "%s", text);
    return OK;
}

static int step(double time, double size, bool *stop) {
    if (phase != STEPPING || fabs(time - 0.01 * steps) > 1e-12 || size != 0.01) return ERROR;
    if (integers[FAULT] != NO_FAULT && time >= reals[FAULT_TIME]) {
        if (integers[FAULT] == FAIL) return ERROR;
        if (integers[FAULT] == DIE) return FATAL;
        if (integers[FAULT] == STOP) *stop = true;
        harm((int)integers[FAULT]);
        warned = integers[FAULT] == WARN;  /* the next input is refused without a word */
    }
    if (integers[ORDER] == TRAPEZOIDAL) integral += 0.01 * reals[ERROR_RPM];
    double torque = -(reals[KP] * reals[ERROR_RPM] + reals[KI] * integral);
    if (integers[ORDER] == EULER) integral += 0.01 * reals[ERROR_RPM];
    reals[CLUTCH] = inverted ? -torque : torque;
    if (integers[FAULT] == NOT_A_NUMBER && time >= reals[FAULT_TIME]) reals[CLUTCH] = NAN;
    reals[ENGINE] = reals[DEMAND];
    steps++;
    return warned ? WARNING : OK;
}

static int enter(void) {
    if (phase != INSTANTIATED) return ERROR;
    phase = INITIALISING;
    return OK;
}

static int leave(void) {
    if (phase != INITIALISING) return ERROR;
    phase = STEPPING;
    return OK;
}

#define UNUSED(name) int name(void) { return ERROR; }

#if FMI == 2

typedef struct {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;
static const Callbacks *callbacks;

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                      const Callbacks *given, int visible, int logging) {
    (void)name, (void)visible, (void)logging;
    if (kind != 1 || strcmp(guid, "{pi}") || strncmp(resources, "file:///", 8)) return NULL;
    callbacks = given;
    instantiated();
    return reals;
}
void fmi2FreeInstance(void *self) { (void)self, note("freed"); }
int fmi2SetupExperiment(void *self, int with_tolerance, double tolerance, double start,
                        int with_stop, double stop) {
    (void)self, (void)with_tolerance, (void)tolerance, (void)with_stop, (void)stop;
    return start == 0.0 && phase == INSTANTIATED ? OK : ERROR;
}
int fmi2EnterInitializationMode(void *self) { return (void)self, enter(); }
int fmi2ExitInitializationMode(void *self) { return (void)self, leave(); }
int fmi2SetReal(void *self, const uint32_t *refs, size_t count, const double *values) {
    return (void)self, set_reals(refs, count, values);
}
int fmi2GetReal(void *self, const uint32_t *refs, size_t count, double *values) {
    return (void)self, get_reals(refs, count, values);
}
int fmi2SetInteger(void *self, const uint32_t *refs, size_t count, const int *values) {
    return (void)self, count == 1 ? set_integer(refs[0], values[0]) : ERROR;
}
int fmi2SetBoolean(void *self, const uint32_t *refs, size_t count, const int *values) {
    (void)self, (void)refs, (void)count;
    inverted = values[0];
    return OK;
}
int fmi2SetString(void *self, const uint32_t *refs, size_t count, const char *const *values) {
    return (void)self, (void)refs, (void)count, set_text(values[0]);
}
int fmi2DoStep(void *self, double time, double size, int keep) {
    (void)self, (void)keep;
    bool stop = false;
    int status = step(time, size, &stop);
    if (status != OK)
        callbacks->log(callbacks->environment, "pi", status, "error", "%s after %ld steps",
                       remark, steps);
    return stop ? DISCARD : status;
}
UNUSED(fmi2CancelStep) UNUSED(fmi2DeSerializeFMUstate) UNUSED(fmi2FreeFMUstate)
UNUSED(fmi2GetBoolean) UNUSED(fmi2GetBooleanStatus) UNUSED(fmi2GetDirectionalDerivative)
UNUSED(fmi2GetFMUstate) UNUSED(fmi2GetInteger) UNUSED(fmi2GetIntegerStatus)
UNUSED(fmi2GetRealOutputDerivatives) UNUSED(fmi2GetRealStatus) UNUSED(fmi2GetStatus)
UNUSED(fmi2GetString) UNUSED(fmi2GetStringStatus) UNUSED(fmi2GetTypesPlatform)
UNUSED(fmi2GetVersion) UNUSED(fmi2Reset) UNUSED(fmi2SerializeFMUstate)
UNUSED(fmi2SerializedFMUstateSize) UNUSED(fmi2SetDebugLogging) UNUSED(fmi2SetFMUstate)
UNUSED(fmi2SetRealInputDerivatives) UNUSED(fmi2Terminate)

#else

static void *environment;
static void (*logger)(void *, int, const char *, const char *);

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                  bool visible, bool logging, bool events, bool early,
                                  const uint32_t *required, size_t count, void *given,
                                  void (*log)(void *, int, const char *, const char *),
                                  void *update) {
    (void)name, (void)resources, (void)visible, (void)logging, (void)required, (void)update;
    if (strcmp(token, "{pi}") || events || early || count) return NULL;
    environment = given;
    logger = log;
    instantiated();
    return reals;
}
void fmi3FreeInstance(void *self) { (void)self, note("freed"); }
int fmi3EnterInitializationMode(void *self, bool with_tolerance, double tolerance, double start,
                                bool with_stop, double stop) {
    (void)self, (void)with_tolerance, (void)tolerance, (void)with_stop, (void)stop;
    return start == 0.0 ? enter() : ERROR;
}
int fmi3ExitInitializationMode(void *self) { return (void)self, leave(); }
int fmi3SetFloat64(void *self, const uint32_t *refs, size_t count, const double *values,
                   size_t size) {
    return (void)self, count == size ? set_reals(refs, count, values) : ERROR;
}
int fmi3GetFloat64(void *self, const uint32_t *refs, size_t count, double *values, size_t size) {
    return (void)self, count == size ? get_reals(refs, count, values) : ERROR;
}
int fmi3SetFloat32(void *self, const uint32_t *refs, size_t count, const float *values,
                   size_t size) {
    double wide = values[0];
    return (void)self, count == 1 && size == 1 ? set_reals(refs, 1, &wide) : ERROR;
}
int fmi3GetFloat32(void *self, const uint32_t *refs, size_t count, float *values, size_t size) {
    double wide = 0.0;
    int status = count == 1 && size == 1 ? get_reals(refs, 1, &wide) : ERROR;
    (void)self;
    values[0] = (float)wide;
    return status;
}
int fmi3SetInt32(void *self, const uint32_t *refs, size_t count, const int32_t *values,
                 size_t size) {
    return (void)self, count == 1 && size == 1 ? set_integer(refs[0], values[0]) : ERROR;
}
int fmi3SetInt64(void *self, const uint32_t *refs, size_t count, const int64_t *values,
                 size_t size) {
    return (void)self, count == 1 && size == 1 ? set_integer(refs[0], values[0]) : ERROR;
}
int fmi3SetBoolean(void *self, const uint32_t *refs, size_t count, const bool *values,
                   size_t size) {
    (void)self, (void)refs, (void)count, (void)size;
    inverted = values[0];
    return OK;
}
int fmi3SetString(void *self, const uint32_t *refs, size_t count, const char *const *values,
                  size_t size) {
    return (void)self, (void)refs, (void)count, (void)size, set_text(values[0]);
}
int fmi3DoStep(void *self, double time, double size, bool keep, bool *event, bool *stop,
               bool *early, double *last) {
    (void)self, (void)keep;
    *event = *stop = *early = false;
    *last = time + size;
    int status = step(time, size, stop);
    if (status != OK) {
        char text[160];
        snprintf(text, sizeof text, "%s after %ld steps", remark, steps);
        logger(environment, status, "error", text);
    }
    return status;
}
UNUSED(fmi3ActivateModelPartition) UNUSED(fmi3CompletedIntegratorStep)
UNUSED(fmi3DeserializeFMUState) UNUSED(fmi3EnterConfigurationMode)
UNUSED(fmi3EnterContinuousTimeMode) UNUSED(fmi3EnterEventMode) UNUSED(fmi3EnterStepMode)
UNUSED(fmi3EvaluateDiscreteStates) UNUSED(fmi3ExitConfigurationMode) UNUSED(fmi3FreeFMUState)
UNUSED(fmi3GetAdjointDerivative) UNUSED(fmi3GetBinary) UNUSED(fmi3GetBoolean)
UNUSED(fmi3GetClock) UNUSED(fmi3GetContinuousStateDerivatives) UNUSED(fmi3GetContinuousStates)
UNUSED(fmi3GetDirectionalDerivative) UNUSED(fmi3GetEventIndicators) UNUSED(fmi3GetFMUState)
UNUSED(fmi3GetInt16) UNUSED(fmi3GetInt32) UNUSED(fmi3GetInt64)
UNUSED(fmi3GetInt8) UNUSED(fmi3GetIntervalDecimal) UNUSED(fmi3GetIntervalFraction)
UNUSED(fmi3GetNominalsOfContinuousStates) UNUSED(fmi3GetNumberOfContinuousStates)
UNUSED(fmi3GetNumberOfEventIndicators) UNUSED(fmi3GetNumberOfVariableDependencies)
UNUSED(fmi3GetOutputDerivatives) UNUSED(fmi3GetShiftDecimal) UNUSED(fmi3GetShiftFraction)
UNUSED(fmi3GetString) UNUSED(fmi3GetUInt16) UNUSED(fmi3GetUInt32) UNUSED(fmi3GetUInt64)
UNUSED(fmi3GetUInt8) UNUSED(fmi3GetVariableDependencies) UNUSED(fmi3GetVersion)
UNUSED(fmi3InstantiateModelExchange) UNUSED(fmi3InstantiateScheduledExecution)
UNUSED(fmi3Reset) UNUSED(fmi3SerializeFMUState) UNUSED(fmi3SerializedFMUStateSize)
UNUSED(fmi3SetBinary) UNUSED(fmi3SetClock) UNUSED(fmi3SetContinuousStates)
UNUSED(fmi3SetDebugLogging) UNUSED(fmi3SetFMUState) UNUSED(fmi3SetInt16)
UNUSED(fmi3SetInt8) UNUSED(fmi3SetIntervalDecimal) UNUSED(fmi3SetIntervalFraction)
UNUSED(fmi3SetShiftDecimal) UNUSED(fmi3SetShiftFraction) UNUSED(fmi3SetTime)
UNUSED(fmi3SetUInt16) UNUSED(fmi3SetUInt32) UNUSED(fmi3SetUInt64) UNUSED(fmi3SetUInt8)
UNUSED(fmi3Terminate) UNUSED(fmi3UpdateDiscreteStates)

#endif
