#include "instance.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "channel.h"
#include "lock.h"
#include "python.h"
#include "state.h"

typedef struct {
    uint16_t kind, causality;
    double value;
    char *text; /* of a string */
} Variable;

struct Instance {
    struct Instance *next;
    void *library; /* kept loaded */
    char *name, *guid, *resources;
    Host host;
    enum { QUIET, USUAL, LOUD } logging; /* errors; warnings, too; all in `categories` */
    char **categories;                   /* NULL-terminated; NULL: all */
    Channel *worker;
    uint64_t life;       /* number of workers so far */
    Limits limits;
    enum phase phase;    /* stepping: outputs are valid until the next step, unless a direct input is set */
    int terminated;
    int set_up;          /* the host has set up the experiment */
    double experiment[3]; /* its arguments; states do not contain them */
    int mending;         /* a lost worker is replaced during this call */
    int stale;           /* outputs are older than the values they depend on */
    Variable *variables; /* by value reference */
    size_t count;
    uint32_t *outputs;
    size_t outputs_count;
    uint64_t texts;   /* number of changes of texts */
    uint64_t back;    /* number of the state that the next request restores first; 0: none */
    Buffer sets;      /* records to send with the next request */
    uint32_t sets_count;
    Buffer forgotten; /* numbers of states that the worker may free */
    uint64_t numbers; /* last number of a state */
    State *states;
    State *last; /* parts of the last saved state, kept even if the host frees it: the worker sends only new parts */
    Reason why;
    char plain[sizeof(Reason) + 256], escaped[2 * sizeof(Reason) + 512]; /* not on the small stacks of some hosts */
};

static Instance *instances; /* under shared_lock */

/* log */

static int heard(const Instance *instance, fmi2Status status, const char *category) {
    if (status >= fmi2Error) return 1;
    if (instance->logging != LOUD) return instance->logging == USUAL && status != fmi2OK;
    if (!instance->categories) return 1;
    for (char **wanted = instance->categories; *wanted; wanted++)
        if (!strcmp(*wanted, "logAll") || !strcmp(*wanted, category)) return 1;
    return 0;
}

/* `message` is a format without conversions: percent signs are doubled. */
static void tell(const Instance *instance, fmi2Status status, const char *category, const char *message) {
    if (instance->host.log && heard(instance, status, category))
        instance->host.log(&instance->host, instance->name, status, category, message);
}

/* Log a text that is not yet a format. */
static void say(Instance *instance, fmi2Status status, const char *format, va_list arguments) {
    vsnprintf(instance->plain, sizeof instance->plain, format, arguments);
    char *to = instance->escaped;
    for (const char *from = instance->plain; *from; from++) {
        if (*from == '%') *to++ = '%';
        *to++ = *from;
    }
    *to = 0;
    tell(instance, status, status == fmi2Error ? "logStatusError" : "logStatusWarning", instance->escaped);
}

fmi2Status instance_fail(Instance *instance, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(instance, fmi2Error, format, arguments);
    va_end(arguments);
    return fmi2Error;
}

static void warn(Instance *instance, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(instance, fmi2Warning, format, arguments);
    va_end(arguments);
}

static void drop_categories(Instance *instance) {
    for (char **name = instance->categories; name && *name; name++) free(*name);
    free(instance->categories);
    instance->categories = NULL;
}

void instance_hear(Instance *instance, int logging, size_t count, const char *const categories[]) {
    drop_categories(instance);
    instance->logging = logging ? LOUD : QUIET;
    if (!logging || !count || !(instance->categories = calloc(count + 1, sizeof *instance->categories))) return;
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (categories[i] && (instance->categories[kept] = strdup(categories[i]))) kept++;
}

/* answers */

static int take_logs(const Instance *instance, Reader *reader, uint64_t logs) {
    for (; logs; logs--) {
        struct entry entry;
        const void *head = taken(reader, sizeof entry);
        if (!head) return 0;
        memcpy(&entry, head, sizeof entry);
        const char *texts = taken(reader, PADDED((size_t)entry.category + entry.message));
        if (!texts) return 0;
        tell(instance, (fmi2Status)entry.status, texts, texts + entry.category);
    }
    return 1;
}

