/* The functions of FMI 3.0 for co-simulation: each finds its instance and passes the call on. fmi3_unsupported.c has
   those that this FMU does without. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3.h"
#include "python.h"

_Static_assert((int)fmi3OK == (int)fmi2OK && (int)fmi3Warning == (int)fmi2Warning && (int)fmi3Error == (int)fmi2Error,
               "a status has one value in both versions");

static const char *const KINDS[] = {"Float64", "Int32", "Boolean", "String"};

fmi3Status fmi3_unsupported(fmi3Instance c, const char *what) {
    INSTANCE(c);
    return STATUS(instance_fail(instance, "%s is not supported: see the capabilities in modelDescription.xml.", what));
}

/* log */

/* A message as FMI 3.0 has it: no format, and the calls under their names of today. NULL without memory. */
static char *translated(const char *message) {
    static const struct {
        const char *before, *now;
    } words[] = {{"fmi2SetupExperiment", "fmi3EnterInitializationMode"}, {"fmi2", "fmi3"}, {"%%", "%"}};
    char *text = malloc(2 * strlen(message) + 1), *to = text;
    while (text && *message) {
        const char *from = message, *found = NULL;
        for (size_t i = 0; i < sizeof words / sizeof *words && !found; i++)
            if (!strncmp(from, words[i].before, strlen(words[i].before))) {
                found = words[i].now;
                message += strlen(words[i].before);
            }
        if (!found) found = message++;
        size_t length = found == from ? 1 : strlen(found);
        memcpy(to, found, length);
        to += length;
    }
    if (text) *to = 0;
    return text;
}

static void log_entry(const Host *host, const char *name, fmi2Status status, const char *category,
                      const char *message) {
    char *text = translated(message);
    (void)name;
    ((fmi3LogMessageCallback)host->logger)(host->environment, STATUS(status), category, text ? text : message);
    free(text);
}

/* instances */

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[]) {
    INSTANCE(c);
    GIVEN(nCategories, categories, categories);
    instance_hear(instance, loggingOn, nCategories, categories);
    return fmi3OK;
}

static fmi3Instance refused(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, const char *why) {
    if (log) log(environment, fmi3Error, "logStatusError", why);
    return NULL;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
                                         fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                         fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate) {
    const Host host = {logMessage ? log_entry : NULL, instanceEnvironment, (void (*)(void))logMessage, KINDS};
    (void)visible, (void)earlyReturnAllowed, (void)requiredIntermediateVariables, (void)intermediateUpdate;
    if (eventModeUsed)
        return refused(instanceEnvironment, logMessage, "This FMU has no event mode: hasEventMode is false.");
    if (nRequiredIntermediateVariables)
        return refused(instanceEnvironment, logMessage,
                       "This FMU makes no intermediate updates: providesIntermediateUpdate is false.");
    return instance_new(instanceName, instantiationToken, resourcePath, &host, loggingOn);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage) {
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    return refused(instanceEnvironment, logMessage,
                   "This FMU is for co-simulation; model exchange is not supported.");
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                               fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption) {
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    (void)clockUpdate, (void)lockPreemption, (void)unlockPreemption;
    return refused(instanceEnvironment, logMessage,
                   "This FMU is for co-simulation; scheduled execution is not supported.");
}

void fmi3FreeInstance(fmi3Instance c) { library_release(instance_known(c) ? instance_free(c) : NULL); }

/* phases */

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
    INSTANCE(c);
    const double numbers[3] = {startTime, stopTimeDefined ? stopTime : NAN, toleranceDefined ? tolerance : NAN};
    fmi2Status set_up = instance_do(instance, SETUP, numbers);
    if (set_up > fmi2Warning) return STATUS(set_up);
    fmi2Status entered = instance_do(instance, ENTER, NULL);
    return STATUS(entered > set_up ? entered : set_up);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    INSTANCE(c);
    return STATUS(instance_do(instance, EXIT, NULL));
}

fmi3Status fmi3Terminate(fmi3Instance c) {
    INSTANCE(c);
    return STATUS(instance_do(instance, TERMINATE, NULL));
}

