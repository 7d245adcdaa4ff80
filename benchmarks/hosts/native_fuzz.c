/* Drives an FMI 2 and an FMI 3 instance of one contact by the same random calls, allowed or not, and compares every
   answer. Linked with all sources of both.

       native_fuzz random SEQUENCES SEED     prints a digest of all answers
       native_fuzz crowd INSTANCES           prints kilobytes of resident memory for each instance after its first step

   Exit status 1, with a message, if answers differ, a value read is not finite, memory is allocated between
   instantiation and the end (but for more saved states than an instance has room for), or memory is lost. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "fmi3Functions.h"
#include "instance.h"

static long allocations, alive; /* calls; blocks that were not freed */

#ifdef COUNT_ALLOCATIONS
/* Every allocation of the process, those of the C library included. */
extern void *__libc_malloc(size_t size), *__libc_calloc(size_t count, size_t size), *__libc_realloc(void *at, size_t size);
extern void __libc_free(void *at);
void *malloc(size_t size) { return allocations++, alive++, __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return allocations++, alive++, __libc_calloc(count, size); }
void *realloc(void *at, size_t size) { return allocations++, alive += !at, __libc_realloc(at, size); }
void free(void *at) { alive -= at != NULL, __libc_free(at); }
#endif

static void fail(const char *what, long sequence)
{
    printf("sequence %ld: %s\n", sequence, what);
    exit(1);
}

/* The host's own memory, which the FMU promises to leave alone. */

static void *allocate(size_t count, size_t size)
{
    (void)count, (void)size;
    fail("the host's memory was asked for", 0);
    return NULL;
}

static void release(void *block)
{
    (void)block;
    fail("the host's memory was freed", 0);
}

/* random numbers: xorshift64* */

static uint64_t seed;

static uint64_t next(void)
{
    seed ^= seed >> 12, seed ^= seed << 25, seed ^= seed >> 27;
    return seed * 0x2545f4914f6cdd1du;
}

static unsigned below(unsigned n) { return (unsigned)(next() >> 33) % n; }
static int chance(unsigned one_in) { return below(one_in) == 0; }
static double fraction(void) { return (double)(next() >> 11) / 9007199254740992.0; }

/* digest of all answers: FNV-1a */

static uint64_t digest = 0xcbf29ce484222325u;

static void add(const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) digest = (digest ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
}

/* the pair of instances */

enum { HANDLES = 12, BYTES = 65536 };

static fmi2Component two;
static fmi3Instance three;
static long sequence, messages_2, messages_3;
static void *handle_2[HANDLES], *handle_3[HANDLES];
static int plan; /* answer to the intermediate update: 0 go on, 1 return at `early` */
static double early;

static void log_2(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                  fmi2String message, ...)
{
    (void)environment, (void)name, (void)category;
    if (status == fmi2OK && message[0] == 0) fail("an empty message", sequence);
    messages_2++;
}

static void log_3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment, (void)category, (void)message, (void)status;
    messages_3++;
}

static void update(fmi3InstanceEnvironment environment, fmi3Float64 time, fmi3Boolean set, fmi3Boolean get,
                   fmi3Boolean finished, fmi3Boolean may_return, fmi3Boolean *requested, fmi3Float64 *when)
{
    const fmi3ValueReference load = 0;
    double value = 1.0;
    long before = messages_3;
    (void)environment, (void)time;
    if (set || !get || may_return == finished) fail("wrong flags of the intermediate update", sequence);
    if (fmi3GetFloat64(three, &load, 1, &value, 1) != fmi3OK) fail("no reading in the intermediate update", sequence);
    if (fmi3SetFloat64(three, &load, 1, &value, 1) != fmi3Error) fail("set in the intermediate update", sequence);
    if (fmi3Reset(three) != fmi3Error) fail("reset in the intermediate update", sequence);
    messages_3 = before; /* FMI 2 has none of these */
    *requested = plan;
    *when = early;
}

static void same(int status_2, int status_3)
{
    add(&status_2, sizeof status_2);
    if (status_2 != status_3) fail("FMI 2 and FMI 3 return another status", sequence);
    if (messages_2 != messages_3) fail("FMI 2 and FMI 3 log another number of messages", sequence);
}

static const fmi2CallbackFunctions CALLBACKS = {log_2, allocate, release, NULL, NULL};

static void create(void)
{
    two = fmi2Instantiate("two", fmi2CoSimulation, MODEL_TOKEN, "", &CALLBACKS, 0, chance(2));
    three = fmi3InstantiateCoSimulation("three", MODEL_TOKEN, "", false, ((Instance *)two)->logging == LOUD, false, true,
                                        NULL, 0, NULL, log_3, update);
    if (!two || !three) fail("no instance", sequence);
}

/* variables */