static int take_outputs(Instance *instance, Reader *reader, uint64_t outputs) {
    const unsigned char *values = taken(reader, outputs * sizeof(double));
    if (!values || outputs > instance->outputs_count) return 0;
    for (size_t i = 0; i < outputs; i++)
        memcpy(&instance->variables[instance->outputs[i]].value, values + i * sizeof(double), sizeof(double));
    return 1;
}

static int take_variable(Instance *instance, Variable *variable, Reader *reader) {
    struct record record;
    const void *place = taken(reader, sizeof record);
    if (!place) return 0;
    memcpy(&record, place, sizeof record);
    variable->kind = record.kind;
    variable->causality = record.causality;
    variable->value = record.value;
    if (record.kind != STRING) return 1;
    size_t length = (size_t)record.value;
    const char *text = taken(reader, PADDED(length));
    char *copy = text ? malloc(length + 1) : NULL;
    if (!copy) return 0;
    memcpy(copy, text, length);
    copy[length] = 0;
    if (!variable->text || strcmp(variable->text, copy)) instance->texts++;
    free(variable->text);
    variable->text = copy;
    return 1;
}

static int take_table(Instance *instance, Reader *reader) {
    uint64_t count;
    const void *place = taken(reader, sizeof count);
    if (!place) return 0;
    memcpy(&count, place, sizeof count);
    if (!instance->variables) {
        instance->variables = calloc(count + 1, sizeof *instance->variables);
        instance->outputs = calloc(count + 1, sizeof *instance->outputs);
        if (!instance->variables || !instance->outputs) return 0;
        instance->count = count;
    }
    if (count != instance->count) return 0;
    instance->outputs_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (!take_variable(instance, &instance->variables[i], reader)) return 0;
        if (instance->variables[i].causality == OUTPUT) instance->outputs[instance->outputs_count++] = (uint32_t)i;
    }
    return 1;
}

/* requests */

static int done(fmi2Status status) { return status == fmi2OK || status == fmi2Warning; }

static const double NONE[3] = {0.0, 0.0, 0.0};

static size_t request_size(const Instance *instance, size_t payload) {
    return sizeof(struct request) + instance->forgotten.size + instance->sets.size + payload;
}

static void nothing_to_send(Instance *instance) {
    instance->forgotten.size = instance->sets.size = instance->sets_count = 0;
    instance->back = 0;
}

static void write_request(Instance *instance, unsigned char *to, enum operation operation, const double numbers[3],
                          uint64_t state, size_t payload) {
    struct request request = {(uint32_t)operation, instance->sets_count, instance->forgotten.size / 8, instance->back,
                              state, payload, {numbers[0], numbers[1], numbers[2]}};
    to = append(to, &request, sizeof request);
    to = append(to, instance->forgotten.bytes, instance->forgotten.size);
    append(to, instance->sets.bytes, instance->sets.size);
    nothing_to_send(instance);
}

/* The status of an answer of `size` bytes; the results of the operation are left in `rest`. */
static fmi2Status answered(Instance *instance, size_t size, Reader *rest) {
    const unsigned char *bytes = channel_answer(instance->worker);
    struct answer answer;
    *rest = (Reader){bytes, bytes + size};
    const void *head = taken(rest, sizeof answer);
    if (!head) return instance_fail(instance, "The worker's answer is damaged.");
    memcpy(&answer, head, sizeof answer);
    instance->phase = (enum phase)answer.phase;
    if (!take_outputs(instance, rest, answer.outputs) || !take_logs(instance, rest, answer.logs))
        return instance_fail(instance, "The worker's answer is damaged.");
    return (fmi2Status)answer.status;
}

static void lose_worker(Instance *instance) {
    channel_close(instance->worker, NULL, 0);
    instance->worker = NULL;
    nothing_to_send(instance);
}

static fmi2Status lost(Instance *instance) {
    return instance_fail(instance,
                         "The process that runs the model was lost: %s Restore a saved state, or reset the FMU, to "
                         "go on with a new one.",
                         instance->why.text);
}

