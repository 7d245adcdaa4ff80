/* Linux: one supervisor process for this library imports the model once and forks a worker for every instance.

   A channel is a file in memory shared by host and worker (shared_memory.py): a head, whose `turn` both wait for as a
   futex, a place for the supervisor's report on a lost worker, and room for one message. The supervisor receives
   orders over a socket (supervisor.py): "F", a number and the channel's file: fork a worker, answered by "R", or by "E"
   and the reason; "K" and a number: kill it. When a worker ends, the supervisor writes the reason into the channel and
   takes the worker's turn; when the host ends, the socket closes, and the supervisor kills the workers and ends. The
   lock on the file shows the end of a worker earlier: it is then free.

   The supervisor is no child of the host, which may wait for all of its children: the started process forks it and ends
   (start.py). The two have a process group of their own, by which they can be killed. */

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "channel.h"
#include "lock.h"
#include "python.h"

enum turn { NOBODY, WORKER, HOST, LOST };

enum {
    REASON = 64,        /* offset of the supervisor's report on a lost worker */
    HEAD = 8192,        /* offset of the message */
    FIRST_ROOM = 65536, /* size of a new channel */
    SOCKET = 3,         /* the supervisor's end */
};

/* seconds */
#define END_LIMIT 2.0
#define WATCH 0.05 /* between looks at the supervisor */
#define ORDER_LIMIT 10.0 /* a fork takes milliseconds; a slower supervisor counts as lost, with its workers */

struct head {
    uint32_t turn, unused;
    uint64_t capacity, size, reason; /* bytes of the file, of the message, of the reason */
};

typedef struct {
    int socket, users;
    int foreign; /* it belongs to the process from which this one was forked */
    pid_t group;
} Supervisor;

struct Channel {
    Supervisor *supervisor;
    uint64_t number;
    int file;
    int watched; /* the worker holds a lock on the file while it lives */
    size_t mapped;
    struct head *head;
};

Lock shared_lock = LOCK_INITIAL; /* here: the supervisors and their users */
static Lock talk_lock = LOCK_INITIAL; /* orders that wait for an answer, start included */
static Supervisor *current;
static Supervisor *starting; /* not ready yet; then it is `current` */
static uint64_t channels;

static int failed(Reason *why, const char *what) {
    snprintf(why->text, sizeof why->text, "%s (%s).", what, strerror(errno));
    return 0;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* supervisor */

static int hung_up(const Supervisor *supervisor) {
    struct pollfd end = {supervisor->socket, 0, 0}; /* no events: only a hang-up is reported */
    return supervisor->foreign || poll(&end, 1, 0) > 0;
}

/* True if the supervisor ends within `seconds`: its end of the socket closes with it. */
static int ends_within(const Supervisor *supervisor, double seconds) {
    struct pollfd end = {supervisor->socket, 0, 0};
    double last = now() + seconds;
    int found = 0;
    while (!found && now() < last) found = poll(&end, 1, (int)(1000.0 * (last - now())) + 1) > 0;
    return found;
}

static void kill_group(const Supervisor *supervisor) {
    if (supervisor->group > 0 && !hung_up(supervisor)) kill(-supervisor->group, SIGKILL); /* else it may be reused */
}

/* End a supervisor without users. */
static void finish(Supervisor *supervisor) {
    if (!supervisor->foreign && supervisor->socket >= 0) {
        shutdown(supervisor->socket, SHUT_WR);
        if (!ends_within(supervisor, END_LIMIT)) {
            kill_group(supervisor);
            ends_within(supervisor, END_LIMIT);
        }
        close(supervisor->socket);
    }
    free(supervisor);
}

static void release(Supervisor *supervisor) {
    lock(&shared_lock);
    int left = --supervisor->users;
    unlock(&shared_lock);
    if (!left) finish(supervisor);
}

/* The lock keeps shared data consistent in a forked child. The workers belong to the parent: the child has none, and
   does not keep them alive. */
static void before_fork(void) { lock(&shared_lock); }

static void after_fork(void) { unlock(&shared_lock); }

static void after_fork_in_child(void) {
    Supervisor *known[] = {current, starting};
    for (int i = 0; i < 2; i++)
        if (known[i]) {
            close(known[i]->socket);
            known[i]->socket = -1;
            known[i]->foreign = 1;
        }
    current = starting = NULL;
    shared_lock = talk_lock = (Lock)LOCK_INITIAL; /* another thread may have held it */
}

/* Called directly instead of by pthread_atfork, which would leave the handlers registered when this library is unloaded
   (unless the compiler prevents it). The address of `current` identifies the library. */
int __register_atfork(void (*prepare)(void), void (*parent)(void), void (*child)(void), void *library);
void __cxa_finalize(void *library);

__attribute__((constructor)) static void loaded(void) {
    __register_atfork(before_fork, after_fork, after_fork_in_child, &current);
}

__attribute__((destructor)) static void unloaded(void) {
    __cxa_finalize(&current);
    if (current) {
        current->users = 1;
        release(current);
    }
    current = NULL;
}

static int spawn(Supervisor *supervisor, const char *resources, const char *python, int end, Reason *why) {
    char *start = joined(resources, "start.py");
    char *const arguments[] = {(char *)python, "-I", start, NULL};
    char **environment = clean_environment();
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t signals;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    /* the model prints to stderr; it does not inherit the host's Ctrl-C, signal mask and handlers */
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    if (fcntl(2, F_GETFD) < 0) posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, 2, 1);
    posix_spawn_file_actions_adddup2(&files, end, SOCKET);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setpgroup(&attributes, 0);
    /* else old C libraries use fork, which calls our handlers, and these wait for the lock held here */
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP |
                                              POSIX_SPAWN_USEVFORK);
    errno = ENOMEM;
    if (start && environment)
        errno = posix_spawn(&supervisor->group, python, &files, &attributes, arguments, environment);
    int started = errno == 0;
    if (!started) {
        supervisor->group = 0;
        snprintf(why->text, sizeof why->text, "'%s' cannot be run (%s). %s", python, strerror(errno), PYTHON_HINT);
    }
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    free(environment);
    free(start);
    return started;
}

