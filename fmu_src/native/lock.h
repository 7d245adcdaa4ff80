/* A mutex that needs no initialisation call. */

#ifndef LOCK_H
#define LOCK_H

#ifdef _WIN32
#include <windows.h>
typedef SRWLOCK Lock;
#define LOCK_INITIAL SRWLOCK_INIT
static inline void lock(Lock *held) { AcquireSRWLockExclusive(held); }
static inline void unlock(Lock *held) { ReleaseSRWLockExclusive(held); }
#else
#include <pthread.h>
typedef pthread_mutex_t Lock;
#define LOCK_INITIAL PTHREAD_MUTEX_INITIALIZER
static inline void lock(Lock *held) { pthread_mutex_lock(held); }
static inline void unlock(Lock *held) { pthread_mutex_unlock(held); }
#endif

#endif