static int usable(Instance *instance) {
    if (instance->worker && !channel_ours(instance->worker, &instance->why)) lose_worker(instance);
    return instance->worker != NULL;
}

static fmi2Status request(Instance *instance, enum operation operation, const double numbers[3], uint64_t state,
                          size_t payload, Reader *rest) {
    if (!usable(instance)) return lost(instance);
    size_t size = request_size(instance, payload);
    unsigned char *room = channel_room(instance->worker, size);
    if (!room) return instance_fail(instance, "There is no memory for a message of %zu bytes.", size);
    write_request(instance, room, operation, numbers, state, payload);
    if (channel_call(instance->worker, &size, instance->limits.call, &instance->why)) return answered(instance, size, rest);
    lose_worker(instance);
    return instance->mending ? fmi2Error : lost(instance);
}

/* A new worker with a new model. */
static fmi2Status open_worker(Instance *instance) {
    static const char nothing[1] = "";
    size_t name = strlen(instance->name) + 1, payload = name + strlen(instance->guid), size;
    nothing_to_send(instance);
    size = request_size(instance, payload);
    unsigned char *message = malloc(size);
    if (!message) return instance_fail(instance, "There is no memory for a message of %zu bytes.", size);
    write_request(instance, message, OPEN, NONE, 0, payload);
    append(append(message + size - payload, instance->name, name), *instance->guid ? instance->guid : nothing,
           payload - name);
    instance->worker = channel_open(instance->resources, message, &size, instance->limits, &instance->why);
    free(message);
    if (!instance->worker) return instance_fail(instance, "The model cannot be started: %s", instance->why.text);
    instance->life++;
    Reader rest;
    fmi2Status status = answered(instance, size, &rest);
    if (done(status) && !take_table(instance, &rest))
        status = instance_fail(instance, "The worker's table of variables is damaged.");
    if (!done(status)) {
        snprintf(instance->why.text, sizeof instance->why.text, "It could not be instantiated.");
        lose_worker(instance);
    }
    return status;
}

static fmi2Status request_table(Instance *instance, enum operation operation, uint64_t state, size_t payload) {
    Reader rest;
    fmi2Status status = request(instance, operation, NONE, state, payload, &rest);
    if (instance->worker && rest.at < rest.end && !take_table(instance, &rest))
        return instance_fail(instance, "The worker's table of variables is damaged.");
    instance->stale = operation != LOOK && instance->phase != STEPPING;
    return status;
}

/* Calls that FMI allows in one phase only. */
static const struct {
    const char *name;
    enum phase phase;
} CALLS[] = {
    [SETUP] = {"fmi2SetupExperiment", NEW},
    [ENTER] = {"fmi2EnterInitializationMode", NEW},
    [EXIT] = {"fmi2ExitInitializationMode", INITIALISING},
    [STEP] = {"fmi2DoStep", STEPPING},
    [TERMINATE] = {"fmi2Terminate", STEPPING},
};

static fmi2Status out_of_turn(Instance *instance, const char *name) {
    static const char *const now[] = {"before initialisation", "in initialisation mode", "after initialisation"};
    return instance_fail(instance, "%s is not allowed %s. Nothing was done.", name,
                         instance->terminated ? "after fmi2Terminate" : now[instance->phase]);
}

fmi2Status instance_do(Instance *instance, enum operation operation, const double numbers[3]) {
    Reader rest;
    if (!instance->worker) return lost(instance);
    if (instance->terminated || instance->phase != CALLS[operation].phase)
        return out_of_turn(instance, CALLS[operation].name);
    fmi2Status status = request(instance, operation, numbers ? numbers : NONE, 0, 0, &rest);
    instance->stale = instance->phase != STEPPING;
    instance->terminated = operation == TERMINATE && done(status);
    if (operation == SETUP && done(status)) {
        instance->set_up = 1;
        memcpy(instance->experiment, numbers, sizeof instance->experiment);
    }
    return status;
}

