/* The functions of FMI 3.0 for co-simulation: each passes the call on to its instance. fmi3_absent.c has those that this
   FMU does not offer. */

#include "fmi3Functions.h"

#include <math.h>
#include <stdlib.h>

#include "instance.h"
#include "log.h"

#define INSTANCE(component)         \
    Instance *instance = component; \
    if (!instance) return fmi3Error

/* A host that gives NULL for an array that is not empty, or for a place where to write gets an error. */
#define GIVEN(call, count, first, second) \
    if (instance_check_arrays(instance, call, count, first, second) != OK) return fmi3Error

const char *fmi3GetVersion(void) { return fmi3Version; }

/* life */

static void deliver(const Host *host, const char *name, Status status, const char *category, const char *message) {
    (void)name;
    ((fmi3LogMessageCallback)host->logger)(host->environment, (fmi3Status)status, category, message);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[]) {
    INSTANCE(c);
    GIVEN("SetDebugLogging", nCategories, categories, categories);
    log_choose(instance, loggingOn, nCategories, categories);
    return fmi3OK;
}

static fmi3Instance refused(const Host *host, const char *why) {
    if (host->logger) deliver(host, "", ERROR, MODEL_CATEGORIES[OF_ERRORS], why);
    return NULL;
}

static Host host_of(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
    const Host host = {"fmi3", "EnterInitializationMode", deliver, (void (*)(void))log, environment, calloc, free};
    return host;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
                                         fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
                                         fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate) {
    (void)resourcePath, (void)visible, (void)requiredIntermediateVariables, (void)nRequiredIntermediateVariables;
    const Host host = host_of(instanceEnvironment, logMessage);
    if (eventModeUsed) return refused(&host, "This FMU has no events: instantiate it without event mode.");
    Instance *it = instance_new(&host, instanceName, instantiationToken, loggingOn);
    if (!it) return NULL;
    it->update = (void (*)(void))intermediateUpdate;
    it->returns_early = earlyReturnAllowed;
    return it;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage) {
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    const Host host = host_of(instanceEnvironment, logMessage);
    return refused(&host, "This FMU is for co-simulation; model exchange is not supported.");
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                               fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption) {
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    (void)clockUpdate, (void)lockPreemption, (void)unlockPreemption;
    const Host host = host_of(instanceEnvironment, logMessage);
    return refused(&host, "This FMU is for co-simulation; scheduled execution is not supported.");
}

void fmi3FreeInstance(fmi3Instance c) {
    if (c) instance_free(c);
}

#define PLAIN(Name, call)                       \
    fmi3Status fmi3##Name(fmi3Instance c) {     \
        INSTANCE(c);                            \
        return (fmi3Status)call;                \
    }

PLAIN(EnterConfigurationMode, instance_configure(instance, 1))
PLAIN(ExitConfigurationMode, instance_configure(instance, 0))
PLAIN(ExitInitializationMode, instance_exit(instance))
PLAIN(Terminate, instance_terminate(instance))
PLAIN(Reset, instance_reset(instance))

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
    INSTANCE(c);
    (void)toleranceDefined, (void)tolerance;
    Status status = instance_set_up(instance, startTime, stopTimeDefined ? stopTime : (double)NAN);
    return (fmi3Status)(status == OK ? instance_enter(instance) : ERROR);
}

/* variables: either all of a call are set or none */

#define COUNTS(count, values) \
    if ((count) != (values)) return (fmi3Status)log_error(instance, "As many values as value references must be given.")

#define GET_AND_SET(Type, KIND, TO_TYPE)                                                                        \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3##Type value[],     \
                             size_t nValues) {                                                                  \
        INSTANCE(c);                                                                                            \
        COUNTS(nvr, nValues);                                                                                   \
        GIVEN("Get" #Type, nvr, vr, value);                                                                     \
        for (size_t i = 0; i < nvr; i++) {                                                                      \
            double found;                                                                                       \
            if (instance_get(instance, KIND, vr[i], &found) != OK) return fmi3Error;                            \
            value[i] = TO_TYPE(found);                                                                          \
        }                                                                                                       \
        return fmi3OK;                                                                                          \
    }                                                                                                           \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3##Type value[], \
                             size_t nValues) {                                                                  \
        INSTANCE(c);                                                                                            \
        COUNTS(nvr, nValues);                                                                                   \
        GIVEN("Set" #Type, nvr, vr, value);                                                                     \
        for (size_t i = 0; i < nvr; i++)                                                                        \
            if (instance_check(instance, KIND, vr[i], value[i]) != OK) return fmi3Error;                        \
        for (size_t i = 0; i < nvr; i++) instance_store(instance, vr[i], value[i]);                             \
        return fmi3OK;                                                                                          \
    }

#define SAME(value) (value)
#define TRUTH(value) ((value) != 0.0)
GET_AND_SET(Float64, REAL, SAME)
GET_AND_SET(Int32, INTEGER, instance_integer)
GET_AND_SET(Boolean, BOOLEAN, TRUTH)

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3String value[], size_t nValues) {
    INSTANCE(c);
    COUNTS(nvr, nValues);
    GIVEN("GetString", nvr, vr, value);
    for (size_t i = 0; i < nvr; i++)
        if (instance_get_text(instance, vr[i], &value[i]) != OK) return fmi3Error;
    return fmi3OK;
}

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3String value[],
                         size_t nValues) {
    INSTANCE(c);
    COUNTS(nvr, nValues);
    GIVEN("SetString", nvr, vr, value);
    for (size_t i = 0; i < nvr; i++)
        if (instance_check_text(instance, vr[i], value[i]) != OK) return fmi3Error;
    return fmi3OK;
}

