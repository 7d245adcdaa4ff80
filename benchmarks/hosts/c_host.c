/* A host for co-simulation FMUs of FMI 2.0 and 3.0 that knows nothing of Python.
 *
 * It reads one command per line from stdin, fields separated by tabs, and answers each with a line
 *     answer <status>                                    fmi2Status, or -1: no library, function or instance
 * after a line for every entry that the FMU logs, and one for what the command asks for:
 *     log <instance> <status> <category> <message>
 *     value <value> ...                                  reals are hexadecimal
 * F, K and S number FMUs, instances and states; R and Q are value references. `fmu` with 3 at its end loads an FMU of FMI
 * 3.0, whose resources are a path; `forks` is for FMI 2.0.
 *
 *     fmu F LIBRARY URI GUID [3]  instantiate K F LOGGING     enter|exit|terminate|reset|free K
 *     unload F                    the library, which may stay if something else holds it
 *     reload F                    the library and its functions anew, after unloading it
 *     setup K START [STOP]
 *     set(r|i|b|s) K R VALUE ...  get(r|i|b|s) K R ...        step K T H       terminated K
 *     save|restore|freestate K S  (de)serialize K S FILE      derivative K R Q
 *     bench K N T H R A B Q ...   N times: set R to A or B in turn, step, get Q ...; nanoseconds of each time
 *     retry K N T H R A B Q ...   the same, each step tried and taken back: save the state before, restore and free it
 *     cycles F N                  N times: instantiate and free
 *     later MS COMMAND ...        the command after so many milliseconds
 *     together N                  the next N commands, each in a thread of its own, all at once; the place at which
 *                                 each has ended
 *     fork                        a child that only waits; its process id
 *     forks K N F                 N times: a child that frees instance K and ends, while one thread instantiates and
 *                                 frees F and another makes calls; the number of children that did not end in a minute
 *     offspring K F N             N children that only wait, forked while a thread instantiates K; their process ids
 *     wait                        for all children, as a careless host does
 *     alarms MICROSECONDS         SIGALRM so often from now on; 0: no more
 *     environment NAME VALUE      a variable of its environment from now on
 */
#include "c_host.h"
#include "c_host_fmi3.h"

/* life of an FMU and of an instance */