/* Have `work` done, by a new worker if the old one is lost. */
static fmi2Status renewed(Instance *instance, fmi2Status (*work)(Instance *, const State *), const State *state) {
    instance->mending = 1;
    int had = instance->worker != NULL;
    if (had && channel_lost(instance->worker, &instance->why)) lose_worker(instance);
    fmi2Status status = usable(instance) ? work(instance, state) : fmi2Error;
    instance->mending = 0;
    if (instance->worker) return status;
    if (had)
        warn(instance, "The process that runs the model was lost between two calls: %s A new one takes its place.",
             instance->why.text);
    if (!done(open_worker(instance))) return fmi2Error;
    Reader rest;
    if (state && instance->set_up && !done(request(instance, SETUP, instance->experiment, 0, 0, &rest)))
        return fmi2Error;
    return work(instance, state);
}

static fmi2Status reset(Instance *instance, const State *state) {
    (void)state;
    return request_table(instance, RESET, 0, 0);
}

fmi2Status instance_reset(Instance *instance) {
    fmi2Status status = renewed(instance, reset, NULL);
    if (done(status)) instance->terminated = instance->set_up = 0;
    return status;
}

/* instances */

/* Read seconds from an environment variable, `usual` if it is not set: digits, a point, digits. strtod would expect a
   decimal comma in some hosts. */
static int read_limit(const char *name, double usual, double *limit, Reason *why) {
    const char *text = getenv(name), *at = text ? text : "";
    double whole = 0.0, scale = 1.0;
    for (; '0' <= *at && *at <= '9'; at++) whole = 10.0 * whole + (*at - '0');
    if (*at == '.')
        for (at++; '0' <= *at && *at <= '9'; at++) whole += (*at - '0') * (scale /= 10.0);
    *limit = text && *text ? whole : usual;
    if (!*at && (whole > 0.0 || !text || !*text)) return 1;
    snprintf(why->text, sizeof why->text,
             "%s = '%.100s' must be a number of seconds above 0, such as 600 or 0.5. Leave it unset for %s.", name, text,
             usual > 0.0 ? "two minutes" : "no limit");
    return 0;
}

static int read_limits(Limits *limits, Reason *why) {
    return read_limit("TRIBOFMU_TIMEOUT", 0.0, &limits->call, why) &&
           read_limit("TRIBOFMU_START_TIMEOUT", limits->call > START_LIMIT ? limits->call : START_LIMIT, &limits->start,
                      why);
}

Instance *instance_new(const char *name, const char *guid, const char *place, const Host *host, int logging) {
    Instance *instance = calloc(1, sizeof *instance);
    if (!instance) return NULL;
    instance->host = *host;
    instance->logging = logging ? LOUD : USUAL;
    instance->name = strdup(name ? name : "");
    instance->guid = strdup(guid ? guid : "");
    instance->stale = 1;
    if (instance->name && instance->guid) {
        instance->resources = channel_resources(place, &instance->why);
        if (!instance->resources || !read_limits(&instance->limits, &instance->why))
            instance_fail(instance, "%s", instance->why.text);
        else if (done(open_worker(instance))) {
            instance->library = library_keep();
            lock(&shared_lock);
            instance->next = instances;
            instances = instance;
            unlock(&shared_lock);
            return instance;
        }
    }
    instance_free(instance);
    return NULL;
}

int instance_known(const void *component) {
    lock(&shared_lock);
    const Instance *known = instances;
    while (known && known != component) known = known->next;
    unlock(&shared_lock);
    return known != NULL;
}

void *instance_free(Instance *instance) {
    void *library = instance->library;
    lock(&shared_lock);
    for (Instance **link = &instances; *link; link = &(*link)->next)
        if (*link == instance) {
            *link = instance->next;
            break;
        }
    unlock(&shared_lock);
    if (instance->worker) {
        const struct request quit = {QUIT, 0, 0, 0, 0, 0, {0.0, 0.0, 0.0}};
        channel_close(instance->worker, &quit, sizeof quit);
    }
    while (instance->states) instance_forget(instance, instance->states);
    state_free(instance->last);
    for (size_t i = 0; i < instance->count; i++) free(instance->variables[i].text);
    drop_categories(instance);
    free(instance->variables);
    free(instance->outputs);
    free(instance->sets.bytes);
    free(instance->forgotten.bytes);
    free(instance->name);
    free(instance->guid);
    free(instance->resources);
    free(instance);
    return library;
}

