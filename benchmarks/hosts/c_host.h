/* What the commands of c_host.c work with: FMUs, instances and states by number, one line of text in or out. */
#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
#ifndef _WIN32
#include <sys/wait.h>
#endif

#include "fmi2FunctionTypes.h"

#define FUNCTIONS(X) \
    X(Instantiate) X(FreeInstance) X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) \
    X(Terminate) X(Reset) X(DoStep) X(GetBooleanStatus) X(GetDirectionalDerivative) \
    X(SetReal) X(SetInteger) X(SetBoolean) X(SetString) X(GetReal) X(GetInteger) X(GetBoolean) X(GetString) \
    X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate) X(SerializedFMUstateSize) X(SerializeFMUstate) X(DeSerializeFMUstate)

enum { FMUS = 16, INSTANCES = 256, STATES = 256, FIELDS = 4096, NONE = -1 };

#define MEMBER(name) fmi2##name##TYPE *name;
typedef struct {
    FUNCTIONS(MEMBER)
    void *library;
    char *file, *uri, *guid;
    int version;
    const void *version3; /* the functions of FMI 3.0 behind those above */
} Fmu;

typedef struct {
    const Fmu *fmu;
    fmi2Component component; /* kept after `free`, so that a script can do what a careless host does */
    fmi2CallbackFunctions callbacks;
} Instance;

static Fmu fmus[FMUS];
static Instance instances[INSTANCES];
static fmi2FMUstate states[STATES];
static pthread_mutex_t printing = PTHREAD_MUTEX_INITIALIZER;

/* output: what would break a line is escaped */

static void print_text(const char *text)
{
    putchar('\t');
    for (; text && *text; text++)
        switch (*text) {
        case '\\': fputs("\\\\", stdout); break;
        case '\n': fputs("\\n", stdout); break;
        case '\t': fputs("\\t", stdout); break;
        case '\r': fputs("\\r", stdout); break;
        default: putchar(*text);
        }
}

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    static char text[1 << 16];
    va_list arguments;
    pthread_mutex_lock(&printing);
    va_start(arguments, message);
    vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    printf("log\t%td\t%d", (Instance *)environment - instances, status);
    print_text(category ? category : "NULL");
    print_text(text);
    putchar('\n');
    pthread_mutex_unlock(&printing);
}

/* input */

static void fail(const char *what, const char *which)
{
    fprintf(stderr, "c_host: %s: %s\n", what, which);
    exit(2);
}

static int slot(const char *field, int size)
{
    int n = atoi(field);
    if (n < 0 || n >= size)
        fail("no such number", field);
    return n;
}

static Instance *instance(char **field)
{
    return &instances[slot(field[1], INSTANCES)];
}

static size_t references(char **field, int count, int stride, fmi2ValueReference *reference)
{
    size_t n = 0;
    for (int i = 0; i + stride <= count; i += stride)
        reference[n++] = (fmi2ValueReference)strtoul(field[i], NULL, 10);
    return n;
}
