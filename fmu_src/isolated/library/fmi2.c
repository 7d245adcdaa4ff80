/* The functions of FMI 2.0 for co-simulation: each finds its instance and passes the call on. */

#include <math.h>

#include "instance.h"
#include "python.h"

/* Some hosts call with freed components: such a call is an error, not a crash. */
#define INSTANCE(component)                                    \
    Instance *instance = component;                            \
    if (!instance_known(component)) return fmi2Error

/* A host that gives NULL for an array that is not empty, or for a place where to write, gets an error. */
#define GIVEN(count, first, second) \
    if (instance_lacks(instance, count, first, second)) return fmi2Error

static fmi2Status unsupported(fmi2Component component, const char *what) {
    INSTANCE(component);
    return instance_fail(instance, "%s is not supported: see the capabilities in modelDescription.xml.", what);
}

static const char *const KINDS[] = {"Real", "Integer", "Boolean", "String"};

static void log_entry(const Host *host, const char *name, fmi2Status status, const char *category,
                      const char *message) {
    ((fmi2CallbackLogger)host->logger)(host->environment, name, status, category, message);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
    INSTANCE(c);
    GIVEN(nCategories, categories, categories);
    instance_hear(instance, loggingOn, nCategories, categories);
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    (void)visible;
    if (!functions) return NULL;
    if (fmuType != fmi2CoSimulation) {
        if (functions->logger)
            functions->logger(functions->componentEnvironment, instanceName, fmi2Error, "logStatusError",
                              "This FMU is for co-simulation; model exchange is not supported.");
        return NULL;
    }
    const Host host = {functions->logger ? log_entry : NULL, functions->componentEnvironment,
                       (void (*)(void))functions->logger, KINDS};
    return instance_new(instanceName, fmuGUID, fmuResourceLocation, &host, loggingOn);
}

void fmi2FreeInstance(fmi2Component c) {
    library_release(instance_known(c) ? instance_free(c) : NULL);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    INSTANCE(c);
    const double numbers[3] = {startTime, stopTimeDefined ? stopTime : NAN, toleranceDefined ? tolerance : NAN};
    return instance_do(instance, SETUP, numbers);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    INSTANCE(c);
    return instance_do(instance, ENTER, NULL);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    INSTANCE(c);
    return instance_do(instance, EXIT, NULL);
}

fmi2Status fmi2Terminate(fmi2Component c) {
    INSTANCE(c);
    return instance_do(instance, TERMINATE, NULL);
}

fmi2Status fmi2Reset(fmi2Component c) {
    INSTANCE(c);
    return instance_reset(instance);
}

#define GET_AND_SET(Type, KIND)                                                                              \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2##Type value[]) { \
        INSTANCE(c);                                                                                         \
        return instance_get(instance, KIND, vr, nvr, value);                                                 \
    }                                                                                                        \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,                      \
                             const fmi2##Type value[]) {                                                     \
        INSTANCE(c);                                                                                         \
        return instance_set(instance, KIND, vr, nvr, value);                                                 \
    }

GET_AND_SET(Real, REAL)
GET_AND_SET(Integer, INTEGER)
GET_AND_SET(Boolean, BOOLEAN)
GET_AND_SET(String, STRING)

/* states */

#define STATE(state)                                                                                           \
    if (!instance_owns(instance, state))                                                                       \
        return instance_fail(instance, "The FMU state is none of this instance's, or it has been freed.")

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    INSTANCE(c);
    GIVEN(1, state, state);
    return instance_save(instance, (State **)state);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    INSTANCE(c);
    STATE(state);
    return instance_restore(instance, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    INSTANCE(c);
    if (!state || !*state) return fmi2OK;
    STATE(*state);
    instance_forget(instance, *state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    INSTANCE(c);
    STATE(state);
    GIVEN(1, size, size);
    *size = state_size(state);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    INSTANCE(c);
    STATE(state);
    if (size < state_size(state))
        return instance_fail(instance, "The FMU state has %zu bytes; there is room for %zu only.", state_size(state),
                             size);
    GIVEN(size, bytes, bytes);
    state_write(state, bytes);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    INSTANCE(c);
    GIVEN(size, bytes, bytes);
    GIVEN(1, state, state);
    State *read = instance_read(instance, bytes, size);
    if (!read) return fmi2Error;
    *state = read;
    return fmi2OK;
}

/* co-simulation */

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    INSTANCE(c);
    (void)noSetFMUStatePriorToCurrentPoint;
    const double numbers[3] = {time, step, 0.0};
    return instance_do(instance, STEP, numbers);
}

fmi2Status fmi2CancelStep(fmi2Component c) { return unsupported(c, "fmi2CancelStep"); }

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    (void)vr, (void)nvr, (void)order, (void)value;
    return unsupported(c, "fmi2SetRealInputDerivatives");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
    (void)vr, (void)nvr, (void)order, (void)value;
    return unsupported(c, "fmi2GetRealOutputDerivatives");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t nUnknown,
                                        const fmi2ValueReference known[], size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[]) {
    (void)unknown, (void)nUnknown, (void)known, (void)nKnown, (void)dvKnown, (void)dvUnknown;
    return unsupported(c, "fmi2GetDirectionalDerivative");
}

/* A step is complete when fmi2DoStep returns: there is no status of a pending step. */

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    (void)kind, (void)value;
    return instance_known(c) ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    (void)kind, (void)value;
    return instance_known(c) ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind, (void)value;
    return instance_known(c) ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    INSTANCE(c);
    if (kind != fmi2Terminated) return fmi2Discard;
    GIVEN(1, value, value);
    *value = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
    (void)kind, (void)value;
    return instance_known(c) ? fmi2Discard : fmi2Error;
}

/* model exchange: hosts look up the names, though they may not call them */

fmi2Status fmi2EnterEventMode(fmi2Component c) { return unsupported(c, "fmi2EnterEventMode"); }

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    (void)info;
    return unsupported(c, "fmi2NewDiscreteStates");
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return unsupported(c, "fmi2EnterContinuousTimeMode"); }

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint, (void)enterEventMode, (void)terminateSimulation;
    return unsupported(c, "fmi2CompletedIntegratorStep");
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    (void)time;
    return unsupported(c, "fmi2SetTime");
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx) {
    (void)x, (void)nx;
    return unsupported(c, "fmi2SetContinuousStates");
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx) {
    (void)derivatives, (void)nx;
    return unsupported(c, "fmi2GetDerivatives");
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t ni) {
    (void)indicators, (void)ni;
    return unsupported(c, "fmi2GetEventIndicators");
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx) {
    (void)x, (void)nx;
    return unsupported(c, "fmi2GetContinuousStates");
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t nx) {
    (void)nominals, (void)nx;
    return unsupported(c, "fmi2GetNominalsOfContinuousStates");
}
