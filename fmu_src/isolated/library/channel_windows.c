/* Windows: a process of its own for every worker, without a supervisor, as there is no fork.

   A message is its length (uint64) and its bytes, to the worker's stdin and from its stdout. The worker is in a job
   that ends with its last handle, so it ends with the host in any case. Its stderr goes to a temporary file, which is
   read when the worker is lost. */

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "channel.h"
#include "lock.h"
#include "python.h"

#define END_LIMIT 1000 /* milliseconds a worker may take to end after its pipes have closed */

enum outcome { DONE, LOST, LATE, TOO_LONG };

struct Channel {
    HANDLE job, process;
    HANDLE requests, answers; /* our ends of the pipes */
    HANDLE moved;             /* event: bytes went through a pipe */
    HANDLE complaints;        /* the worker's stderr */
    uint64_t *room;           /* length of a message, then the message */
    size_t capacity;          /* of a message */
};

Lock shared_lock = LOCK_INITIAL;

void lock(Lock *held) { AcquireSRWLockExclusive((SRWLOCK *)held); }

void unlock(Lock *held) { ReleaseSRWLockExclusive((SRWLOCK *)held); }

/* the worker's process */

static void close_handle(HANDLE handle) {
    if (handle && handle != INVALID_HANDLE_VALUE) CloseHandle(handle);
}

static HANDLE job_new(void) {
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = {0};
    /* second flag: no dialog when the worker crashes */
    limits.BasicLimitInformation.LimitFlags =
        JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE | JOB_OBJECT_LIMIT_DIE_ON_UNHANDLED_EXCEPTION;
    HANDLE job = CreateJobObjectW(NULL, NULL);
    if (job && !SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits)) {
        CloseHandle(job);
        job = NULL;
    }
    return job;
}

/* A named pipe, as only these can be waited for: our end, and the worker's, which it inherits. */
static HANDLE pipe_new(DWORD direction, HANDLE *workers) {
    static volatile LONG count;
    SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, TRUE};
    char name[128];
    snprintf(name, sizeof name, "\\\\.\\pipe\\tribofmu-%lu-%p-%ld", GetCurrentProcessId(), (void *)&count,
             InterlockedIncrement(&count));
    HANDLE end = CreateNamedPipeA(name, direction | FILE_FLAG_OVERLAPPED | FILE_FLAG_FIRST_PIPE_INSTANCE,
                                  PIPE_TYPE_BYTE | PIPE_REJECT_REMOTE_CLIENTS, 1, 65536, 65536, 0, NULL);
    *workers = INVALID_HANDLE_VALUE;
    if (end != INVALID_HANDLE_VALUE)
        *workers = CreateFileA(name, direction == PIPE_ACCESS_OUTBOUND ? GENERIC_READ : GENERIC_WRITE, 0, &inherited,
                               OPEN_EXISTING, 0, NULL);
    return end;
}

/* A file that is deleted with its last handle; the null device where none can be made. */
static HANDLE scratch_new(void) {
    SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, TRUE};
    const DWORD access = GENERIC_READ | GENERIC_WRITE;
    const DWORD shared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
    wchar_t folder[MAX_PATH + 1], name[MAX_PATH];
    HANDLE file = INVALID_HANDLE_VALUE;
    if (GetTempPathW(MAX_PATH + 1, folder) && GetTempFileNameW(folder, L"fmu", 0, name))
        file = CreateFileW(name, access, shared, &inherited, CREATE_ALWAYS,
                           FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    if (file == INVALID_HANDLE_VALUE) file = CreateFileW(L"NUL", access, shared, &inherited, OPEN_EXISTING, 0, NULL);
    return file;
}

/* The process, in the job from its start, with the given stdin, stdout and stderr and no other handle. */
static int spawn(Channel *channel, const wchar_t *python, wchar_t *command, HANDLE ends[3]) {
    STARTUPINFOEXW startup = {0};
    PROCESS_INFORMATION process;
    SIZE_T size = 0;
    InitializeProcThreadAttributeList(NULL, 2, 0, &size);
    LPPROC_THREAD_ATTRIBUTE_LIST list = malloc(size);
    wchar_t *environment = clean_environment();
    startup.lpAttributeList = list;
    startup.StartupInfo.cb = sizeof startup;
    startup.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
    startup.StartupInfo.hStdInput = ends[0];
    startup.StartupInfo.hStdOutput = ends[1];
    startup.StartupInfo.hStdError = ends[2];
    int prepared = list && environment && InitializeProcThreadAttributeList(list, 2, 0, &size);
    int spawned = prepared &&
                  UpdateProcThreadAttribute(list, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, ends, 3 * sizeof *ends, NULL,
                                            NULL) &&
                  UpdateProcThreadAttribute(list, 0, PROC_THREAD_ATTRIBUTE_JOB_LIST, &channel->job,
                                            sizeof channel->job, NULL, NULL) &&
                  CreateProcessW(python, command, NULL, NULL, TRUE,
                                 CREATE_NO_WINDOW | CREATE_UNICODE_ENVIRONMENT | EXTENDED_STARTUPINFO_PRESENT,
                                 environment, NULL, &startup.StartupInfo, &process);
    DWORD error = GetLastError();
    if (spawned) {
        channel->process = process.hProcess;
        CloseHandle(process.hThread);
    }
    if (prepared) DeleteProcThreadAttributeList(list);
    free(environment);
    free(list);
    SetLastError(error);
    return spawned;
}