static uint32_t reference(void)
{
    if (chance(30)) return (uint32_t)next();
    return chance(2) ? below(INPUTS) : below((unsigned)MODEL_VARIABLES_COUNT);
}

static double number(uint32_t of)
{
    static const double odd[] = {0.0, -0.0, NAN, INFINITY, -INFINITY, 1e308, 1e-310, -1.0, 99.0, 1e99};
    if (chance(12)) return odd[below(sizeof odd / sizeof *odd)];
    if (chance(12) && of < INPUTS) return 40.0 * MODEL_VARIABLES[of].start;
    if (of >= INPUTS) return of < MODEL_VARIABLES_COUNT ? MODEL_VARIABLES[of].start : 1.0;
    return MODEL_VARIABLES[of].start * (0.5 + fraction());
}

static void get(void)
{
    enum { MANY = 5 };
    uint32_t vr[MANY];
    double real_2[MANY] = {0}, real_3[MANY] = {0};
    size_t n = below(MANY) + 1;
    for (size_t i = 0; i < n; i++) vr[i] = reference();
    int status = fmi2GetReal(two, vr, n, real_2);
    same(status, fmi3GetFloat64(three, vr, n, real_3, n));
    if (status == fmi2OK && memcmp(real_2, real_3, sizeof real_2) != 0) fail("FMI 2 and FMI 3 differ in bits", sequence);
    for (size_t i = 0; i < n && status == fmi2OK; i++)
        if (MODEL_VARIABLES[vr[i]].role != INPUT && !isfinite(real_2[i])) fail("a value is not finite", sequence);
    add(real_2, sizeof real_2);
    fmi2Integer whole_2 = 0, truth_2 = 0;
    fmi3Int32 whole_3 = 0;
    fmi3Boolean truth_3 = false;
    fmi2String text_2 = "";
    fmi3String text_3 = "";
    vr[0] = below((unsigned)MODEL_VARIABLES_COUNT);
    same(fmi2GetInteger(two, vr, 1, &whole_2), fmi3GetInt32(three, vr, 1, &whole_3, 1));
    same(fmi2GetBoolean(two, vr, 1, &truth_2), fmi3GetBoolean(three, vr, 1, &truth_3, 1));
    same(fmi2GetString(two, vr, 1, &text_2), fmi3GetString(three, vr, 1, &text_3, 1));
    if (whole_2 != whole_3 || truth_2 != truth_3 || strcmp(text_2, text_3) != 0) fail("FMI 2 and FMI 3 differ", sequence);
    add(&whole_2, sizeof whole_2);
}

static void set(void)
{
    enum { MANY = 3 };
    uint32_t vr[MANY];
    double value[MANY];
    size_t n = below(MANY) + 1;
    for (size_t i = 0; i < n; i++) {
        vr[i] = chance(8) ? reference() : below(INPUTS);
        value[i] = number(vr[i]);
    }
    same(fmi2SetReal(two, vr, n, value), fmi3SetFloat64(three, vr, n, value, n));
}

static void set_others(void)
{
    uint32_t vr = reference();
    int32_t whole = vr < MODEL_VARIABLES_COUNT && chance(2) ? (int32_t)MODEL_VARIABLES[vr].start : (int32_t)below(5);
    const char *text = chance(2) ? "" : "a%sb";
    const bool truth = whole != 0;
    same(fmi2SetInteger(two, &vr, 1, &whole), fmi3SetInt32(three, &vr, 1, &whole, 1));
    same(fmi2SetBoolean(two, &vr, 1, &whole), fmi3SetBoolean(three, &vr, 1, &truth, 1));
    same(fmi2SetString(two, &vr, 1, &text), fmi3SetString(three, &vr, 1, &text, 1));
}

static uint32_t output(void)
{
    uint32_t first = 0; /* friction_force */
    while (MODEL_VARIABLES[first].role != OUTPUT) first++;
    return chance(3) ? first : first + below((unsigned)MODEL_VARIABLES_COUNT - 1 - first);
}

/* Rows of the matrix are those of the columns, bit for bit. */
static void compare_adjoint(uint32_t unknown, const uint32_t known[], size_t m)
{
    const double one = 1.0;
    double row[9], entry;
    if (fmi3GetAdjointDerivative(three, &unknown, 1, known, m, &one, 1, row, m) != fmi3OK) return;
    for (size_t j = 0; j < m; j++)
        if (fmi3GetDirectionalDerivative(three, &unknown, 1, &known[j], 1, &one, 1, &entry, 1) != fmi3OK ||
            entry != row[j])
            fail("the adjoint derivative is another one", sequence);
}