static int open_library(Fmu *fmu)
{
    fmu->library = dlopen(fmu->file, RTLD_NOW | RTLD_LOCAL);
    if (!fmu->library) {
        printf("log\t-1\t3\tdlopen\t%s\n", dlerror());
        return NONE;
    }
    if (fmu->version == 3)
        return open3(fmu);
#define RESOLVE(name) \
    if (!(*(void **)&fmu->name = dlsym(fmu->library, "fmi2" #name))) { \
        printf("log\t-1\t3\tdlsym\tfmi2" #name "\n"); \
        return NONE; \
    }
    FUNCTIONS(RESOLVE)
    return fmi2OK;
}

static int load(char **field, int count)
{
    Fmu *fmu = &fmus[slot(field[1], FMUS)];
    fmu->file = strdup(field[2]);
    fmu->uri = strdup(field[3]);
    fmu->guid = strdup(field[4]);
    fmu->version = count > 5 ? atoi(field[5]) : 2;
    return open_library(fmu);
}

static int unload(char **field, int count)
{
    return dlclose(fmus[slot(field[1], FMUS)].library) ? NONE : fmi2OK;
}

static int reload(char **field, int count)
{
    return unload(field, count) == fmi2OK ? open_library(&fmus[slot(field[1], FMUS)]) : NONE;
}

static int create(Instance *host, const Fmu *fmu, int logging)
{
    fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, host};
    host->fmu = fmu;
    host->callbacks = callbacks;
    host->component = fmu->Instantiate("contact", fmi2CoSimulation, fmu->guid, fmu->uri, &host->callbacks, 0, logging);
    return host->component ? fmi2OK : NONE;
}

static int instantiate(char **field, int count)
{
    return create(instance(field), &fmus[slot(field[2], FMUS)], atoi(field[3]));
}

static int release(char **field, int count)
{
    instance(field)->fmu->FreeInstance(instance(field)->component);
    return fmi2OK;
}

static int setup(char **field, int count)
{
    double start = strtod(field[2], NULL), stop = count > 3 ? strtod(field[3], NULL) : 0.0;
    return instance(field)->fmu->SetupExperiment(instance(field)->component, 0, 0.0, start, count > 3, stop);
}

#define PLAIN(name, function) \
    static int name(char **field, int count) \
    { \
        return instance(field)->fmu->function(instance(field)->component); \
    }
PLAIN(enter, EnterInitializationMode)
PLAIN(leave, ExitInitializationMode)
PLAIN(terminate, Terminate)
PLAIN(reset, Reset)

static int step(char **field, int count)
{
    return instance(field)->fmu->DoStep(instance(field)->component, strtod(field[2], NULL), strtod(field[3], NULL), 0);
}

static int terminated(char **field, int count)
{
    fmi2Boolean value = 0;
    int status = instance(field)->fmu->GetBooleanStatus(instance(field)->component, fmi2Terminated, &value);
    printf("value\t%d\n", value);
    return status;
}

/* variables */

#define SET(name, Type, parse) \
    static int name(char **field, int count) \
    { \
        fmi2ValueReference reference[FIELDS]; \
        fmi2##Type value[FIELDS]; \
        size_t n = references(field + 2, count - 2, 2, reference); \
        for (size_t i = 0; i < n; i++) \
            value[i] = parse(field[3 + 2 * i]); \
        return instance(field)->fmu->Set##Type(instance(field)->component, reference, n, value); \
    }
#define REAL(text) strtod(text, NULL)
#define TEXT(text) (text)
SET(set_reals, Real, REAL)
SET(set_integers, Integer, atoi)
SET(set_booleans, Boolean, atoi)
SET(set_strings, String, TEXT)

#define PRINT_REAL(value) printf("\t%a", value)
#define PRINT_INTEGER(value) printf("\t%d", value)
#define GET(name, Type, print) \
    static int name(char **field, int count) \
    { \
        fmi2ValueReference reference[FIELDS]; \
        fmi2##Type value[FIELDS] = {0}; \
        size_t n = references(field + 2, count - 2, 1, reference); \
        int status = instance(field)->fmu->Get##Type(instance(field)->component, reference, n, value); \
        printf("value"); \
        for (size_t i = 0; i < n; i++) \
            print(value[i]); \
        putchar('\n'); \
        return status; \
    }
GET(get_reals, Real, PRINT_REAL)
GET(get_integers, Integer, PRINT_INTEGER)
GET(get_booleans, Boolean, PRINT_INTEGER)
GET(get_strings, String, print_text)

static int derivative(char **field, int count)
{
    fmi2ValueReference unknown = (fmi2ValueReference)atoi(field[2]), known = (fmi2ValueReference)atoi(field[3]);
    fmi2Real seed = 1.0, value = 0.0;
    int status = instance(field)->fmu->GetDirectionalDerivative(instance(field)->component, &unknown, 1, &known, 1,
                                                                &seed, &value);
    printf("value\t%a\n", value);
    return status;
}

/* states */

static int save(char **field, int count)
{
    /* a slot in use is handed over again, as FMI allows */
    return instance(field)->fmu->GetFMUstate(instance(field)->component, &states[slot(field[2], STATES)]);
}

static int restore(char **field, int count)
{
    return instance(field)->fmu->SetFMUstate(instance(field)->component, states[slot(field[2], STATES)]);
}

static int free_state(char **field, int count)
{
    return instance(field)->fmu->FreeFMUstate(instance(field)->component, &states[slot(field[2], STATES)]);
}

static int serialize(char **field, int count)
{
    Instance *host = instance(field);
    fmi2FMUstate state = states[slot(field[2], STATES)];
    size_t size = 0;
    int status = host->fmu->SerializedFMUstateSize(host->component, state, &size);
    FILE *file = fopen(field[3], "wb");
    fmi2Byte *data = malloc(size + 1);
    if (!file || !data)
        fail("cannot write", field[3]);
    if (status == fmi2OK)
        status = host->fmu->SerializeFMUstate(host->component, state, data, size);
    fwrite(data, 1, size, file);
    fclose(file);
    free(data);
    return status;
}

static int deserialize(char **field, int count)
{
    Instance *host = instance(field);
    FILE *file = fopen(field[3], "rb");
    if (!file)
        fail("cannot read", field[3]);
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    fmi2Byte *data = malloc(size + 1);
    rewind(file);
    if (!data || fread(data, 1, size, file) != size)
        fail("cannot read", field[3]);
    int status = host->fmu->DeSerializeFMUstate(host->component, data, size, &states[slot(field[2], STATES)]);
    fclose(file);
    free(data);
    return status;
}

/* repetition */

static int repeat(char **field, int count, int back)
{
    Instance *host = instance(field);
    long n = atol(field[2]), done = 0;
    long long *taken = calloc((size_t)n + 1, sizeof *taken);
    double t = strtod(field[3], NULL), h = strtod(field[4], NULL);
    fmi2ValueReference input = (fmi2ValueReference)atoi(field[5]), output[FIELDS];
    fmi2Real value[2] = {strtod(field[6], NULL), strtod(field[7], NULL)}, result[FIELDS];
    size_t outputs = references(field + 8, count - 8, 1, output);
    int status = fmi2OK;
    for (; done < n && status == fmi2OK; done++) {
        struct timespec start, end;
        fmi2FMUstate state = NULL;
        clock_gettime(CLOCK_MONOTONIC, &start);
        if (back)
            status |= host->fmu->GetFMUstate(host->component, &state);
        status |= host->fmu->SetReal(host->component, &input, 1, &value[done % 2]);
        status |= host->fmu->DoStep(host->component, back ? t : t + (double)done * h, h, !back);
        status |= host->fmu->GetReal(host->component, output, outputs, result);
        if (back) {
            status |= host->fmu->SetFMUstate(host->component, state);
            status |= host->fmu->FreeFMUstate(host->component, &state);
        }
        clock_gettime(CLOCK_MONOTONIC, &end);
        taken[done] = (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec;
    }
    printf("value");
    for (long i = 0; i < done; i++)
        printf("\t%lld", taken[i]);
    putchar('\n');
    free(taken);
    return status;
}

static int bench(char **field, int count) { return repeat(field, count, 0); }

static int retry(char **field, int count) { return repeat(field, count, 1); }

static int cycles(char **field, int count)
{
    Instance *host = &instances[INSTANCES - 1];
    int status = fmi2OK;
    for (long i = atol(field[2]); i > 0 && status == fmi2OK; i--) {
        status = create(host, &fmus[slot(field[1], FMUS)], 0);
        if (status == fmi2OK)
            host->fmu->FreeInstance(host->component);
    }
    return status;
}

static int fork_child(char **field, int count)
{
    fflush(stdout);
    pid_t child = fork();
    while (child == 0)
        pause();
    printf("value\t%d\n", (int)child);
    return fmi2OK;
}

#ifdef _WIN32
static int forks(char **field, int count) { return NONE; }
static int wait_for_all(char **field, int count) { return NONE; }
static int offspring(char **field, int count) { return NONE; }
#else
static int first_status;

static void *first(void *field)
{
    first_status = create(instance(field), &fmus[slot(((char **)field)[2], FMUS)], 1);
    return NULL;
}

static int offspring(char **field, int count)
{
    pid_t children[FIELDS];
    int n = slot(field[3], FIELDS);
    pthread_t thread;
    fflush(stdout);
    if (pthread_create(&thread, NULL, first, field))
        fail("no thread", field[3]);
    for (int i = 0; i < n; i++) {
        children[i] = fork();
        while (children[i] == 0)
            pause();
    }
    pthread_join(thread, NULL);
    printf("value");
    for (int i = 0; i < n; i++)
        printf("\t%d", (int)children[i]);
    putchar('\n');
    return first_status;
}

static volatile int forking;

static void *come_and_go(void *argument)
{
    Instance *host = &instances[INSTANCES - 1];
    while (forking)
        if (create(host, argument, 0) == fmi2OK)
            host->fmu->FreeInstance(host->component);
    return NULL;
}

static void *chatter(void *argument)
{
    int nothing;
    while (forking)
        ((Fmu *)argument)->Reset(&nothing); /* unknown to the FMU */
    return NULL;
}

static int ended_within(pid_t child, int seconds)
{
    const struct timespec pause = {0, 1000000};
    for (long i = 0; i < 1000L * seconds; i++) {
        if (waitpid(child, NULL, WNOHANG) == child)
            return 1;
        nanosleep(&pause, NULL);
    }
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    return 0;
}

static int forks(char **field, int count)
{
    Instance *host = instance(field);
    int hung = 0;
    pthread_t threads[2];
    Fmu *fmu = &fmus[slot(field[3], FMUS)];
    fflush(stdout);
    forking = 1;
    if (pthread_create(&threads[0], NULL, come_and_go, fmu) || pthread_create(&threads[1], NULL, chatter, fmu))
        fail("no thread", field[3]);
    for (long i = atol(field[2]); i > 0; i--) {
        const struct timespec pause = {0, 100000 * (i % 50)};
        nanosleep(&pause, NULL);
        pid_t child = fork();
        if (child == 0) {
            host->fmu->FreeInstance(host->component);
            _exit(0);
        }
        hung += !ended_within(child, 60);
    }
    forking = 0;
    pthread_join(threads[0], NULL);
    pthread_join(threads[1], NULL);
    printf("value\t%d\n", hung);
    return fmi2OK;
}

static int wait_for_all(char **field, int count)
{
    while (wait(NULL) > 0)
        continue;
    return fmi2OK;
}
#endif

/* signals that come all the time, as of a host's own clock */

#ifdef _WIN32
static int alarms(char **field, int count) { return NONE; }

static int environment(char **field, int count) { return NONE; }
#else
static void nothing(int number) {}

static int alarms(char **field, int count)
{
    struct sigaction action = {.sa_handler = nothing, .sa_flags = SA_RESTART};
    struct itimerval interval = {{0, atol(field[1])}, {0, atol(field[1])}};
    return sigaction(SIGALRM, &action, NULL) || setitimer(ITIMER_REAL, &interval, NULL) ? fmi2Error : fmi2OK;
}

static int environment(char **field, int count) { return setenv(field[1], field[2], 1) ? fmi2Error : fmi2OK; }
#endif

/* commands */

typedef struct {
    pthread_t thread;
    char line[1 << 16];
    int status, place;
} Job;

static atomic_int ended;

static int together(char **field, int count);

static const struct {
    const char *name;
    int (*run)(char **field, int count);
    int fields;
} commands[] = {
    {"fmu", load, 5}, {"instantiate", instantiate, 4}, {"free", release, 2},
    {"unload", unload, 2}, {"reload", reload, 2}, {"setup", setup, 3}, {"enter", enter, 2}, {"exit", leave, 2},
    {"terminate", terminate, 2}, {"reset", reset, 2}, {"step", step, 4}, {"terminated", terminated, 2},
    {"setr", set_reals, 2}, {"seti", set_integers, 2}, {"setb", set_booleans, 2}, {"sets", set_strings, 2},
    {"getr", get_reals, 2}, {"geti", get_integers, 2}, {"getb", get_booleans, 2}, {"gets", get_strings, 2},
    {"save", save, 3}, {"restore", restore, 3}, {"freestate", free_state, 3},
    {"serialize", serialize, 4}, {"deserialize", deserialize, 4}, {"derivative", derivative, 4},
    {"bench", bench, 8}, {"retry", retry, 8}, {"cycles", cycles, 3}, {"together", together, 2}, {"fork", fork_child, 1},
    {"forks", forks, 4}, {"offspring", offspring, 4}, {"wait", wait_for_all, 1}, {"alarms", alarms, 2},
    {"environment", environment, 3},
};

static void *obey(void *argument)
{
    Job *job = argument;
    char *fields[FIELDS], **field = fields;
    int count = 0;
    for (char *rest = job->line; rest && count < FIELDS; count++) {
        field[count] = rest;
        rest = strchr(rest, '\t');
        if (rest)
            *rest++ = '\0';
    }
    if (count > 2 && !strcmp(field[0], "later")) {
        const struct timespec pause = {atol(field[1]) / 1000, atol(field[1]) % 1000 * 1000000L};
        nanosleep(&pause, NULL);
        field += 2;
        count -= 2;
    }
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
        if (!strcmp(commands[i].name, field[0])) {
            if (count < commands[i].fields)
                fail("too few fields", field[0]);
            job->status = commands[i].run(field, count);
            job->place = atomic_fetch_add(&ended, 1);
            return NULL;
        }
    fail("no such command", field[0]);
    return NULL;
}

static int next(Job *job)
{
    if (!fgets(job->line, sizeof job->line, stdin))
        return 0;
    job->line[strcspn(job->line, "\n")] = '\0';
    return 1;
}

static int together(char **field, int count)
{
    int n = slot(field[1], INSTANCES), worst = fmi2OK;
    Job *jobs = calloc((size_t)n, sizeof *jobs);
    for (int i = 0; i < n; i++)
        if (!next(&jobs[i]))
            fail("too few commands", field[1]);
    ended = 0;
    for (int i = 0; i < n; i++)
        if (pthread_create(&jobs[i].thread, NULL, obey, &jobs[i]))
            fail("no thread", field[1]);
    for (int i = 0; i < n; i++) {
        pthread_join(jobs[i].thread, NULL);
        if (jobs[i].status < fmi2OK || jobs[i].status > worst)
            worst = jobs[i].status;
    }
    printf("value");
    for (int i = 0; i < n; i++)
        printf("\t%d", jobs[i].place);
    putchar('\n');
    free(jobs);
    return worst;
}

int main(void)
{
    static Job job;
    while (next(&job)) {
        obey(&job);
        printf("answer\t%d\n", job.status);
        fflush(stdout);
    }
    return 0;
}
