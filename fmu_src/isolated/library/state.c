#include "state.h"

#include "message.h"

static State *state_new(size_t parts) { return calloc(1, sizeof(State) + parts * sizeof(Part *)); }

static int add(State *state, Part *part) {
    if (!part) return 0;
    part->users++;
    state->parts[state->count++] = part;
    return 1;
}

static Part *part_new(const void *bytes, size_t size) {
    Part *part = bytes ? malloc(sizeof *part + size) : NULL;
    if (!part) return NULL;
    part->users = 0;
    part->size = size;
    append(part->bytes, bytes, size);
    return part;
}

State *state_taken(uint64_t count, Reader *reader, const State *before) {
    const unsigned char *heads = taken(reader, count * sizeof(struct part));
    State *state = heads ? state_new(count) : NULL;
    for (size_t k = 0; state && k < count; k++) {
        struct part head;
        memcpy(&head, heads + k * sizeof head, sizeof head);
        Part *part = NULL;
        if (head.same < 0)
            part = part_new(taken(reader, PADDED(head.size)), head.size);
        else if (before && (size_t)head.same < before->count)
            part = before->parts[head.same];
        if (!add(state, part)) {
            state_free(state);
            return NULL;
        }
    }
    return state;
}

State *state_of(const void *bytes, size_t size) {
    State *state = state_new(1);
    if (!state || add(state, part_new(bytes, size))) return state;
    state_free(state);
    return NULL;
}

State *state_shared(const State *state) {
    State *same = state_new(state->count);
    for (size_t k = 0; same && k < state->count; k++) add(same, state->parts[k]);
    return same;
}

void state_free(State *state) {
    for (size_t k = 0; state && k < state->count; k++)
        if (!--state->parts[k]->users) free(state->parts[k]);
    if (state) free(state->values);
    free(state);
}

size_t state_size(const State *state) {
    size_t size = 0;
    for (size_t k = 0; k < state->count; k++) size += state->parts[k]->size;
    return size;
}

void state_write(const State *state, char *bytes) {
    for (size_t k = 0; k < state->count; k++) {
        memcpy(bytes, state->parts[k]->bytes, state->parts[k]->size);
        bytes += state->parts[k]->size;
    }
}
