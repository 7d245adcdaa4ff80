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

/* NULL if there is no worker that can run the model; the host's log says why. */
Instance *instance_new(const char *name, const char *guid, const char *uri, const fmi2CallbackFunctions *host,
                       fmi2Boolean logging);
/* True if `component` is an instance that has not been freed. */
int instance_known(const void *component);
/* Returns the argument for library_release at the end of the call. */
void *instance_free(Instance *instance);

/* Choose the entries sent to the host: all, those of the given categories, or none. Errors are always sent, warnings
   until the host has asked for none. */
void instance_hear(Instance *instance, fmi2Boolean logging, size_t count, const char *const categories[]);
/* Log an error to the host, and return fmi2Error. */
fmi2Status instance_fail(Instance *instance, const char *format, ...);

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
