/* FMI 2.0 for co-simulation. */

#include "instance.h"

#include "fmi2Functions.h"

static void report(Instance *it, Status status, const char *message)
{
    fmi2CallbackLogger log = (fmi2CallbackLogger)it->logger;
    if (log != NULL) log(it->environment, it->name, (fmi2Status)status, status >= ERROR ? "logStatusError" : "logAll", message);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    return (void)c, (void)on, (void)n, (void)categories, fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    Instance *it = type == fmi2CoSimulation ? create(name, guid) : NULL;
    if (it == NULL) return NULL;
    it->report = report;
    it->may_return_early = 1;
    it->logger = functions == NULL ? NULL : (void *)functions->logger;
    it->environment = functions == NULL ? NULL : functions->componentEnvironment;
    return it;
}

void fmi2FreeInstance(fmi2Component c) { discard(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop)
{
    (void)has_tolerance, (void)tolerance;
    Instance *it = c;
    it->start_time = start;
    it->stop_time = has_stop ? stop : INFINITY;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return (fmi2Status)enter_initialisation(c, ((Instance *)c)->start_time);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return (fmi2Status)exit_initialisation(c); }
fmi2Status fmi2Terminate(fmi2Component c) { return (fmi2Status)terminate(c); }

fmi2Status fmi2Reset(fmi2Component c)
{
    reset(c);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[])
{
    return (fmi2Status)get_numbers(c, 'R', vr, n, value);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[])
{
    return (fmi2Status)set_numbers(c, 'R', vr, n, value);
}

#define INTEGRAL(Type, kind)                                                                                         \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2##Type value[])           \
    {                                                                                                                \
        Status status = OK;                                                                                          \
        for (size_t i = 0; i < n && status == OK; i++) {                                                             \
            double number = 0.0;                                                                                     \
            status = get_numbers(c, kind, vr + i, 1, &number);                                                       \
            value[i] = (fmi2##Type)number;                                                                           \
        }                                                                                                            \
        return (fmi2Status)status;                                                                                   \
    }                                                                                                                \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2##Type value[])     \
    {                                                                                                                \
        Status status = OK;                                                                                          \
        for (size_t i = 0; i < n && status == OK; i++) {                                                             \
            double number = value[i];                                                                                \
            status = set_numbers(c, kind, vr + i, 1, &number);                                                       \
        }                                                                                                            \
        return (fmi2Status)status;                                                                                   \
    }

INTEGRAL(Integer, 'I')
INTEGRAL(Boolean, 'B')

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[])
{
    return (fmi2Status)get_texts(c, vr, n, value);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[])
{
    return (fmi2Status)set_texts(c, vr, n, value);
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) { return (fmi2Status)save(c, state); }
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { return (fmi2Status)restore(c, state); }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) { return (fmi2Status)release(c, state); }

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    return (fmi2Status)state_size(c, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    return (fmi2Status)pack(c, state, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    return (fmi2Status)unpack(c, bytes, size, state);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n,
                                        const fmi2ValueReference knowns[], size_t m, const fmi2Real seed[],
                                        fmi2Real out[])
{
    return (fmi2Status)partials(c, unknowns, n, knowns, m, seed, out);
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    return (fmi2Status)set_input_slopes(c, vr, n, order, value);
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[])
{
    return (fmi2Status)get_output_slopes(c, vr, n, order, value);
}

/* A step that ends early, or ends the simulation, is a discarded one: the master asks how far it came. */
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real h, fmi2Boolean no_rollback)
{
    (void)no_rollback;
    Instance *it = c;
    Status status = step(it, time, h);
    return status == OK && (it->last.terminate || is_short(it, time, h)) ? fmi2Discard : (fmi2Status)status;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return (fmi2Status)say(c, ERROR, "No step runs in the background."); }

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = ((Instance *)c)->last.reached;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = ((Instance *)c)->last.terminate;
    return fmi2OK;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    return (void)c, (void)kind, (void)value, fmi2Discard;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    return (void)c, (void)kind, (void)value, fmi2Discard;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    return (void)c, (void)kind, (void)value, fmi2Discard;
}
