/* One worker process, which runs the model of one FMU instance: a message goes in, an answer comes out.

   channel_linux.c and channel_windows.c implement it; message.h says what the messages hold. */

#ifndef CHANNEL_H
#define CHANNEL_H

#include <stddef.h>

#define START_LIMIT 120.0 /* default [s]: imports, with kernels not yet compiled */

typedef struct Channel Channel;

/* Time limits [s] of a call (0: none) and of a worker's start. */
typedef struct {
    double call, start;
} Limits;

/* Reason of a failure: a message for the host's log, and the worker's last output. */
typedef struct {
    char text[8192];
} Reason;

/* Folder of the FMU's resources, to be freed by the caller: beside this library, else at `place`, a URI (FMI 2.0)
   or a path (FMI 3.0); NULL and a reason if there is none. */
char *channel_resources(const char *place, Reason *why);

/* Start a worker for the FMU with these resources, give it the first message in `message` and wait for its answer
   as channel_call does. NULL and a reason if there is no worker or no answer. */
Channel *channel_open(const char *resources, const void *message, size_t *size, Limits limits, Reason *why);

/* Room for the next message of `size` bytes; keeps what has been written of it. NULL without memory. */
unsigned char *channel_room(Channel *channel, size_t size);

/* Send the message of *size bytes in the room and wait, at most `limit` seconds (0: as long as it takes). Returns 1
   with the answer's length in *size. Returns 0 and a reason if the worker is lost; then only channel_close is left. */
int channel_call(Channel *channel, size_t *size, double limit, Reason *why);

/* The answer of the last call, until the next channel_room. */
const unsigned char *channel_answer(const Channel *channel);

/* True if the worker has been lost since the last call, with the reason. */
int channel_lost(Channel *channel, Reason *why);

/* True if the worker belongs to this process and not to the one from which this process was forked. */
int channel_ours(Channel *channel, Reason *why);

/* End the worker, without waiting for it, and free the channel. `message` (of `size` bytes) asks it to go. */
void channel_close(Channel *channel, const void *message, size_t size);

#endif
