/* Saved states: parts that several states may share. The host owns them; they outlive the worker that made them. */

#ifndef STATE_H
#define STATE_H

#include <stddef.h>
#include <stdint.h>

#include "buffer.h"

typedef struct {
    size_t users, size;
    unsigned char bytes[];
} Part;

typedef struct State {
    struct State *next; /* of the same instance */
    uint64_t number;    /* its number in the worker; 0: unknown there */
    uint64_t life;      /* of that worker */
    double *values;     /* of all variables except texts; NULL: only the worker has them */
    uint64_t texts;     /* count of changes of texts at that time */
    size_t count;
    Part *parts[];
} State;

/* All three return NULL without memory, the first also for damaged input; state_free takes any. */

/* The state of `count` parts sent by a worker; `before` is the previously sent one, or NULL. */
State *state_taken(uint64_t count, Reader *reader, const State *before);
/* A state of one part. */
State *state_of(const void *bytes, size_t size);
/* A second state of the same parts. */
State *state_shared(const State *state);

void state_free(State *state);

size_t state_size(const State *state);
void state_write(const State *state, char *bytes);

#endif