static void derive(void)
{
    enum { MANY = 3 };
    uint32_t unknown[MANY], known[MANY];
    double seeds[MANY], out_2[MANY] = {0}, out_3[MANY] = {0};
    size_t n = below(MANY) + 1, m = below(MANY) + 1;
    for (size_t i = 0; i < MANY; i++) {
        unknown[i] = chance(20) ? reference() : output();
        known[i] = chance(20) ? reference() : below(chance(2) ? 4 : INPUTS);
        seeds[i] = 2.0 * fraction() - 1.0;
    }
    int status = fmi2GetDirectionalDerivative(two, unknown, n, known, m, seeds, out_2);
    same(status, fmi3GetDirectionalDerivative(three, unknown, n, known, m, seeds, m, out_3, n));
    add(out_2, sizeof out_2);
    if (memcmp(out_2, out_3, sizeof out_2) != 0) fail("FMI 2 and FMI 3 differ in derivatives", sequence);
    for (size_t i = 0; i < n; i++)
        if (!isfinite(out_2[i])) fail("a derivative is not finite", sequence);
    if (status == fmi2OK) compare_adjoint(unknown[0], known, m);
}

/* phases and steps */

static void begin(void)
{
    double at = chance(20) ? NAN : chance(4) ? 10.0 : 0.0, stop = chance(4) ? at + 20.0 : NAN;
    int status = fmi2SetupExperiment(two, 0, 0.0, at, stop == stop, stop);
    status = status == fmi2OK ? fmi2EnterInitializationMode(two) : fmi2Error;
    same(status, fmi3EnterInitializationMode(three, false, 0.0, at, stop == stop, stop));
}

static void step(void)
{
    static const double sizes[] = {0.0, 1e-3, 1.0, 1.0, 60.0, -1.0, NAN, INFINITY, 1e10, -1e-15};
    double now = ((Instance *)two)->now.time, reached = 0.0;
    double size = chance(8) ? sizes[below(sizeof sizes / sizeof *sizes)] : fraction();
    double time = chance(40) ? NAN : chance(20) ? now + 0.5 : now;
    fmi3Boolean event = true, end = true, returned = true;
    /* with a stop time a step may be refused that is fine when it returns early */
    plan = size > 0.0 && time == now && isnan(((Instance *)two)->stop) && chance(4);
    early = time + (fraction() - 0.1) * size;
    int status_3 = fmi3DoStep(three, time, size, false, &event, &end, &returned, &reached), status_2;
    if (event || end) fail("an event", sequence);
    if (returned && early <= time)
        status_2 = fmi2OK; /* FMI 3 has done nothing */
    else
        status_2 = fmi2DoStep(two, time, returned ? early - time : size, 0);
    plan = 0;
    same(status_2, status_3);
    if (memcmp(&((Instance *)two)->now.time, &reached, sizeof reached) != 0) fail("another time is reached", sequence);
}

/* states */

static int beyond_slots(void) /* saving may take memory */
{
    return ((Instance *)two)->taken == (1u << SLOTS) - 1u;
}

static void states(void)
{
    static unsigned char bytes_2[BYTES], bytes_3[BYTES];
    unsigned k = below(HANDLES);
    size_t size = 0, size_3 = 0;
    switch (below(9)) {
    case 5:
    case 6:
    case 7:
    case 0: same(fmi2GetFMUstate(two, &handle_2[k]), fmi3GetFMUState(three, &handle_3[k])); return;
    case 1: same(fmi2SetFMUstate(two, handle_2[k]), fmi3SetFMUState(three, handle_3[k])); return;
    case 2: same(fmi2FreeFMUstate(two, &handle_2[k]), fmi3FreeFMUState(three, &handle_3[k])); return;
    default: break;
    }
    int status = fmi2SerializedFMUstateSize(two, handle_2[k], &size);
    same(status, fmi3SerializedFMUStateSize(three, handle_3[k], &size_3));
    if (status != fmi2OK) return;
    if (size != size_3 || size > BYTES) fail("another size of a state", sequence);
    if (chance(10)) size -= below(20) + 1;
    status = fmi2SerializeFMUstate(two, handle_2[k], (fmi2Byte *)bytes_2, size);
    same(status, fmi3SerializeFMUState(three, handle_3[k], bytes_3, size));
    if (status != fmi2OK) return;
    if (memcmp(bytes_2, bytes_3, size) != 0) fail("FMI 2 and FMI 3 store another state", sequence);
    int damaged = chance(2);
    if (damaged) {
        size_t at = below((unsigned)size);
        bytes_2[at] = bytes_3[at] = (unsigned char)(bytes_2[at] ^ (1u << below(8)));
    }
    unsigned to = below(HANDLES);
    void *read_2 = NULL, *read_3 = NULL;
    status = fmi2DeSerializeFMUstate(two, (const fmi2Byte *)bytes_2, size, &read_2);
    same(status, fmi3DeserializeFMUState(three, bytes_3, size, &read_3));
    if (damaged != (status == fmi2Error)) fail(damaged ? "a damaged state is read" : "a state is refused", sequence);
    if (status != fmi2OK) return;
    same(fmi2FreeFMUstate(two, &handle_2[to]), fmi3FreeFMUState(three, &handle_3[to]));
    handle_2[to] = read_2, handle_3[to] = read_3;
}

