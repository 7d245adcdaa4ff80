#include <math.h>
#include <string.h>

#include "instance.h"
#include "log.h"

/* A serialised state: this header, then the bytes of the moment. Numbers are little-endian, as on every platform that
   the FMU is built for; on another one `magic` does not fit. */
typedef struct {
    uint64_t magic, checksum; /* of all that follows */
    uint64_t size;            /* of the moment */
    char token[TOKEN];
} Header;

static const uint64_t MAGIC = 0x3155464f42495254u; /* "TRIBOFU1" */

size_t instance_state_size(void) { return sizeof(Header) + sizeof(Moment); }

/* The slot of a handle; SLOTS if it is none of them. */
static unsigned slot_of(const Instance *it, const void *state) {
    unsigned k = 0;
    while (k < SLOTS && state != &it->slots[k]) k++;
    return k;
}

static int owns(const Instance *it, const void *state) {
    unsigned k = slot_of(it, state);
    if (k < SLOTS) return (it->taken >> k & 1u) != 0u;
    const State *own = it->more;
    while (own && own != state) own = own->next;
    return own != NULL;
}

static Status check(const Instance *it, const void *state) {
    if (state && owns(it, state)) return OK;
    return log_error(it, "The FMU state is none of this instance's, or it has been freed.");
}

/* A free slot, or memory of the host; NULL without it. */
static State *place(Instance *it) {
    unsigned k = 0;
    while (k < SLOTS && it->taken >> k & 1u) k++;
    if (k < SLOTS) {
        it->taken |= 1u << k;
        return &it->slots[k];
    }
    State *made = it->host.allocate(1, sizeof *made);
    if (!made) {
        log_error(it, "There is no memory for a state of %lu bytes. Free states that are not needed.",
                  (unsigned long)sizeof *made);
        return NULL;
    }
    made->next = it->more;
    it->more = made;
    return made;
}

Status instance_save(Instance *it, void **state) {
    State *saved = *state && owns(it, *state) ? *state : place(it);
    if (!saved) return ERROR;
    saved->moment = it->now;
    *state = saved;
    return OK;
}

Status instance_restore(Instance *it, void *state) {
    if (it->asking) return instance_may_change(it, "SetFMUState");
    if (check(it, state) != OK) return ERROR;
    it->now = ((const State *)state)->moment;
    it->terminated = it->anywhere = 0;
    return OK;
}

Status instance_forget(Instance *it, void **state) {
    if (!state || !*state) return OK;
    if (check(it, *state) != OK) return ERROR;
    unsigned k = slot_of(it, *state);
    if (k < SLOTS)
        it->taken &= ~(1u << k);
    else {
        State **link = &it->more;
        while (*link != *state) link = &(*link)->next;
        *link = (*link)->next;
        it->host.release(*state);
    }
    *state = NULL;
    return OK;
}

void instance_forget_all(Instance *it) {
    while (it->more) {
        void *state = it->more;
        instance_forget(it, &state);
    }
}

/* serialisation */

/* FNV-1a: any change of a single byte changes it. */
static uint64_t checksum(const unsigned char *bytes, size_t size) {
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++) sum = (sum ^ bytes[i]) * 0x100000001b3u;
    return sum;
}

enum { UNSUMMED = 2 * sizeof(uint64_t) }; /* bytes before those that the checksum covers */

Status instance_size(Instance *it, void *state, size_t *size) {
    if (check(it, state) != OK) return ERROR;
    *size = instance_state_size();
    return OK;
}

Status instance_write(Instance *it, void *state, unsigned char *bytes, size_t size) {
    Header header = {.magic = MAGIC, .size = sizeof(Moment)};
    if (check(it, state) != OK) return ERROR;
    if (size < instance_state_size())
        return log_error(it, "The FMU state has %lu bytes; there is room for %lu only.",
                         (unsigned long)instance_state_size(), (unsigned long)size);
    memcpy(header.token, MODEL_STATES, TOKEN);
    memcpy(bytes, &header, sizeof header);
    memcpy(bytes + sizeof header, &((const State *)state)->moment, sizeof(Moment));
    header.checksum = checksum(bytes + UNSUMMED, instance_state_size() - UNSUMMED);
    memcpy(bytes, &header, sizeof header);
    return OK;
}

static Status refuse(const Instance *it, const char *why) {
    log_text(it, ERROR, OF_VALIDITY, why);
    return ERROR;
}

/* The checksum finds what was damaged; this finds what was never written by an FMU. */
static int sensible(const Moment *moment) {
    return isfinite(moment->time) && outputs_finite(&moment->solution.outputs) && moment->phase <= BEHIND && moment->phase != CONFIGURING && moment->valid <= 1 &&
           moment->ready <= 1 && moment->derived <= 1;
}

Status instance_read(Instance *it, const unsigned char *bytes, size_t size, void **state) {
    Header header;
    Moment moment;
    if (size >= sizeof header) memcpy(&header, bytes, sizeof header);
    if (size < sizeof header || header.magic != MAGIC)
        return refuse(it, "The stored FMU state is not one that this version of tribofmu writes for a native FMU. Give one "
                          "that this FMU has serialised.");
    if (memcmp(header.token, MODEL_STATES, TOKEN) != 0 || header.size != sizeof moment)
        return refuse(it, "The FMU state belongs to another FMU, or is damaged. Use one that this FMU has serialised.");
    if (size != instance_state_size() || header.checksum != checksum(bytes + UNSUMMED, size - UNSUMMED))
        return refuse(it, "The stored FMU state is damaged: it was cut or changed. Use an earlier one.");
    memcpy(&moment, bytes + sizeof header, sizeof moment);
    if (!sensible(&moment)) return refuse(it, "The stored FMU state has values that no FMU has written. Use another one.");
    State *read = place(it);
    if (!read) return ERROR;
    read->moment = moment;
    *state = read;
    return OK;
}
