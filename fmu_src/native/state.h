/* Saved states: parts that several states may share. They are the host's, and outlive the worker that made them. */

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
    uint64_t number;    /* under which the worker knows it; 0: it does not */
    uint64_t life;      /* of that worker */
    double *values;     /* of all variables in it, texts aside; NULL: only the worker knows them */
    uint64_t texts;     /* which texts they had */
    size_t count;
    Part *parts[];
} State;

/* All three NULL without memory, the first also if what is read is damaged; state_free takes any. */

/* The state of `count` parts that a worker has sent: `before` is the one it has sent before, or NULL. */
State *state_taken(uint64_t count, Reader *reader, const State *before);
/* A state of one part. */
State *state_of(const void *bytes, size_t size);
/* The same parts once more. */
State *state_shared(const State *state);

void state_free(State *state);

size_t state_size(const State *state);
void state_write(const State *state, char *bytes);

#endif