/* Outputs depend on all inputs in initialisation mode; afterwards on none, before the next step. */

static Status count_dependencies(Instance *it, fmi3ValueReference reference, size_t *count) {
    if (reference >= MODEL_VARIABLES_COUNT)
        return log_error(it, "There is no variable with value reference %lu.", (unsigned long)reference);
    Role role = MODEL_VARIABLES[reference].role;
    int depends = role != INPUT && role != FIXED && role != TIME && it->now.phase < STEPPING;
    *count = depends ? INPUTS : 0;
    return OK;
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference valueReference,
                                               size_t *nDependencies) {
    INSTANCE(c);
    GIVEN("GetNumberOfVariableDependencies", 1, nDependencies, nDependencies);
    return (fmi3Status)count_dependencies(instance, valueReference, nDependencies);
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
                                       fmi3ValueReference independents[], size_t elementIndicesOfIndependents[],
                                       fmi3DependencyKind dependencyKinds[], size_t nDependencies) {
    INSTANCE(c);
    size_t count = 0, k = 0;
    if (count_dependencies(instance, dependent, &count) != OK) return fmi3Error;
    if (nDependencies != count)
        return (fmi3Status)log_error(instance, "The variable has %lu dependencies, not %lu.", (unsigned long)count,
                                     (unsigned long)nDependencies);
    GIVEN("GetVariableDependencies", count, elementIndicesOfDependent, elementIndicesOfIndependents);
    GIVEN("GetVariableDependencies", count, independents, dependencyKinds);
    for (uint32_t i = 0; k < count; i++) {
        if (MODEL_VARIABLES[i].role != INPUT) continue;
        elementIndicesOfDependent[k] = elementIndicesOfIndependents[k] = 0; /* all of them are scalars */
        independents[k] = i;
        dependencyKinds[k++] = fmi3Dependent;
    }
    return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                        const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                        size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity) {
    INSTANCE(c);
    COUNTS(nKnowns, nSeed);
    COUNTS(nUnknowns, nSensitivity);
    GIVEN("GetDirectionalDerivative", nUnknowns, unknowns, sensitivity);
    GIVEN("GetDirectionalDerivative", nKnowns, knowns, seed);
    return (fmi3Status)instance_forward(instance, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                    size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity) {
    INSTANCE(c);
    COUNTS(nUnknowns, nSeed);
    COUNTS(nKnowns, nSensitivity);
    GIVEN("GetAdjointDerivative", nUnknowns, unknowns, seed);
    GIVEN("GetAdjointDerivative", nKnowns, knowns, sensitivity);
    return (fmi3Status)instance_backward(instance, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity);
}

/* states */

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    INSTANCE(c);
    GIVEN("GetFMUState", 1, state, state);
    return (fmi3Status)instance_save(instance, state);
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    INSTANCE(c);
    return (fmi3Status)instance_restore(instance, state);
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    INSTANCE(c);
    return (fmi3Status)instance_forget(instance, state);
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    INSTANCE(c);
    GIVEN("SerializedFMUStateSize", 1, size, size);
    return (fmi3Status)instance_size(instance, state, size);
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    INSTANCE(c);
    GIVEN("SerializeFMUState", size, bytes, bytes);
    return (fmi3Status)instance_write(instance, state, bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    INSTANCE(c);
    GIVEN("DeserializeFMUState", size, bytes, bytes);
    GIVEN("DeserializeFMUState", 1, state, state);
    return (fmi3Status)instance_read(instance, bytes, size, state);
}

/* co-simulation */

typedef struct {
    int requested;
    double time;
} Early;

/* Let the host read variables, and return when it wants the step to end. */
static Early ask(Instance *it, double time, int finished) {
    fmi3Boolean requested = false;
    fmi3Float64 early = time;
    it->asking = 1;
    ((fmi3IntermediateUpdateCallback)it->update)(it->host.environment, time, false, true, finished != 0,
                                                 !finished && it->returns_early, &requested, &early);
    it->asking = 0;
    const Early answer = {requested && !finished && it->returns_early, early};
    return answer;
}

/* The model takes a step in one part. So the host is asked before it, when the step can still be made shorter, and
   informed after it. */
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime) {
    INSTANCE(c);
    (void)noSetFMUStatePriorToCurrentPoint;
    double time = currentCommunicationPoint, size = communicationStepSize;
    GIVEN("DoStep", 1, eventHandlingNeeded, terminateSimulation);
    GIVEN("DoStep", 1, earlyReturn, lastSuccessfulTime);
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = false;
    *lastSuccessfulTime = instance->now.time;
    if (instance_check_step(instance, time, size) != OK) return fmi3Error;
    if (instance->update && instance->returns_early && size > 0.0) {
        Early early = ask(instance, time, 0);
        *earlyReturn = early.requested && early.time < time + size;
        if (*earlyReturn && early.time <= time) return fmi3OK; /* before the step began */
        if (*earlyReturn) size = early.time - time;
    }
    Status status = instance_step(instance, time, size);
    *lastSuccessfulTime = instance->now.time;
    if (instance->update) ask(instance, instance->now.time, 1);
    return (fmi3Status)status;
}