enum word { AGREED, REFUSED, GONE, LATE };

/* Wait for the supervisor's "R", or for "E" and the reason, at most `limit` seconds. */
static enum word heard(const Supervisor *supervisor, double limit, Reason *why) {
    struct pollfd word = {supervisor->socket, POLLIN, 0};
    double last = now() + limit;
    ssize_t length = -1;
    errno = EINTR;
    while (length < 0 && errno == EINTR && now() < last)
        if (poll(&word, 1, (int)(1000.0 * (last - now() < 1e6 ? last - now() : 1e6)) + 1) > 0)
            length = recv(supervisor->socket, why->text, sizeof why->text - 1, 0);
    why->text[length > 0 ? length : 0] = 0;
    if (length > 0 && why->text[0] == 'R') return AGREED;
    if (length > 0) memmove(why->text, why->text + 1, (size_t)length);
    return length > 0 ? REFUSED : now() < last ? GONE : LATE;
}

/* Wait until it has imported the model, at most `limit` seconds; the process that forked it has ended then. */
static int ready(const Supervisor *supervisor, const char *python, double limit, Reason *why) {
    enum word word = heard(supervisor, limit, why);
    size_t used = word == REFUSED ? strlen(why->text) : 0;
    if (word == REFUSED)
        snprintf(why->text + used, sizeof why->text - used, "\nIt was run by '%s'. %s", python, PYTHON_HINT);
    else if (word == LATE)
        snprintf(why->text, sizeof why->text,
                 "'%s' was not ready within %g s. TRIBOFMU_START_TIMEOUT sets the limit of a start. %s", python, limit,
                 PYTHON_HINT);
    else if (word == GONE)
        snprintf(why->text, sizeof why->text, "'%s' ended before it was ready. %s", python, PYTHON_HINT);
    if (word != AGREED) kill(-supervisor->group, SIGKILL);
    while (waitpid(supervisor->group, NULL, 0) < 0 && errno == EINTR) continue;
    return word == AGREED;
}

/* Descriptors above those given to the new process, so that none of them is overwritten. */
static int socket_pair(int ends[2]) {
    int low[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, low)) return 0;
    for (int i = 0; i < 2; i++) {
        ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, SOCKET + 1);
        close(low[i]);
    }
    return ends[0] >= 0 && ends[1] >= 0;
}

static Supervisor *supervisor_new(const char *resources, double limit, Reason *why) {
    int ends[2] = {-1, -1};
    char *python = interpreter(resources, why);
    Supervisor *supervisor = python ? calloc(1, sizeof *supervisor) : NULL;
    int started = 0;
    if (supervisor) {
        supervisor->users = 1;
        supervisor->socket = -1;
        lock(&shared_lock); /* a forked child must not hold an end: it would hide that the other end is closed */
        if (!socket_pair(ends))
            failed(why, "There is no socket for the model's process");
        else {
            supervisor->socket = ends[0];
            starting = supervisor;
            started = spawn(supervisor, resources, python, ends[1], why);
        }
        if (ends[1] >= 0) close(ends[1]);
        unlock(&shared_lock);
        if (started) started = ready(supervisor, python, limit, why);
        lock(&shared_lock);
        starting = NULL;
        unlock(&shared_lock);
        if (!started) {
            release(supervisor);
            supervisor = NULL;
        }
    }
    free(python);
    return supervisor;
}