/* Paths contain no quotation marks. UTF-8 mode: the worker's stderr is read as UTF-8. */
static wchar_t *command_line(const char *resources, const char *python) {
    static const char form[] = "\"%s\" -I -X utf8 \"%s\" --pipe";
    char *start = joined(resources, "start.py");
    size_t size = start ? sizeof form + strlen(python) + strlen(start) : 0;
    char *text = start ? malloc(size) : NULL;
    if (text) snprintf(text, size, form, python, start);
    wchar_t *command = text ? wide(text) : NULL;
    free(text);
    free(start);
    return command;
}

/* messages */

static DWORD milliseconds_left(ULONGLONG end) {
    ULONGLONG now = GetTickCount64();
    if (!end) return INFINITE;
    return now >= end ? 0 : end - now < INFINITE ? (DWORD)(end - now) : INFINITE - 1;
}

/* Write or read `size` bytes; `end` in milliseconds of the system's clock, or 0. */
static enum outcome move(Channel *channel, HANDLE pipe, void *bytes, size_t size, ULONGLONG end) {
    enum { MOST = 1 << 20 };
    const HANDLE awaited[2] = {channel->moved, channel->process};
    for (unsigned char *at = bytes; size;) {
        OVERLAPPED transfer = {.hEvent = channel->moved};
        DWORD part = size < MOST ? (DWORD)size : MOST, count = 0;
        BOOL begun = pipe == channel->requests ? WriteFile(pipe, at, part, NULL, &transfer)
                                               : ReadFile(pipe, at, part, NULL, &transfer);
        if (!begun && GetLastError() != ERROR_IO_PENDING) return LOST;
        DWORD event = WaitForMultipleObjects(2, awaited, FALSE, milliseconds_left(end));
        if (event != WAIT_OBJECT_0) CancelIoEx(pipe, &transfer);
        if (!GetOverlappedResult(pipe, &transfer, &count, TRUE) || !count) return event == WAIT_TIMEOUT ? LATE : LOST;
        at += count;
        size -= count;
    }
    return DONE;
}

/* Append the end of the worker's stderr, as far as there is room. */
static void quote(HANDLE complaints, Reason *why) {
    LARGE_INTEGER size;
    size_t used = strlen(why->text), room = sizeof why->text - used - 2;
    if (!GetFileSizeEx(complaints, &size) || !size.QuadPart) return;
    ULONGLONG from = (ULONGLONG)size.QuadPart > room ? (ULONGLONG)size.QuadPart - room : 0;
    OVERLAPPED place = {.Offset = (DWORD)from, .OffsetHigh = (DWORD)(from >> 32)};
    char *text = why->text + used + 1, *to = text;
    DWORD count = 0;
    why->text[used] = '\n';
    ReadFile(complaints, text, (DWORD)room, &count, &place);
    for (const char *at = text; at < text + count; at++) {
        int torn = from && to == text && (*at & 0xC0) == 0x80; /* the rest of a character */
        if (!torn && *at && *at != '\r') *to++ = *at;
    }
    *to = 0;
}

/* Read a message of at most `most` bytes into the room. */
static enum outcome receive(Channel *channel, size_t *size, size_t most, ULONGLONG end) {
    uint64_t length = 0;
    enum outcome outcome = move(channel, channel->answers, &length, sizeof length, end);
    if (outcome != DONE) return outcome;
    if (length > most || !channel_room(channel, (size_t)length)) return TOO_LONG;
    *size = (size_t)length;
    return move(channel, channel->answers, channel->room + 1, *size, end);
}

/* Give the reason, and make sure that the worker has ended. */
static int lost_because(Channel *channel, enum outcome outcome, double limit, Reason *why) {
    DWORD code = 0;
    if (outcome == LATE)
        snprintf(why->text, sizeof why->text,
                 "There was no answer within %g s, so it was killed. TRIBOFMU_TIMEOUT sets the limit of a call, "
                 "TRIBOFMU_START_TIMEOUT that of a start.",
                 limit);
    else if (outcome == TOO_LONG)
        snprintf(why->text, sizeof why->text, "There is no room for its answer, so it was killed.");
    else if (!WaitForSingleObject(channel->process, END_LIMIT) && GetExitCodeProcess(channel->process, &code))
        snprintf(why->text, sizeof why->text, "It ended with exit code %lu (0x%lX).", code, code);
    else
        snprintf(why->text, sizeof why->text, "It closed its pipes, so it was killed.");
    TerminateJobObject(channel->job, 1);
    quote(channel->complaints, why);
    return 0;
}

