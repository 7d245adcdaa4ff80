/* One FMU instance on the host's side: its variables, what is to be sent, its saved states, and its worker, which is
   started anew when it was lost. */

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
/* Whether `component` is an instance that has not been freed. */
int instance_known(const void *component);
/* What library_release is to be given at the end of the call. */
void *instance_free(Instance *instance);

/* Which entries the host wants to hear: all, or those of the categories it names, or none. It hears errors anyway, and
   warnings, too, until it has asked for none. */
void instance_hear(Instance *instance, fmi2Boolean logging, size_t count, const char *const categories[]);
/* Tell the host what went wrong, and return fmi2Error. */
fmi2Status instance_fail(Instance *instance, const char *format, ...);

/* Let the worker do `operation`. */
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