/* The current supervisor, with its users counted up by one, if there is one. */
static Supervisor *present(void) {
    lock(&shared_lock);
    Supervisor *found = current && !hung_up(current) ? current : NULL;
    if (found) found->users++;
    unlock(&shared_lock);
    return found;
}

/* Replace the current supervisor by `next`, which may be NULL. */
static void replace(Supervisor *next) {
    lock(&shared_lock);
    Supervisor *before = current;
    current = next;
    unlock(&shared_lock);
    if (before) release(before);
}

static int order(const Supervisor *supervisor, char what, uint64_t number, int file) {
    char bytes[16] = {what};
    union {
        struct cmsghdr head;
        char room[CMSG_SPACE(sizeof(int))];
    } control;
    struct iovec data = {bytes, sizeof bytes};
    struct msghdr message = {.msg_iov = &data, .msg_iovlen = 1};
    memcpy(bytes + 8, &number, sizeof number);
    if (file >= 0) {
        memset(&control, 0, sizeof control);
        message.msg_control = control.room;
        message.msg_controllen = sizeof control.room;
        control.head = (struct cmsghdr){.cmsg_level = SOL_SOCKET, .cmsg_type = SCM_RIGHTS,
                                        .cmsg_len = CMSG_LEN(sizeof(int))};
        memcpy(CMSG_DATA(&control.head), &file, sizeof file);
    }
    /* a stopped process takes no more orders at some time */
    return sendmsg(supervisor->socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT) == (ssize_t)sizeof bytes;
}

/* turns */

static enum turn turn_of(const Channel *channel) { return __atomic_load_n(&channel->head->turn, __ATOMIC_ACQUIRE); }

static int give_turn(Channel *channel, size_t size) {
    uint32_t before = turn_of(channel);
    channel->head->size = size;
    if (before == LOST ||
        !__atomic_compare_exchange_n(&channel->head->turn, &before, WORKER, 0, __ATOMIC_SEQ_CST, __ATOMIC_ACQUIRE))
        return 0;
    syscall(SYS_futex, &channel->head->turn, FUTEX_WAKE, 1, NULL, NULL, 0);
    return 1;
}

static int lost_because(Channel *channel, Reason *why) {
    enum { MOST = sizeof why->text - 1 < HEAD - REASON ? sizeof why->text - 1 : HEAD - REASON };
    size_t size = channel->head->reason < MOST ? channel->head->reason : MOST;
    memcpy(why->text, (char *)channel->head + REASON, size);
    why->text[size] = 0;
    return 0;
}

static int supervisor_lost(Reason *why) {
    snprintf(why->text, sizeof why->text, "Its supervisor ended.");
    return 0;
}

static int timed_out(Channel *channel, double limit, Reason *why) {
    snprintf(why->text, sizeof why->text,
             "There was no answer within %g s, so it was killed. TRIBOFMU_TIMEOUT sets the limit of a call, "
             "TRIBOFMU_START_TIMEOUT that of a start.",
             limit);
    order(channel->supervisor, 'K', channel->number, -1);
    return 0;
}

static int mapped_whole(Channel *channel) {
    size_t capacity = channel->head->capacity;
    if (capacity <= channel->mapped) return 1;
    void *place = mremap(channel->head, channel->mapped, capacity, MREMAP_MAYMOVE);
    if (place == MAP_FAILED) return 0;
    channel->head = place;
    channel->mapped = capacity;
    return 1;
}

/* Wait for the worker's answer. Signals to the host may end each wait early, so limits are checked by the clock. */
static int answered(Channel *channel, double limit, Reason *why) {
    double start = now(), end = start + limit, look = start + WATCH;
    const struct timespec watch = {0, (long)(1e9 * WATCH)};
    enum turn turn;
    while ((turn = turn_of(channel)) == WORKER) {
        if (!syscall(SYS_futex, &channel->head->turn, FUTEX_WAIT, WORKER, &watch, NULL, 0)) continue;
        double time = now();
        if (time < look) continue;
        if (hung_up(channel->supervisor)) return supervisor_lost(why);
        if (limit > 0.0 && time > end) return timed_out(channel, limit, why);
        look = time + WATCH;
    }
    if (turn == LOST) return lost_because(channel, why);
    return mapped_whole(channel) || failed(why, "There is no memory for its answer");
}

/* channels */

static int locked(const Channel *channel) { return flock(channel->file, LOCK_SH | LOCK_NB) && errno == EWOULDBLOCK; }

