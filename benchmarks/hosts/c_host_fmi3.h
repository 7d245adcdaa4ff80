/* FMUs of FMI 3.0 behind the functions of FMI 2.0 that the commands of c_host.c call.
 *
 * A component is a Component3, kept after `free`, so that a script can do what a careless host does. Integers are those
 * of Int32. Neither events nor intermediate updates: the FMU handles both within its steps.
 */
#include <stdbool.h>

#include "fmi3FunctionTypes.h"

#define FUNCTIONS3(X) \
    X(InstantiateCoSimulation) X(FreeInstance) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate) \
    X(Reset) X(DoStep) X(GetDirectionalDerivative) X(SetFloat64) X(SetInt32) X(SetBoolean) X(SetString) X(GetFloat64) \
    X(GetInt32) X(GetBoolean) X(GetString) X(GetFMUState) X(SetFMUState) X(FreeFMUState) X(SerializedFMUStateSize) \
    X(SerializeFMUState) X(DeserializeFMUState)

#define MEMBER3(name) fmi3##name##TYPE *name;
typedef struct {
    FUNCTIONS3(MEMBER3)
} Functions3;

typedef struct {
    const Functions3 *call;
    fmi3Instance instance;
    double start, stop;
    int has_stop, terminated;
} Component3;

#define AT(c) const Functions3 *call = ((Component3 *)c)->call; fmi3Instance instance = ((Component3 *)c)->instance

static void logger3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    logger(environment, "", (fmi2Status)status, category, "%s", message ? message : "");
}

static fmi2Component instantiate3(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                  const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    const Functions3 *call = ((Instance *)callbacks->componentEnvironment)->fmu->version3;
    fmi3Instance instance = call->InstantiateCoSimulation(name, token, resources, visible, logging, false, false, NULL,
                                                          0, callbacks->componentEnvironment, logger3, NULL);
    Component3 *component = instance ? calloc(1, sizeof *component) : NULL;
    if (component) {
        component->call = call;
        component->instance = instance;
    }
    return component;
}

static void free3(fmi2Component c)
{
    AT(c);
    call->FreeInstance(instance);
}

static fmi2Status setup3(fmi2Component c, fmi2Boolean given, fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop,
                         fmi2Real stop)
{
    Component3 *component = c;
    component->start = start;
    component->stop = stop;
    component->has_stop = has_stop;
    return fmi2OK;
}

static fmi2Status enter3(fmi2Component c)
{
    AT(c);
    const Component3 *own = c;
    return (fmi2Status)call->EnterInitializationMode(instance, false, 0.0, own->start, own->has_stop, own->stop);
}

#define PLAIN3(name, function) \
    static fmi2Status name(fmi2Component c) \
    { \
        AT(c); \
        return (fmi2Status)call->function(instance); \
    }
PLAIN3(exit3, ExitInitializationMode)
PLAIN3(terminate3, Terminate)
PLAIN3(reset3, Reset)

static fmi2Status step3(fmi2Component c, fmi2Real time, fmi2Real size, fmi2Boolean no_return)
{
    AT(c);
    bool event = false, terminate = false, early = false;
    double reached = time;
    int status = call->DoStep(instance, time, size, no_return, &event, &terminate, &early, &reached);
    ((Component3 *)c)->terminated = terminate;
    return (fmi2Status)status;
}

static fmi2Status status3(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    *value = ((Component3 *)c)->terminated;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}

static fmi2Status derivative3(fmi2Component c, const fmi2ValueReference *unknown, size_t n,
                              const fmi2ValueReference *known, size_t m, const fmi2Real *seed, fmi2Real *value)
{
    AT(c);
    return (fmi2Status)call->GetDirectionalDerivative(instance, unknown, n, known, m, seed, m, value, n);
}

#define VALUES3(name, function, Type) \
    static fmi2Status name(fmi2Component c, const fmi2ValueReference *references, size_t n, Type *values) \
    { \
        AT(c); \
        return (fmi2Status)call->function(instance, references, n, values, n); \
    }
