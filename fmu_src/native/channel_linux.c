/* Linux: one supervisor process for this library imports the model once and forks a worker for every instance.

   A channel is a file in memory that host and worker share: a head, whose `turn` both wait for as a futex, a place for
   the supervisor's last words on the worker, and room for one message. The supervisor takes orders over a socket
   (supervisor.py): "F", a number and the channel's file: fork a worker, answered by "R", or by "E" and why not; "K" and
   a number: kill it. When a worker ends, the supervisor writes why into the channel and takes its turn; when the host
   ends, the socket closes, and the supervisor kills the workers and ends. */

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
    REASON = 64,        /* where in the file the supervisor says why the worker ended */
    HEAD = 8192,        /* and where the message begins */
    FIRST_ROOM = 65536, /* bytes of a new channel */
    SOCKET = 3,         /* the supervisor's end */
};

/* seconds */
#define END_LIMIT 2.0
#define WATCH 0.05 /* between looks at the supervisor */

struct head {
    uint32_t turn, unused;
    uint64_t capacity, size, reason; /* bytes of the file, of the message, of the reason */
};

typedef struct {
    int socket, users;
    int foreign; /* it is that of the process from which this one was forked */
    pid_t process;
} Supervisor;

struct Channel {
    Supervisor *supervisor;
    uint64_t number;
    int file;
    size_t mapped;
    struct head *head;
};

static Supervisor *current;
static Supervisor *starting; /* not ready yet; then it is `current` */
static uint64_t channels;
static Lock supervisor_lock = LOCK_INITIAL;

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
    struct pollfd end = {supervisor->socket, 0, 0}; /* without events: only the other side's end */
    return supervisor->foreign || poll(&end, 1, 0) > 0;
}

static void release(Supervisor *supervisor) {
    if (--supervisor->users) return;
    if (supervisor->socket >= 0) close(supervisor->socket);
    if (supervisor->process > 0) {
        double end = now() + END_LIMIT;
        const struct timespec pause = {0, 1000000};
        pid_t found;
        while (!(found = waitpid(supervisor->process, NULL, WNOHANG)) && now() < end) nanosleep(&pause, NULL);
        if (!found && kill(supervisor->process, SIGKILL) == 0) waitpid(supervisor->process, NULL, 0);
    }
    free(supervisor);
}

/* The workers are the parent's: a process that was forked from the host has none, and does not keep them alive. */
static void after_fork(void) {
    Supervisor *known[] = {current, starting};
    for (int i = 0; i < 2; i++)
        if (known[i]) {
            close(known[i]->socket);
            known[i]->socket = -1;
            known[i]->process = 0;
            known[i]->foreign = 1;
        }
    current = starting = NULL;
    supervisor_lock = (Lock)LOCK_INITIAL; /* another thread may have held it */
}

/* What pthread_atfork calls: by itself it leaves the handler behind when this library is unloaded, unless the compiler
   has seen to it. `current` stands for the library. */
int __register_atfork(void (*prepare)(void), void (*parent)(void), void (*child)(void), void *library);
void __cxa_finalize(void *library);

__attribute__((constructor)) static void loaded(void) { __register_atfork(NULL, NULL, after_fork, &current); }

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
    /* the model prints to where errors go; the host's Ctrl-C, signal mask and handlers are not the model's */
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    if (fcntl(2, F_GETFD) < 0) posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, 2, 1);
    posix_spawn_file_actions_adddup2(&files, end, SOCKET);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    errno = ENOMEM;
    if (start && environment)
        errno = posix_spawn(&supervisor->process, python, &files, &attributes, arguments, environment);
    int started = errno == 0;
    if (!started) {
        supervisor->process = 0;
        snprintf(why->text, sizeof why->text, "'%s' cannot be run (%s). %s", python, strerror(errno), PYTHON_HINT);
    }
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    free(environment);
    free(start);
    return started;
}

enum word { AGREED, REFUSED, GONE, LATE };

/* Wait for the supervisor's "R", or for "E" and the reason. */
static enum word heard(const Supervisor *supervisor, Reason *why) {
    struct pollfd word = {supervisor->socket, POLLIN, 0};
    double end = now() + START_LIMIT;
    ssize_t length = -1;
    errno = EINTR;
    while (length < 0 && errno == EINTR && now() < end)
        if (poll(&word, 1, (int)(1000.0 * (end - now())) + 1) > 0)
            length = recv(supervisor->socket, why->text, sizeof why->text - 1, 0);
    why->text[length > 0 ? length : 0] = 0;
    if (length > 0 && why->text[0] == 'R') return AGREED;
    if (length > 0) memmove(why->text, why->text + 1, (size_t)length);
    return length > 0 ? REFUSED : now() < end ? GONE : LATE;
}

