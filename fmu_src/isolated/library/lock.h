/* A mutex that needs no initialisation call. */

#ifndef LOCK_H
#define LOCK_H

#ifdef _WIN32
/* An SRWLOCK of channel_windows.c: windows.h would claim names of message.h. */
typedef struct {
    void *word;
} Lock;
#define LOCK_INITIAL {0}
void lock(Lock *held);
void unlock(Lock *held);
#else
#include <pthread.h>
typedef pthread_mutex_t Lock;
#define LOCK_INITIAL PTHREAD_MUTEX_INITIALIZER
static inline void lock(Lock *held) { pthread_mutex_lock(held); }
static inline void unlock(Lock *held) { pthread_mutex_unlock(held); }
#endif

/* The lock of all data shared by instances, in channel_*.c. It is held for milliseconds at most, never while waiting
   for another process. A fork of the host takes it, so that the data are consistent in the child. */
extern Lock shared_lock;

#endif