VALUES3(set_real3, SetFloat64, const fmi2Real)
VALUES3(set_integer3, SetInt32, const fmi2Integer)
VALUES3(set_string3, SetString, const fmi2String)
VALUES3(get_real3, GetFloat64, fmi2Real)
VALUES3(get_integer3, GetInt32, fmi2Integer)
VALUES3(get_string3, GetString, fmi2String)

static fmi2Status set_boolean3(fmi2Component c, const fmi2ValueReference *references, size_t n,
                               const fmi2Boolean *values)
{
    AT(c);
    bool converted[FIELDS];
    for (size_t i = 0; i < n; i++)
        converted[i] = values[i];
    return (fmi2Status)call->SetBoolean(instance, references, n, converted, n);
}

static fmi2Status get_boolean3(fmi2Component c, const fmi2ValueReference *references, size_t n, fmi2Boolean *values)
{
    AT(c);
    bool found[FIELDS] = {false};
    int status = call->GetBoolean(instance, references, n, found, n);
    for (size_t i = 0; i < n; i++)
        values[i] = found[i];
    return (fmi2Status)status;
}

static fmi2Status save3(fmi2Component c, fmi2FMUstate *state)
{
    AT(c);
    return (fmi2Status)call->GetFMUState(instance, state);
}

static fmi2Status restore3(fmi2Component c, fmi2FMUstate state)
{
    AT(c);
    return (fmi2Status)call->SetFMUState(instance, state);
}

static fmi2Status free_state3(fmi2Component c, fmi2FMUstate *state)
{
    AT(c);
    return (fmi2Status)call->FreeFMUState(instance, state);
}

static fmi2Status size3(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    AT(c);
    return (fmi2Status)call->SerializedFMUStateSize(instance, state, size);
}

static fmi2Status serialize3(fmi2Component c, fmi2FMUstate state, fmi2Byte *data, size_t size)
{
    AT(c);
    return (fmi2Status)call->SerializeFMUState(instance, state, (fmi3Byte *)data, size);
}

static fmi2Status deserialize3(fmi2Component c, const fmi2Byte *data, size_t size, fmi2FMUstate *state)
{
    AT(c);
    return (fmi2Status)call->DeserializeFMUState(instance, (const fmi3Byte *)data, size, state);
}

/* Resolve the functions of a library that is open. */
static int open3(Fmu *fmu)
{
    static Functions3 found[FMUS];
    Functions3 *call = &found[fmu - fmus];
#define RESOLVE3(name) \
    if (!(*(void **)&call->name = dlsym(fmu->library, "fmi3" #name))) { \
        printf("log\t-1\t3\tdlsym\tfmi3" #name "\n"); \
        return NONE; \
    }
    FUNCTIONS3(RESOLVE3)
    fmu->version3 = call;
    fmu->Instantiate = instantiate3;
    fmu->FreeInstance = free3;
    fmu->SetupExperiment = setup3;
    fmu->EnterInitializationMode = enter3;
    fmu->ExitInitializationMode = exit3;
    fmu->Terminate = terminate3;
    fmu->Reset = reset3;
    fmu->DoStep = step3;
    fmu->GetBooleanStatus = status3;
    fmu->GetDirectionalDerivative = derivative3;
    fmu->SetReal = set_real3;
    fmu->SetInteger = set_integer3;
    fmu->SetBoolean = set_boolean3;
    fmu->SetString = set_string3;
    fmu->GetReal = get_real3;
    fmu->GetInteger = get_integer3;
    fmu->GetBoolean = get_boolean3;
    fmu->GetString = get_string3;
    fmu->GetFMUstate = save3;
    fmu->SetFMUstate = restore3;
    fmu->FreeFMUstate = free_state3;
    fmu->SerializedFMUstateSize = size3;
    fmu->SerializeFMUstate = serialize3;
    fmu->DeSerializeFMUstate = deserialize3;
    return fmi2OK;
}