/* Wait until it has imported the model. */
static int ready(const Supervisor *supervisor, const char *python, Reason *why) {
    enum word word = heard(supervisor, why);
    size_t used = word == REFUSED ? strlen(why->text) : 0;
    if (word == REFUSED)
        snprintf(why->text + used, sizeof why->text - used, "\nIt was run by '%s'. %s", python, PYTHON_HINT);
    else if (word != AGREED)
        snprintf(why->text, sizeof why->text, "'%s' %s. %s", python,
                 word == GONE ? "ended before it was ready" : "was not ready in time", PYTHON_HINT);
    return word == AGREED;
}

/* Descriptors above those that the new process is given, so that none of them is overwritten. */
static int socket_pair(int ends[2]) {
    int low[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, low)) return 0;
    for (int i = 0; i < 2; i++) {
        ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, SOCKET + 1);
        close(low[i]);
    }
    return ends[0] >= 0 && ends[1] >= 0;
}

static Supervisor *supervisor_new(const char *resources, Reason *why) {
    int ends[2] = {-1, -1};
    char *python = interpreter(resources, why);
    Supervisor *supervisor = python ? calloc(1, sizeof *supervisor) : NULL;
    int started = 0;
    if (supervisor) {
        supervisor->users = 1;
        supervisor->socket = -1;
        if (!socket_pair(ends))
            failed(why, "There is no socket for the model's process");
        else {
            supervisor->socket = ends[0];
            starting = supervisor;
            started = spawn(supervisor, resources, python, ends[1], why);
        }
        if (ends[1] >= 0) close(ends[1]);
        if (started) started = ready(supervisor, python, why);
        starting = NULL;
        if (!started) {
            release(supervisor);
            supervisor = NULL;
        }
    }
    free(python);
    return supervisor;
}

/* The supervisor, with one user more; started if there is none. */
static Supervisor *supervised(const char *resources, Reason *why) {
    if (current && hung_up(current)) {
        release(current);
        current = NULL;
    }
    if (!current) current = supervisor_new(resources, why);
    if (current) current->users++;
    return current;
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
    return sendmsg(supervisor->socket, &message, MSG_NOSIGNAL) == (ssize_t)sizeof bytes;
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
             "There was no answer within %g s, so it was killed. TRIBOFMU_TIMEOUT sets the limit; a start has %d s.",
             limit, START_LIMIT);
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

/* Wait for the worker's answer. Signals to the host may end each wait early: what is looked at goes by the clock. */
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
    lock(&supervisor_lock);
    if (channel->supervisor) release(channel->supervisor);
    unlock(&supervisor_lock);
    munmap(channel->head, channel->mapped);
    close(channel->file);
    free(channel);
}

/* Order a worker for the channel: of a new supervisor if the present one is lost meanwhile. One that does not answer is
   killed, as what it might say later would be taken for the answer to another order. */
static int worker_ordered(Channel *channel, const char *resources, Reason *why) {
    enum word word = GONE;
    lock(&supervisor_lock);
    channel->number = ++channels;
    for (int attempt = 0; attempt < 2 && word == GONE; attempt++) {
        channel->supervisor = supervised(resources, why);
        if (!channel->supervisor) {
            unlock(&supervisor_lock);
            return 0;
        }
        if (order(channel->supervisor, 'F', channel->number, channel->file)) word = heard(channel->supervisor, why);
        if (word == LATE) kill(channel->supervisor->process, SIGKILL);
        if (word != AGREED) {
            release(channel->supervisor);
            channel->supervisor = NULL;
        }
    }
    unlock(&supervisor_lock);
    if (word == GONE || word == LATE)
        snprintf(why->text, sizeof why->text, "Its supervisor %s.", word == GONE ? "ended" : "did not answer in time");
    return word == AGREED;
}

Channel *channel_open(const char *resources, const void *message, size_t *size, double limit, Reason *why) {
    Channel *channel = channel_new(why);
    unsigned char *room = channel ? channel_room(channel, *size) : NULL;
    if (room) {
        memcpy(room, message, *size);
        channel->head->size = *size;
        channel->head->turn = WORKER;
        if (worker_ordered(channel, resources, why) && answered(channel, limit, why)) {
            *size = channel->head->size;
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
    if (turn_of(channel) == LOST) return !lost_because(channel, why);
    return hung_up(channel->supervisor) && !supervisor_lost(why);
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
