/* Sequential writing and reading of bytes. */

#ifndef BUFFER_H
#define BUFFER_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define PADDED(n) (((n) + 7u) & ~(size_t)7u) /* items of messages begin at multiples of 8 bytes */

typedef struct {
    unsigned char *bytes;
    size_t size, room;
} Buffer;

typedef struct {
    const unsigned char *at, *end;
} Reader;

/* Extend the buffer by `size` bytes and return their place; NULL without memory. */
static inline unsigned char *extended(Buffer *buffer, size_t size) {
    if (buffer->size + size > buffer->room) {
        size_t room = 2 * (buffer->size + size);
        unsigned char *bytes = realloc(buffer->bytes, room);
        if (!bytes) return NULL;
        buffer->bytes = bytes;
        buffer->room = room;
    }
    unsigned char *place = buffer->bytes + buffer->size;
    buffer->size += size;
    return place;
}

/* Copy bytes to `to` and return the place after them. */
static inline unsigned char *append(unsigned char *to, const void *bytes, size_t size) {
    if (size) memcpy(to, bytes, size);
    return to + size;
}

/* The next `size` bytes; NULL if there are fewer. */
static inline const void *taken(Reader *reader, size_t size) {
    if ((size_t)(reader->end - reader->at) < size) return NULL;
    const void *place = reader->at;
    reader->at += size;
    return place;
}

#endif