/* variables */

int instance_lacks(Instance *instance, size_t count, const void *first, const void *second) {
    if (!count || (first && second)) return 0;
    instance_fail(instance, "The call has NULL in place of %zu value%s. Nothing was done.", count,
                  count == 1 ? "" : "s");
    return 1;
}

static Variable *variable_of(Instance *instance, enum kind kind, uint32_t reference) {
    if (reference < instance->count && instance->variables[reference].kind == kind)
        return &instance->variables[reference];
    instance_fail(instance, "There is no %s variable with value reference %u.", instance->host.kinds[kind], reference);
    return NULL;
}

fmi2Status instance_get(Instance *instance, enum kind kind, const uint32_t references[], size_t count, void *values) {
    if (!instance->worker) return lost(instance);
    if (instance_lacks(instance, count, references, values)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = variable_of(instance, kind, references[i]);
        if (!variable) return fmi2Error;
        if (instance->stale && variable->causality == OUTPUT) {
            fmi2Status status = request_table(instance, LOOK, 0, 0);
            if (!done(status)) return status; /* a warning is about the model, and logged: the values are valid */
        }
        if (kind == REAL)
            ((fmi2Real *)values)[i] = variable->value;
        else if (kind == STRING)
            ((fmi2String *)values)[i] = variable->text;
        else
            ((fmi2Integer *)values)[i] = (fmi2Integer)variable->value;
    }
    return fmi2OK;
}

static int settable(Instance *instance, const Variable *variable, enum kind kind, uint32_t reference) {
    if (variable->causality == OUTPUT)
        instance_fail(instance, "The %s variable with value reference %u is an output and cannot be set.",
                      instance->host.kinds[kind], reference);
    else if (variable->causality == FIXED && instance->phase == STEPPING)
        instance_fail(instance,
                      "The %s variable with value reference %u is a fixed parameter: set it before initialisation "
                      "ends, or reset the FMU first.",
                      instance->host.kinds[kind], reference);
    else
        return 1;
    return 0;
}

static int set_text(Instance *instance, Variable *variable, const char *text) {
    char *copy = strdup(text);
    if (!copy) return 0;
    free(variable->text);
    variable->text = copy;
    instance->texts++;
    return 1;
}

static int set_one(Instance *instance, Variable *variable, uint32_t reference, const void *values, size_t i) {
    struct record record = {variable->kind, variable->causality, reference, 0.0};
    const char *text = NULL;
    size_t length = 0;
    if (variable->kind == REAL)
        record.value = ((const fmi2Real *)values)[i];
    else if (variable->kind == STRING) {
        text = ((const fmi2String *)values)[i] ? ((const fmi2String *)values)[i] : "";
        length = strlen(text);
        record.value = (double)length;
    } else
        record.value = ((const fmi2Integer *)values)[i];
    unsigned char *place = extended(&instance->sets, sizeof record + PADDED(length));
    if (!place || (text && !set_text(instance, variable, text))) return 0;
    memset(place, 0, sizeof record + PADDED(length));
    append(append(place, &record, sizeof record), text, length);
    variable->value = record.value;
    instance->sets_count++;
    return 1;
}

fmi2Status instance_set(Instance *instance, enum kind kind, const uint32_t references[], size_t count,
                        const void *values) {
    enum { MANY = 65536 };
    if (!instance->worker) return lost(instance);
    if (instance->terminated) return out_of_turn(instance, "Setting a variable");
    if (instance_lacks(instance, count, references, values)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        Variable *variable = variable_of(instance, kind, references[i]);
        if (!variable || !settable(instance, variable, kind, references[i])) return fmi2Error;
    }
    for (size_t i = 0; i < count; i++) {
        Variable *variable = &instance->variables[references[i]];
        if (!set_one(instance, variable, references[i], values, i))
            return instance_fail(instance, "There is no memory for the values that are set.");
        if (instance->phase != STEPPING || variable->causality == DIRECT) instance->stale = 1;
    }
    if (instance->sets_count <= MANY) return fmi2OK;
    fmi2Status status = request_table(instance, LOOK, 0, 0);
    return done(status) ? fmi2OK : status;
}

