/* Times steps of a native FMU on one CPU.

       step_time FMI LIBRARY TOKEN CPU ROUNDS STEP VALUE_REFERENCE VALUE_1 VALUE_2 OUTPUT ...

   Each round sets an input to one of two values in turn, steps, and gets the outputs; a tenth as many rounds come before,
   unmeasured. Prints the median, the 99th and the 99.99th percentile and the longest time of a round; the same of as many
   rounds that only read the clock, for as long as that median; and the median time of two readings of the clock with
   nothing between, in nanoseconds. Then the same rounds, each with the state saved before, and restored and freed after
   it. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2FunctionTypes.h"
#include "fmi3FunctionTypes.h"

enum { OUTPUTS = 64 };

static void *library, *instance;
static unsigned input, output[OUTPUTS];
static size_t outputs;
static double result[OUTPUTS];

#define FUNCTION(name) ((name##TYPE *)found(#name))

static void *found(const char *name)
{
    void *function = dlsym(library, name);
    if (!function) {
        fprintf(stderr, "%s is missing\n", name);
        exit(1);
    }
    return function;
}

static void check(int status)
{
    if (status == fmi2OK) return;
    fprintf(stderr, "A call returned %d.\n", status);
    exit(1);
}

static void log_2(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                  fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)message;
}

static void log_3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment, (void)status, (void)category, (void)message;
}

static fmi2SetRealTYPE *set_2;
static fmi2GetRealTYPE *get_2;
static fmi2DoStepTYPE *step_2;
static fmi2GetFMUstateTYPE *save_2;
static fmi2SetFMUstateTYPE *restore_2;
static fmi2FreeFMUstateTYPE *forget_2;
static fmi3SetFloat64TYPE *set_3;
static fmi3GetFloat64TYPE *get_3;
static fmi3DoStepTYPE *step_3;
static fmi3GetFMUStateTYPE *save_3;
static fmi3SetFMUStateTYPE *restore_3;
static fmi3FreeFMUStateTYPE *forget_3;

static void start_2(const char *token)
{
    static const fmi2CallbackFunctions callbacks = {log_2, calloc, free, NULL, NULL};
    instance = FUNCTION(fmi2Instantiate)("timed", fmi2CoSimulation, token, "", &callbacks, 0, 0);
    if (!instance) check(fmi2Error);
    check(FUNCTION(fmi2SetupExperiment)(instance, 0, 0.0, 0.0, 0, 0.0));
    check(FUNCTION(fmi2EnterInitializationMode)(instance));
    check(FUNCTION(fmi2ExitInitializationMode)(instance));
    set_2 = FUNCTION(fmi2SetReal), get_2 = FUNCTION(fmi2GetReal), step_2 = FUNCTION(fmi2DoStep);
    save_2 = FUNCTION(fmi2GetFMUstate), restore_2 = FUNCTION(fmi2SetFMUstate), forget_2 = FUNCTION(fmi2FreeFMUstate);
}

static void start_3(const char *token)
{
    instance = FUNCTION(fmi3InstantiateCoSimulation)("timed", token, "", 0, 0, 0, 0, NULL, 0, NULL, log_3, NULL);
    if (!instance) check(fmi2Error);
    check((int)FUNCTION(fmi3EnterInitializationMode)(instance, 0, 0.0, 0.0, 0, 0.0));
    check((int)FUNCTION(fmi3ExitInitializationMode)(instance));
    set_3 = FUNCTION(fmi3SetFloat64), get_3 = FUNCTION(fmi3GetFloat64), step_3 = FUNCTION(fmi3DoStep);
    save_3 = FUNCTION(fmi3GetFMUState), restore_3 = FUNCTION(fmi3SetFMUState), forget_3 = FUNCTION(fmi3FreeFMUState);
}

static int round_2(double value, double time, double size, int back)
{
    void *state = NULL;
    int status = back ? (int)save_2(instance, &state) : 0;
    status |= (int)set_2(instance, &input, 1, &value);
    status |= (int)step_2(instance, time, size, !back);
    status |= (int)get_2(instance, output, outputs, result);
    return back ? status | (int)restore_2(instance, state) | (int)forget_2(instance, &state) : status;
}

static int round_3(double value, double time, double size, int back)
{
    void *state = NULL;
    fmi3Boolean event, end, early;
    double reached;
    int status = back ? (int)save_3(instance, &state) : 0;
    status |= (int)set_3(instance, &input, 1, &value, 1);
    status |= (int)step_3(instance, time, size, !back, &event, &end, &early, &reached);
    status |= (int)get_3(instance, output, outputs, result, outputs);
    return back ? status | (int)restore_3(instance, state) | (int)forget_3(instance, &state) : status;
}

static long long now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1000000000LL + time.tv_nsec;
}

static int longer(const void *first, const void *second)
{
    long long one = *(const long long *)first, two = *(const long long *)second;
    return (one > two) - (one < two);
}

static void print_percentiles(long long *taken, long rounds)
{
    qsort(taken, (size_t)rounds, sizeof *taken, longer);
    printf("%lld %lld %lld %lld", taken[rounds / 2], taken[(long)(0.99 * (double)rounds)],
           taken[(long)(0.9999 * (double)rounds)], taken[rounds - 1]);
}

int main(int count, char **argument)
{
    if (count < 11 || count - 10 > OUTPUTS) return 2;
    int fmi = atoi(argument[1]);
    long rounds = atol(argument[5]), warm = rounds / 10;
    double size = strtod(argument[6], NULL), value[2] = {strtod(argument[8], NULL), strtod(argument[9], NULL)};
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET((size_t)atoi(argument[4]), &cpus);
    if (sched_setaffinity(0, sizeof cpus, &cpus)) return 3;
    input = (unsigned)atoi(argument[7]);
    for (int i = 10; i < count; i++) output[outputs++] = (unsigned)atoi(argument[i]);
    library = dlopen(argument[2], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    (fmi == 2 ? start_2 : start_3)(argument[3]);
    long long *taken = calloc((size_t)rounds, sizeof *taken);
    long step = 0;
    for (int back = 0; back < 2; back++) {
        for (long i = -warm; i < rounds; i++) {
            double time = size * (double)step;
            step += !back;
            long long start = now();
            int status = (fmi == 2 ? round_2 : round_3)(value[i & 1], time, size, back);
            long long end = now();
            check(status);
            if (i >= 0) taken[i] = end - start;
        }
        print_percentiles(taken, rounds);
        long long median = taken[rounds / 2];
        for (long i = 0; i < rounds; i++) {
            long long start = now(), end = start;
            while (end - start < median) end = now();
            taken[i] = end - start;
        }
        putchar(' ');
        print_percentiles(taken, rounds);
        for (long i = 0; i < rounds; i++) {
            long long start = now();
            taken[i] = now() - start;
        }
        qsort(taken, (size_t)rounds, sizeof *taken, longer);
        printf(" %lld\n", taken[rounds / 2]);
    }
    return 0;
}
