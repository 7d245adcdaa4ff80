/* What FMI 2 and FMI 3 have in common: an instance, its phases, and checked access to its variables. */

#ifndef INSTANCE_H
#define INSTANCE_H

#include "interface.h"

typedef struct Instance Instance;
struct Instance {
    Head *head; /* of the state */
    void *work;
    int stale;       /* outputs are older than inputs or state */
    int event_mode, may_return_early;
    double start_time, stop_time;
    Outcome last;
    char *name;
    void *environment, *logger, *update;
    void (*report)(Instance *, Status, const char *message);
};

Instance *create(const char *name, const char *token);
void discard(Instance *);
void reset(Instance *);

Status say(Instance *, Status, const char *format, ...);
Status get_numbers(Instance *, char kind, const unsigned *refs, size_t n, double *values);
Status set_numbers(Instance *, char kind, const unsigned *refs, size_t n, const double *values);
Status get_texts(Instance *, const unsigned *refs, size_t n, const char **values);
Status set_texts(Instance *, const unsigned *refs, size_t n, const char *const *values);
Status set_input_slopes(Instance *, const unsigned *refs, size_t n, const int *orders, const double *values);
Status get_output_slopes(Instance *, const unsigned *refs, size_t n, const int *orders, double *values);
Status partials(Instance *, const unsigned *unknowns, size_t n, const unsigned *knowns, size_t m, const double *seed,
                double *out);

Status enter_initialisation(Instance *, double start_time);
Status exit_initialisation(Instance *);
Status step(Instance *, double time, double h);
int is_short(const Instance *, double time, double h); /* the last step ended early */
Status terminate(Instance *);

Status save(Instance *, void **state);
Status restore(Instance *, const void *state);
Status release(Instance *, void **state);
Status state_size(Instance *, const void *state, size_t *size);
Status pack(Instance *, const void *state, void *bytes, size_t size);
Status unpack(Instance *, const void *bytes, size_t size, void **state);

#endif