/* states */

static void forget_number(Instance *instance, const State *state) {
    if (!state->number || state->life != instance->life || !instance->worker) return;
    unsigned char *place = extended(&instance->forgotten, sizeof state->number);
    if (place) memcpy(place, &state->number, sizeof state->number);
}

static State *listed(Instance *instance, State *state) {
    state->next = instance->states;
    instance->states = state;
    return state;
}

void instance_forget(Instance *instance, State *state) {
    for (State **link = &instance->states; *link; link = &(*link)->next)
        if (*link == state) {
            *link = state->next;
            break;
        }
    forget_number(instance, state);
    state_free(state);
}

int instance_owns(const Instance *instance, const State *state) {
    const State *own = instance->states;
    while (own && own != state) own = own->next;
    return own != NULL;
}

/* Store with a state the values that the host has seen in it. */
static void keep_values(Instance *instance, State *state) {
    if (instance->phase != STEPPING) return; /* only then answers contain the outputs */
    state->values = malloc(instance->count * sizeof(double));
    for (size_t i = 0; state->values && i < instance->count; i++) state->values[i] = instance->variables[i].value;
    state->texts = instance->texts;
}

/* Restore the values of a state; the worker restores its own with the next request. */
static fmi2Status restore_values(Instance *instance, const State *state) {
    for (size_t i = 0; i < instance->count; i++) instance->variables[i].value = state->values[i];
    instance->sets.size = instance->sets_count = 0;
    instance->back = state->number;
    instance->phase = STEPPING;
    instance->stale = 0;
    return fmi2OK;
}

fmi2Status instance_save(Instance *instance, State **state) {
    Reader rest;
    uint64_t count, number = ++instance->numbers;
    const State *before = instance->last && instance->last->life == instance->life ? instance->last : NULL;
    fmi2Status status = request(instance, SAVE, (double[3]){before != NULL, 0.0, 0.0}, number, 0, &rest);
    const void *head = done(status) ? taken(&rest, sizeof count) : NULL;
    if (head) memcpy(&count, head, sizeof count);
    int whole = head && count <= (size_t)(rest.end - rest.at) / sizeof(struct part);
    State *saved = whole ? state_taken(count, &rest, before) : NULL;
    state_free(instance->last);
    instance->last = saved ? state_shared(saved) : NULL; /* after a failure the worker sends all parts of the next */
    if (!done(status)) return status;
    if (!saved) return instance_fail(instance, "The state could not be kept: there is no memory, or it is damaged.");
    saved->number = number;
    saved->life = instance->life;
    keep_values(instance, saved);
    if (instance->last) instance->last->life = instance->life;
    if (*state && instance_owns(instance, *state)) instance_forget(instance, *state);
    *state = listed(instance, saved);
    return fmi2OK;
}

static fmi2Status restore_bytes(Instance *instance, const State *state) {
    size_t payload = state_size(state), size = request_size(instance, payload);
    unsigned char *room = channel_room(instance->worker, size);
    if (!room) return instance_fail(instance, "There is no memory for a message of %zu bytes.", size);
    state_write(state, (char *)room + size - payload);
    return request_table(instance, RESTORE, 0, payload);
}

static fmi2Status restore(Instance *instance, const State *state) {
    if (!state->number || state->life != instance->life) return restore_bytes(instance, state);
    if (state->values && state->texts == instance->texts) return restore_values(instance, state);
    return request_table(instance, RESTORE, state->number, 0);
}

fmi2Status instance_restore(Instance *instance, State *state) {
    fmi2Status status = renewed(instance, restore, state);
    if (done(status)) instance->terminated = 0;
    return status;
}

State *instance_read(Instance *instance, const char *bytes, size_t size) {
    State *state = state_of(bytes, size);
    if (state) return listed(instance, state);
    instance_fail(instance, "There is no memory for a state of %zu bytes.", size);
    return NULL;
}