fmi3Status fmi3Reset(fmi3Instance c) {
    INSTANCE(c);
    return STATUS(instance_reset(instance));
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime) {
    INSTANCE(c);
    GIVEN(1, eventHandlingNeeded, terminateSimulation);
    GIVEN(1, earlyReturn, lastSuccessfulTime);
    const double numbers[3] = {currentCommunicationPoint, communicationStepSize, 0.0};
    (void)noSetFMUStatePriorToCurrentPoint;
    fmi2Status status = instance_do(instance, STEP, numbers);
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = false;
    *lastSuccessfulTime = currentCommunicationPoint + (status <= fmi2Warning ? communicationStepSize : 0.0);
    return STATUS(status);
}

/* variables: none is an array */

#define SCALARS(count, values_count)                                                                   \
    if ((count) != (values_count))                                                                                 \
        return STATUS(instance_fail(instance, "%zu value references come with %zu values: every variable has one.", \
                                    (size_t)(count), (size_t)(values_count)))

#define GET_AND_SET(Type, KIND)                                                                                        \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3##Type values[], size_t n) { \
        INSTANCE(c);                                                                                                   \
        SCALARS(nvr, n);                                                                                           \
        return STATUS(instance_get(instance, KIND, vr, nvr, values));                                                  \
    }                                                                                                                  \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3##Type values[],     \
                             size_t n) {                                                                               \
        INSTANCE(c);                                                                                                   \
        SCALARS(nvr, n);                                                                                           \
        return STATUS(instance_set(instance, KIND, vr, nvr, values));                                                  \
    }

GET_AND_SET(Float64, REAL)
GET_AND_SET(Int32, INTEGER)
GET_AND_SET(String, STRING)

/* A truth is an int in an instance and in FMI 2.0, a byte in FMI 3.0. */

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3Boolean values[], size_t n) {
    INSTANCE(c);
    SCALARS(nvr, n);
    GIVEN(n, vr, values);
    fmi2Status status = fmi2OK;
    for (size_t i = 0; i < n && status == fmi2OK; i++) {
        fmi2Boolean truth = fmi2False;
        status = instance_get(instance, BOOLEAN, &vr[i], 1, &truth);
        values[i] = truth != fmi2False;
    }
    return STATUS(status);
}

fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3Boolean values[],
                          size_t n) {
    INSTANCE(c);
    SCALARS(nvr, n);
    GIVEN(n, vr, values);
    fmi2Boolean *truths = malloc((n + 1) * sizeof *truths);
    if (!truths) return STATUS(instance_fail(instance, "There is no memory for the values that are set."));
    for (size_t i = 0; i < n; i++) truths[i] = values[i] ? fmi2True : fmi2False;
    fmi2Status status = instance_set(instance, BOOLEAN, vr, nvr, truths);
    free(truths);
    return STATUS(status);
}

/* states */

#define OWN(state)                         \
    if (!instance_owns(instance, state)) \
        return STATUS(instance_fail(instance, "The FMU state is none of this instance's, or it has been freed."))

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    INSTANCE(c);
    GIVEN(1, state, state);
    return STATUS(instance_save(instance, (State **)state));
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    INSTANCE(c);
    OWN(state);
    return STATUS(instance_restore(instance, state));
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    INSTANCE(c);
    if (!state || !*state) return fmi3OK;
    OWN(*state);
    instance_forget(instance, *state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    INSTANCE(c);
    OWN(state);
    GIVEN(1, size, size);
    *size = state_size(state);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    INSTANCE(c);
    OWN(state);
    if (size < state_size(state))
        return STATUS(instance_fail(instance, "The FMU state has %zu bytes; there is room for %zu only.",
                                    state_size(state), size));
    GIVEN(size, bytes, bytes);
    state_write(state, (char *)bytes);
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    INSTANCE(c);
    GIVEN(size, bytes, bytes);
    GIVEN(1, state, state);
    State *read = instance_read(instance, (const char *)bytes, size);
    if (!read) return fmi3Error;
    *state = read;
    return fmi3OK;
}
