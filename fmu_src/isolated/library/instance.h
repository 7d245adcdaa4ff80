/* One FMU instance on the host's side: its variables, pending requests, saved states and worker, which is restarted
   after a loss. */

#ifndef INSTANCE_H
#define INSTANCE_H

#include <stddef.h>
#include <stdint.h>

#include "fmi2Functions.h"
#include "message.h"
#include "state.h"

typedef struct Instance Instance;

/* The host, in the version of FMI in which it calls. A status is FMI 2.0's: those of FMI 3.0 have the same values. */
typedef struct Host {
    /* NULL if the host hears nothing. `message` is a format without conversions (percent signs are doubled) and has the
       names that calls have in FMI 2.0. */
    void (*log)(const struct Host *host, const char *name, fmi2Status status, const char *category,
                const char *message);
    void *environment;
    void (*logger)(void); /* the host's own function, which `log` calls */
    const char *const *kinds; /* names of the types of variables */
} Host;

/* NULL if there is no worker that can run the model; the host's log says why. `place`: URI or path of the resources. */
Instance *instance_new(const char *name, const char *guid, const char *place, const Host *host,
                       int logging);
/* True if `component` is an instance that has not been freed. */
int instance_known(const void *component);
/* Returns the argument for library_release at the end of the call. */
void *instance_free(Instance *instance);

/* Choose the entries sent to the host: all, those of the given categories, or none. Errors are always sent, warnings
   until the host has asked for none. */
void instance_hear(Instance *instance, int logging, size_t count, const char *const categories[]);
/* Log an error to the host, and return fmi2Error. */
fmi2Status instance_fail(Instance *instance, const char *format, ...);

/* True, and an error for the host, if one of both arrays of a call is NULL, and not empty. */
int instance_lacks(Instance *instance, size_t count, const void *first, const void *second);

/* Have the worker carry out `operation`. */
fmi2Status instance_do(Instance *instance, enum operation operation, const double numbers[3]);
fmi2Status instance_reset(Instance *instance);

/* Values of `count` variables of one kind, as double, int or text by kind. */
fmi2Status instance_get(Instance *instance, enum kind kind, const uint32_t references[], size_t count, void *values);
fmi2Status instance_set(Instance *instance, enum kind kind, const uint32_t references[], size_t count,
                        const void *values);

fmi2Status instance_save(Instance *instance, State **state);
fmi2Status instance_restore(Instance *instance, State *state);
void instance_forget(Instance *instance, State *state);
int instance_owns(const Instance *instance, const State *state);
State *instance_read(Instance *instance, const char *bytes, size_t size);

#endif
