/* FMI 3.0 for co-simulation; what these models do without stands in unsupported3.c. */

#include "instance.h"

#include <stdlib.h>

#include "fmi3Functions.h"

static void report(Instance *it, Status status, const char *message)
{
    fmi3LogMessageCallback log = (fmi3LogMessageCallback)it->logger;
    if (log != NULL) log(it->environment, (fmi3Status)status, status >= ERROR ? "logStatusError" : "logAll", message);
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    return (void)c, (void)on, (void)n, (void)categories, fmi3OK;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean may_return_early,
                                         const fmi3ValueReference intermediate[], size_t n,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)resources, (void)visible, (void)logging, (void)intermediate;
    Instance *it = (n == 0 || LAYOUT.intermediate) && (LAYOUT.has_event_mode || !event_mode) ? create(name, token) : NULL;
    if (it == NULL) return NULL;
    it->update = LAYOUT.intermediate ? (void *)update : NULL;
    it->report = report;
    it->logger = (void *)log;
    it->environment = environment;
    it->event_mode = event_mode;
    it->may_return_early = may_return_early;
    return it;
}

void fmi3FreeInstance(fmi3Instance c) { discard(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    return (fmi3Status)enter_initialisation(c, start);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return (fmi3Status)exit_initialisation(c); }
fmi3Status fmi3Terminate(fmi3Instance c) { return (fmi3Status)terminate(c); }

fmi3Status fmi3Reset(fmi3Instance c)
{
    reset(c);
    return fmi3OK;
}

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    Instance *it = c;
    if (!it->event_mode || it->head->phase != STEPPING)
        return (fmi3Status)say(it, ERROR, "Event mode was entered in phase %d, not from step mode.", it->head->phase);
    it->head->phase = EVENTS;
    return fmi3OK;
}

fmi3Status fmi3EnterStepMode(fmi3Instance c)
{
    Instance *it = c;
    if (it->head->phase != EVENTS)
        return (fmi3Status)say(it, ERROR, "Step mode was entered in phase %d, not from event mode.", it->head->phase);
    if (it->head->event_pending) return (fmi3Status)say(it, ERROR, "Step mode was entered before the event was handled.");
    it->head->phase = STEPPING;
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals,
                                    fmi3Boolean *values, fmi3Boolean *has_next, fmi3Float64 *next)
{
    Instance *it = c;
    if (it->head->phase != EVENTS) return (fmi3Status)say(it, ERROR, "Discrete states change in event mode only.");
    *again = *end = *nominals = false;
    *values = it->head->event_pending;
    if (it->head->event_pending) model_event((State *)it->head);
    it->head->event_pending = 0;
    it->stale = 1;
    *next = model_next_event((State *)it->head);
    *has_next = !isnan(*next);
    return fmi3OK;
}

/* With event mode, inputs that are not continuous are set in it only. */
static Status check_mode(Instance *it)
{
    if (!it->event_mode || it->head->phase != STEPPING) return OK;
    return say(it, ERROR, "A discrete input was set outside of event mode.");
}

/* Of an array the elements follow one another, from the value reference on. */
static size_t size_of(unsigned ref) { return ref < LAYOUT.n_numbers ? LAYOUT.size[ref] : 1; }

static Status check_count(Instance *it, const unsigned *refs, size_t n, size_t m)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) count += size_of(refs[i]);
    return count == m ? OK : say(it, ERROR, "The variables have %zu values, not %zu.", count, m);
}

#define NUMBER(Type, kind)                                                                                           \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3##Type value[], size_t m)  \
    {                                                                                                                \
        Status status = check_count(c, vr, n, m);                                                                    \
        for (size_t i = 0, k = 0; i < n && status == OK; i++)                                                        \
            for (unsigned at = vr[i]; at < vr[i] + size_of(vr[i]) && status == OK; at++) {                           \
                double number = 0.0;                                                                                 \
                status = get_numbers(c, kind, &at, 1, &number);                                                      \
                value[k++] = (fmi3##Type)number;                                                                     \
            }                                                                                                        \
        return (fmi3Status)status;                                                                                   \
    }                                                                                                                \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3##Type value[],      \
                             size_t m)                                                                               \
    {                                                                                                                \
        Status status = check_count(c, vr, n, m);                                                                    \
        if (status == OK && kind != 'R') status = check_mode(c);                                                     \
        for (size_t i = 0, k = 0; i < n && status == OK; i++)                                                        \
            for (unsigned at = vr[i]; at < vr[i] + size_of(vr[i]) && status == OK; at++) {                           \
                double number = value[k++];                                                                          \
                status = set_numbers(c, kind, &at, 1, &number);                                                      \
            }                                                                                                        \
        return (fmi3Status)status;                                                                                   \
    }

NUMBER(Float64, 'R')
NUMBER(Float32, 'R') /* for descriptions that call a Real so */
NUMBER(Int32, 'I')
NUMBER(Boolean, 'B')

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3String value[], size_t m)
{
    return m == n ? (fmi3Status)get_texts(c, vr, n, value) : fmi3Error;
}

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3String value[], size_t m)
{
    return m == n && check_mode(c) == OK ? (fmi3Status)set_texts(c, vr, n, value) : fmi3Error;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) { return (fmi3Status)save(c, state); }
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { return (fmi3Status)restore(c, state); }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) { return (fmi3Status)release(c, state); }

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    return (fmi3Status)state_size(c, state, size);
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    return (fmi3Status)pack(c, state, bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    return (fmi3Status)unpack(c, bytes, size, state);
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t n,
                                        const fmi3ValueReference knowns[], size_t m, const fmi3Float64 seed[],
                                        size_t n_seed, fmi3Float64 out[], size_t n_out)
{
    return n_seed == m && n_out == n ? (fmi3Status)partials(c, unknowns, n, knowns, m, seed, out) : fmi3Error;
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t m)
{
    return m == n ? (fmi3Status)get_output_slopes(c, vr, n, orders, values) : fmi3Error;
}

/* Asks for the inputs at the start, in the middle and at the end of a step: a parabola, as with derivatives in FMI 2. */
static void ask_for_inputs(Instance *it, double time, double h)
{
    enum { MOST = 8 };
    unsigned n = LAYOUT.slopes_per_order - 1;
    double *inputs = (double *)((char *)it->head + LAYOUT.value) + LAYOUT.first_input, value[3][MOST];
    double *first = (double *)((char *)it->head + LAYOUT.slope), *second = first + LAYOUT.slopes_per_order;
    if (n > MOST) abort();
    for (int k = 0; k < 3; k++) {
        fmi3Boolean early = false;
        fmi3Float64 early_time = 0.0;
        ((fmi3IntermediateUpdateCallback)it->update)(it->environment, time + 0.5 * k * h, true, false, false, false, &early,
                                                     &early_time);
        memcpy(value[k], inputs, n * sizeof(double));
    }
    for (unsigned i = 0; i < n; i++) {
        inputs[i] = value[0][i];
        first[i] = (4.0 * value[1][i] - 3.0 * value[0][i] - value[2][i]) / h;
        second[i] = 4.0 * (value[0][i] - 2.0 * value[1][i] + value[2][i]) / (h * h);
    }
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 h, fmi3Boolean no_rollback, fmi3Boolean *event,
                      fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *reached)
{
    (void)no_rollback;
    Instance *it = c;
    if (it->update != NULL) ask_for_inputs(it, time, h);
    Status status = step(it, time, h);
    *event = it->last.event;
    *end = it->last.terminate;
    *reached = it->last.reached;
    *early = status == OK && is_short(it, time, h);
    return (fmi3Status)status;
}
