/* The functions of FMI 2.0 for co-simulation: each passes the call on to its instance. */

#include "fmi2Functions.h"

#include <math.h>

#include "instance.h"
#include "log.h"

/* A host that calls without an instance gets an error, not a crash. */
#define INSTANCE(component)         \
    Instance *instance = component; \
    if (!instance) return fmi2Error

/* So does one that gives NULL for an array that is not empty, or for a place where to write. */
#define GIVEN(call, count, first, second) \
    if (instance_check_arrays(instance, call, count, first, second) != OK) return fmi2Error

static fmi2Status unsupported(fmi2Component component, const char *what) {
    INSTANCE(component);
    return (fmi2Status)log_error(instance, "%s is not supported: see the capabilities in modelDescription.xml.", what);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

/* life */

/* The host reads a message as a format: percent signs are doubled. */
static void deliver(const Host *host, const char *name, Status status, const char *category, const char *message) {
    char format[2 * LONGEST], *to = format;
    for (const char *from = message; *from; from++) {
        if (*from == '%') *to++ = '%';
        *to++ = *from;
    }
    *to = 0;
    ((fmi2CallbackLogger)host->logger)(host->environment, name, (fmi2Status)status, category, format);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
    INSTANCE(c);
    GIVEN("SetDebugLogging", nCategories, categories, categories);
    log_choose(instance, loggingOn, nCategories, categories);
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    (void)fmuResourceLocation, (void)visible;
    if (!functions) return NULL;
    const Host host = {"fmi2",
                       "SetupExperiment",
                       deliver,
                       (void (*)(void))functions->logger,
                       functions->componentEnvironment,
                       calloc, /* not the host's, as the description promises: fmuloader 0.1 cuts its pointers short */
                       free};
    if (fmuType == fmi2CoSimulation) return instance_new(&host, instanceName, fmuGUID, loggingOn);
    if (host.logger)
        deliver(&host, instanceName, ERROR, MODEL_CATEGORIES[OF_ERRORS],
                "This FMU is for co-simulation; model exchange is not supported.");
    return NULL;
}

void fmi2FreeInstance(fmi2Component c) {
    if (c) instance_free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    INSTANCE(c);
    (void)toleranceDefined, (void)tolerance;
    return (fmi2Status)instance_set_up(instance, startTime, stopTimeDefined ? stopTime : (double)NAN);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    INSTANCE(c);
    return (fmi2Status)instance_enter(instance);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    INSTANCE(c);
    return (fmi2Status)instance_exit(instance);
}

fmi2Status fmi2Terminate(fmi2Component c) {
    INSTANCE(c);
    return (fmi2Status)instance_terminate(instance);
}

fmi2Status fmi2Reset(fmi2Component c) {
    INSTANCE(c);
    return (fmi2Status)instance_reset(instance);
}

/* variables: either all of a call are set or none */

#define GET_AND_SET(Type, KIND, TO_TYPE)                                                                       \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2##Type value[]) { \
        INSTANCE(c);                                                                                           \
        GIVEN("Get" #Type, nvr, vr, value);                                                                    \
        for (size_t i = 0; i < nvr; i++) {                                                                     \
            double found;                                                                                      \
            if (instance_get(instance, KIND, vr[i], &found) != OK) return fmi2Error;                           \
            value[i] = TO_TYPE(found);                                                                         \
        }                                                                                                      \
        return fmi2OK;                                                                                         \
    }                                                                                                          \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,                       \
                             const fmi2##Type value[]) {                                                       \
        INSTANCE(c);                                                                                           \
        GIVEN("Set" #Type, nvr, vr, value);                                                                    \
        for (size_t i = 0; i < nvr; i++)                                                                       \
            if (instance_check(instance, KIND, vr[i], value[i]) != OK) return fmi2Error;                       \
        for (size_t i = 0; i < nvr; i++) instance_store(instance, vr[i], value[i]);                            \
        return fmi2OK;                                                                                         \
    }

#define SAME(value) (value)
GET_AND_SET(Real, REAL, SAME)
GET_AND_SET(Integer, INTEGER, instance_integer)
GET_AND_SET(Boolean, BOOLEAN, instance_integer)

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[]) {
    INSTANCE(c);
    GIVEN("GetString", nvr, vr, value);
    for (size_t i = 0; i < nvr; i++)
        if (instance_get_text(instance, vr[i], &value[i]) != OK) return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2String value[]) {
    INSTANCE(c);
    GIVEN("SetString", nvr, vr, value);
    for (size_t i = 0; i < nvr; i++)
        if (instance_check_text(instance, vr[i], value[i]) != OK) return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t nUnknown,
                                        const fmi2ValueReference known[], size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[]) {
    INSTANCE(c);
    GIVEN("GetDirectionalDerivative", nUnknown, unknown, dvUnknown);
    GIVEN("GetDirectionalDerivative", nKnown, known, dvKnown);
    return (fmi2Status)instance_forward(instance, unknown, nUnknown, known, nKnown, dvKnown, dvUnknown);
}

/* states */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    INSTANCE(c);
    GIVEN("GetFMUstate", 1, state, state);
    return (fmi2Status)instance_save(instance, state);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    INSTANCE(c);
    return (fmi2Status)instance_restore(instance, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    INSTANCE(c);
    return (fmi2Status)instance_forget(instance, state);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    INSTANCE(c);
    GIVEN("SerializedFMUstateSize", 1, size, size);
    return (fmi2Status)instance_size(instance, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    INSTANCE(c);
    GIVEN("SerializeFMUstate", size, bytes, bytes);
    return (fmi2Status)instance_write(instance, state, (unsigned char *)bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    INSTANCE(c);
    GIVEN("DeSerializeFMUstate", size, bytes, bytes);
    GIVEN("DeSerializeFMUstate", 1, state, state);
    return (fmi2Status)instance_read(instance, (const unsigned char *)bytes, size, state);
}

/* co-simulation */

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    INSTANCE(c);
    (void)noSetFMUStatePriorToCurrentPoint;
    Status status = instance_check_step(instance, time, step);
    return (fmi2Status)(status == OK ? instance_step(instance, time, step) : status);
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

/* A step is complete when fmi2DoStep returns: there is no status of a pending step. */

#define NO_STATUS(Name, Type)                                                             \
    fmi2Status fmi2Get##Name(fmi2Component c, const fmi2StatusKind kind, Type *value) { \
        (void)kind, (void)value;                                                          \
        return c ? fmi2Discard : fmi2Error;                                               \
    }

NO_STATUS(Status, fmi2Status)
NO_STATUS(IntegerStatus, fmi2Integer)
NO_STATUS(StringStatus, fmi2String)

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    INSTANCE(c);
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    GIVEN("GetRealStatus", 1, value, value);
    *value = instance->now.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    INSTANCE(c);
    if (kind != fmi2Terminated) return fmi2Discard;
    GIVEN("GetBooleanStatus", 1, value, value);
    *value = fmi2False;
    return fmi2OK;
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

#define NO_NUMBERS(Name)                                                  \
    fmi2Status fmi2Get##Name(fmi2Component c, fmi2Real x[], size_t nx) { \
        (void)x, (void)nx;                                                \
        return unsupported(c, "fmi2Get" #Name);                           \
    }

NO_NUMBERS(Derivatives)
NO_NUMBERS(EventIndicators)
NO_NUMBERS(ContinuousStates)
NO_NUMBERS(NominalsOfContinuousStates)