/* sequences */

/* Calls that are always refused, or have no effect on the model. */
static void call_others(void)
{
    static const fmi2String names[] = {"logAll", "logValidity", "logSolver", "logStatusError", "other", NULL};
    double value = 0.0;
    size_t count = 0, n = below(3);
    const fmi2String *first = names + below(4);
    int on = chance(2);
    same(fmi2SetDebugLogging(two, on, n, first), fmi3SetDebugLogging(three, on != 0, n, first));
    same(fmi2CancelStep(two), fmi3EnterEventMode(three));
    same(fmi2SetTime(two, 1.0), fmi3SetTime(three, 1.0));
    same(fmi2GetDerivatives(two, &value, 1), fmi3GetContinuousStateDerivatives(three, &value, 1));
    if (fmi3GetNumberOfVariableDependencies(three, output(), &count) != fmi3OK) fail("no dependencies", sequence);
    if (count != (((Instance *)two)->now.phase == STEPPING ? 0 : INPUTS)) fail("other dependencies", sequence);
    if (fmi2Instantiate("other", fmi2CoSimulation, "other", "", &CALLBACKS, 0, 0)) fail("another token", sequence);
    if (fmi3InstantiateCoSimulation("", "other", "", false, false, false, false, NULL, 0, NULL, log_3, NULL))
        fail("another token", sequence);
    messages_3 = messages_2;
}

static void change_phase(void)
{
    if (chance(4)) call_others();
    switch (below(9)) {
    case 0: same(fmi2Terminate(two), fmi3Terminate(three)); break;
    case 1:
        if (chance(3)) same(fmi2Reset(two), fmi3Reset(three));
        break;
    case 2:
        if (fmi3EnterConfigurationMode(three) == fmi3OK) fmi3ExitConfigurationMode(three);
        messages_3 = messages_2;
        break;
    case 3:
    case 4: begin(); break;
    default: same(fmi2ExitInitializationMode(two), fmi3ExitInitializationMode(three));
    }
}

static void act(void)
{
    unsigned kind = below(20);
    long before = allocations;
    int may = beyond_slots();
    if (kind < 6)
        step();
    else if (kind < 10)
        set();
    else if (kind < 13)
        get();
    else if (kind < 14)
        set_others();
    else if (kind < 15)
        derive();
    else if (kind < 18)
        states();
    else
        change_phase();
    if (allocations != before && !(may && kind >= 15 && kind < 18)) fail("memory was allocated", sequence);
}

static void run(void)
{
    long before = alive;
    memset(handle_2, 0, sizeof handle_2), memset(handle_3, 0, sizeof handle_3);
    messages_2 = messages_3 = 0;
    create();
    if (!chance(5)) {
        begin();
        same(fmi2ExitInitializationMode(two), fmi3ExitInitializationMode(three));
    }
    for (unsigned n = 30 + below(60); n; n--) act();
    fmi2FreeInstance(two);
    fmi3FreeInstance(three);
    if (alive != before) fail("memory was not freed", sequence);
}

static int crowd(long count)
{
    long pages, before = 0, after = 0, page = 4;
    char *end;
    for (long i = 0; i <= count; i++) {
        if (i == 0 || i == count) {
            FILE *file = fopen("/proc/self/statm", "r");
            char line[200] = "";
            if (!file || !fgets(line, sizeof line, file)) return 1;
            fclose(file);
            strtol(line, &end, 10);
            pages = strtol(end, NULL, 10);
            *(i ? &after : &before) = pages;
        }
        if (i == count) break;
        fmi2Component c = fmi2Instantiate("one of many", fmi2CoSimulation, MODEL_TOKEN, "", &CALLBACKS, 0, 0);
        if (!c || fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0) || fmi2EnterInitializationMode(c) ||
            fmi2ExitInitializationMode(c) || fmi2DoStep(c, 0.0, 1.0, 0))
            return 1;
    }
    printf("%.3f\n", (double)((after - before) * page) / (double)count);
    return 0;
}

int main(int count, char **argument)
{
    if (count == 3 && !strcmp(argument[1], "crowd")) return crowd(atol(argument[2]));
    if (count != 4 || strcmp(argument[1], "random") != 0) return 2;
    for (sequence = 0; sequence < atol(argument[2]); sequence++) {
        seed = 0x9e3779b97f4a7c15u * (uint64_t)(atol(argument[3]) + sequence + 1);
        run();
    }
    printf("%016llx\n", (unsigned long long)digest);
    return 0;
}