static Channel *channel_new(Reason *why) {
    Channel *channel = calloc(1, sizeof *channel);
    if (!channel) return NULL;
    channel->file = (int)syscall(SYS_memfd_create, "tribofmu", 1u /* close on exec */);
    channel->mapped = FIRST_ROOM;
    void *place = channel->file < 0 || ftruncate(channel->file, FIRST_ROOM)
                      ? MAP_FAILED
                      : mmap(NULL, FIRST_ROOM, PROT_READ | PROT_WRITE, MAP_SHARED, channel->file, 0);
    if (place == MAP_FAILED) {
        failed(why, "There is no shared memory for its messages");
        if (channel->file >= 0) close(channel->file);
        free(channel);
        return NULL;
    }
    channel->head = place;
    channel->head->capacity = FIRST_ROOM;
    return channel;
}

static void channel_free(Channel *channel) {
    if (channel->supervisor) release(channel->supervisor);
    munmap(channel->head, channel->mapped);
    close(channel->file);
    free(channel);
}

/* Ask a supervisor to fork a worker for the channel. */
static enum word worker_asked(Channel *channel, Supervisor *supervisor, double limit, Reason *why) {
    channel->supervisor = supervisor;
    enum word word = GONE;
    if (order(supervisor, 'F', channel->number, channel->file)) word = heard(supervisor, limit, why);
    if (word == LATE) kill_group(supervisor); /* its late answer would be taken for that to another order */
    if (word != AGREED) {
        channel->supervisor = NULL;
        release(supervisor);
    }
    return word;
}

/* Order a worker for the channel, from a new supervisor if the current one is lost or does not answer. */
static int worker_ordered(Channel *channel, const char *resources, Limits limits, Reason *why) {
    double soon = limits.start < ORDER_LIMIT ? limits.start : ORDER_LIMIT;
    lock(&talk_lock);
    channel->number = ++channels;
    Supervisor *supervisor = present();
    enum word word = supervisor ? worker_asked(channel, supervisor, soon, why) : GONE;
    if (word == GONE || word == LATE) {
        replace(NULL);
        replace(supervisor_new(resources, limits.start, why));
        supervisor = present();
        if (!supervisor) {
            unlock(&talk_lock);
            return 0;
        }
        word = worker_asked(channel, supervisor, limits.start, why);
    }
    unlock(&talk_lock);
    if (word == GONE || word == LATE)
        snprintf(why->text, sizeof why->text, "Its supervisor %s.", word == GONE ? "ended" : "did not answer in time");
    return word == AGREED;
}

Channel *channel_open(const char *resources, const void *message, size_t *size, Limits limits, Reason *why) {
    Channel *channel = channel_new(why);
    unsigned char *room = channel ? channel_room(channel, *size) : NULL;
    if (room) {
        memcpy(room, message, *size);
        channel->head->size = *size;
        channel->head->turn = WORKER;
        if (worker_ordered(channel, resources, limits, why) && answered(channel, limits.start, why)) {
            *size = channel->head->size;
            channel->watched = locked(channel);
            return channel;
        }
    }
    if (channel) channel_free(channel);
    return NULL;
}

unsigned char *channel_room(Channel *channel, size_t size) {
    size_t needed = HEAD + size;
    if (needed > channel->mapped) {
        size_t capacity = 2 * needed;
        if (ftruncate(channel->file, (off_t)capacity)) return NULL;
        channel->head->capacity = capacity;
        if (!mapped_whole(channel)) return NULL;
    }
    return (unsigned char *)channel->head + HEAD;
}

int channel_call(Channel *channel, size_t *size, double limit, Reason *why) {
    if (!give_turn(channel, *size)) return lost_because(channel, why);
    if (!answered(channel, limit, why)) return 0;
    *size = channel->head->size;
    return 1;
}

const unsigned char *channel_answer(const Channel *channel) { return (unsigned char *)channel->head + HEAD; }

int channel_lost(Channel *channel, Reason *why) {
    const struct timespec pause = {0, 1000000};
    double last = now() + END_LIMIT;
    while (turn_of(channel) != LOST) {
        if (hung_up(channel->supervisor)) return !supervisor_lost(why);
        if (!channel->watched || locked(channel)) return 0;
        if (now() > last) return snprintf(why->text, sizeof why->text, "Its supervisor does not say why.") > 0;
        nanosleep(&pause, NULL);
    }
    return !lost_because(channel, why);
}

int channel_ours(Channel *channel, Reason *why) {
    if (!channel->supervisor->foreign) return 1;
    snprintf(why->text, sizeof why->text, "It belongs to the process from which this one was forked.");
    return 0;
}

void channel_close(Channel *channel, const void *message, size_t size) {
    if (!channel->supervisor->foreign) {
        unsigned char *room = message && turn_of(channel) != WORKER ? channel_room(channel, size) : NULL;
        if (room) memcpy(room, message, size);
        if (!room || !give_turn(channel, size)) order(channel->supervisor, 'K', channel->number, -1);
    }
    channel_free(channel);
}