/* Wait for "R", or for "E" and the reason. */
static int ready(Channel *channel, const char *python, ULONGLONG end, Reason *why) {
    size_t size = 0;
    enum outcome outcome = receive(channel, &size, sizeof why->text / 2, end);
    const char *text = (const char *)channel_answer(channel);
    if (outcome == DONE && size && *text == 'R') return 1;
    if (outcome == DONE && size && *text == 'E')
        snprintf(why->text, sizeof why->text, "%.*s\nIt was run by '%s'. %s", (int)size - 1, text + 1, python,
                 PYTHON_HINT);
    else {
        snprintf(why->text, sizeof why->text, "'%s' %s. %s", python,
                 outcome == LATE ? "was not ready in time, which TRIBOFMU_START_TIMEOUT sets"
                                 : "ended before it was ready",
                 PYTHON_HINT);
        quote(channel->complaints, why);
    }
    return 0;
}

/* channels */

static int worker_new(Channel *channel, const char *resources, ULONGLONG end, Reason *why) {
    char text[256], *python = interpreter(resources, why);
    if (!python) return 0;
    HANDLE ends[3];
    wchar_t *command = command_line(resources, python), *program = wide(python);
    channel->job = job_new();
    channel->moved = CreateEventW(NULL, TRUE, FALSE, NULL);
    channel->requests = pipe_new(PIPE_ACCESS_OUTBOUND, &ends[0]);
    channel->answers = pipe_new(PIPE_ACCESS_INBOUND, &ends[1]);
    channel->complaints = ends[2] = scratch_new();
    int started = command && program && channel->job && channel->moved && spawn(channel, program, command, ends);
    if (!started)
        snprintf(why->text, sizeof why->text, "'%s' cannot be run (%s). %s", python, meaning(GetLastError(), text),
                 PYTHON_HINT);
    SetHandleInformation(channel->complaints, HANDLE_FLAG_INHERIT, 0);
    close_handle(ends[0]); /* only the worker holds them from now on, so that a pipe breaks with it */
    close_handle(ends[1]);
    if (started) started = ready(channel, python, end, why);
    free(program);
    free(command);
    free(python);
    return started;
}

static ULONGLONG end_of(double limit) { return limit > 0.0 ? GetTickCount64() + (ULONGLONG)(limit * 1000.0) : 0; }

Channel *channel_open(const char *resources, const void *message, size_t *size, Limits limits, Reason *why) {
    Channel *channel = calloc(1, sizeof *channel);
    unsigned char *room = channel ? channel_room(channel, *size) : NULL;
    snprintf(why->text, sizeof why->text, "There is no memory for its messages.");
    if (room && worker_new(channel, resources, end_of(limits.start), why) &&
        (room = channel_room(channel, *size)) != NULL) {
        memcpy(room, message, *size);
        if (channel_call(channel, size, limits.start, why)) return channel;
    }
    if (channel) channel_close(channel, NULL, 0);
    return NULL;
}

unsigned char *channel_room(Channel *channel, size_t size) {
    if (size > channel->capacity || !channel->room) {
        size_t capacity = 2 * size;
        uint64_t *room = realloc(channel->room, sizeof *room + capacity);
        if (!room) return NULL;
        channel->room = room;
        channel->capacity = capacity;
    }
    return (unsigned char *)(channel->room + 1);
}

int channel_call(Channel *channel, size_t *size, double limit, Reason *why) {
    ULONGLONG end = end_of(limit);
    channel->room[0] = *size;
    enum outcome outcome = move(channel, channel->requests, channel->room, sizeof *channel->room + *size, end);
    if (outcome == DONE) outcome = receive(channel, size, PTRDIFF_MAX / 4, end);
    return outcome == DONE || lost_because(channel, outcome, limit, why);
}

const unsigned char *channel_answer(const Channel *channel) { return (unsigned char *)(channel->room + 1); }

int channel_lost(Channel *channel, Reason *why) {
    int lost = WaitForSingleObject(channel->process, 0) != WAIT_TIMEOUT ||
               !PeekNamedPipe(channel->answers, NULL, 0, NULL, NULL, NULL);
    return lost && !lost_because(channel, LOST, 0.0, why);
}

int channel_ours(Channel *channel, Reason *why) {
    (void)channel, (void)why;
    return 1; /* Windows has no fork */
}

/* No request to quit is needed: between two calls the worker has nothing to lose, and it ends with its job. */
void channel_close(Channel *channel, const void *message, size_t size) {
    (void)message, (void)size;
    const HANDLE handles[] = {channel->requests, channel->answers, channel->job,
                              channel->process,  channel->moved,   channel->complaints};
    for (size_t k = 0; k < sizeof handles / sizeof *handles; k++) close_handle(handles[k]);
    free(channel->room);
    free(channel);
}
