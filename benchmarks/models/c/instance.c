#include "instance.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static State *state_of(const Instance *it) { return (State *)it->head; }
static double *values_of(const Instance *it) { return (double *)((char *)it->head + LAYOUT.value); }
static double *slopes_of(const Instance *it) { return (double *)((char *)it->head + LAYOUT.slope); }

static char *text_of(const Instance *it, unsigned ref)
{
    return (char *)it->head + LAYOUT.text + (ref - LAYOUT.n_numbers) * TEXT;
}

__attribute__((weak)) size_t model_work(void) { return 0; }

__attribute__((weak)) void model_made(void) {}

__attribute__((weak)) void model_freed(void) {}

__attribute__((weak)) void model_event(State *m) { (void)m; }

__attribute__((weak)) double model_next_event(const State *m) { return (void)m, NAN; }

__attribute__((weak)) int model_partial(const State *m, int output, int input, double *value)
{
    return (void)m, (void)output, (void)input, (void)value, 0;
}

__attribute__((weak)) int model_slope(const State *m, int output, double *value)
{
    return (void)m, (void)output, (void)value, 0;
}

Instance *create(const char *name, const char *token)
{
    if (name == NULL || token == NULL || strcmp(token, LAYOUT.token) != 0) return NULL;
    Instance *it = calloc(1, sizeof *it);
    it->name = strdup(name);
    it->head = malloc(LAYOUT.state);
    it->work = calloc(1, model_work() + 1);
    it->stop_time = INFINITY;
    reset(it);
    model_made();
    return it;
}

void discard(Instance *it)
{
    if (it == NULL) return;
    model_freed();
    free(it->name);
    free(it->head);
    free(it->work);
    free(it);
}

void reset(Instance *it)
{
    memset(it->head, 0, LAYOUT.state);
    memcpy(values_of(it), LAYOUT.start, LAYOUT.n_numbers * sizeof(double));
    for (unsigned i = 0; i < LAYOUT.n_strings; i++) strcpy(text_of(it, LAYOUT.n_numbers + i), LAYOUT.start_text[i]);
    it->last = (Outcome){.reached = 0.0};
    it->stale = 1;
}

Status say(Instance *it, Status status, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    it->report(it, status, message);
    return status;
}

/* Outputs that fit state and inputs; while the model initialises, also memory that fits the parameters. */
static void refresh(Instance *it)
{
    if (!it->stale) return;
    if (it->head->phase <= INITIALISING) model_start(state_of(it));
    model_outputs(state_of(it));
    it->stale = 0;
}

static Status check_kind(Instance *it, char kind, unsigned ref)
{
    if (ref >= LAYOUT.n_variables) return say(it, ERROR, "There is no variable with value reference %u.", ref);
    if (LAYOUT.kind[ref] != kind) return say(it, ERROR, "Variable %u is of kind %c, not %c.", ref, LAYOUT.kind[ref], kind);
    return OK;
}

static Status check_settable(Instance *it, char kind, unsigned ref)
{
    if (check_kind(it, kind, ref) != OK) return ERROR;
    if (it->head->phase == ENDED) return say(it, ERROR, "Variable %u was set after the end.", ref);
    if (LAYOUT.causality[ref] == 'o') return say(it, ERROR, "Variable %u is an output and cannot be set.", ref);
    if (LAYOUT.causality[ref] == 'p' && it->head->phase > INITIALISING)
        return say(it, ERROR, "Parameter %u is fixed and was set after initialisation.", ref);
    return OK;
}

Status get_numbers(Instance *it, char kind, const unsigned *refs, size_t n, double *values)
{
    refresh(it);
    for (size_t i = 0; i < n; i++) {
        if (check_kind(it, kind, refs[i]) != OK) return ERROR;
        values[i] = values_of(it)[refs[i]];
    }
    return OK;
}

Status set_numbers(Instance *it, char kind, const unsigned *refs, size_t n, const double *values)
{
    for (size_t i = 0; i < n; i++) {
        if (check_settable(it, kind, refs[i]) != OK) return ERROR;
        values_of(it)[refs[i]] = values[i];
    }
    it->stale = 1;
    return OK;
}

Status get_texts(Instance *it, const unsigned *refs, size_t n, const char **values)
{
    refresh(it);
    for (size_t i = 0; i < n; i++) {
        if (check_kind(it, 'S', refs[i]) != OK) return ERROR;
        values[i] = text_of(it, refs[i]);
    }
    return OK;
}

Status set_texts(Instance *it, const unsigned *refs, size_t n, const char *const *values)
{
    for (size_t i = 0; i < n; i++) {
        if (check_settable(it, 'S', refs[i]) != OK) return ERROR;
        if (strlen(values[i]) >= TEXT) return say(it, ERROR, "A string is longer than %d bytes.", TEXT - 1);
        char *text = text_of(it, refs[i]);
        memset(text, 0, TEXT);
        strcpy(text, values[i]);
    }
    it->stale = 1;
    return OK;
}

Status set_input_slopes(Instance *it, const unsigned *refs, size_t n, const int *orders, const double *values)
{
    for (size_t i = 0; i < n; i++) {
        if (check_settable(it, 'R', refs[i]) != OK) return ERROR;
        if (LAYOUT.causality[refs[i]] != 'i') return say(it, ERROR, "Variable %u is not an input.", refs[i]);
        if (orders[i] < 1 || orders[i] > 2)
            return say(it, ERROR, "The order of an input derivative is %d, not 1 or 2.", orders[i]);
        if (LAYOUT.interpolates)
            slopes_of(it)[(orders[i] - 1) * LAYOUT.slopes_per_order + refs[i] - LAYOUT.first_input] = values[i];
    }
    return OK;
}

Status get_output_slopes(Instance *it, const unsigned *refs, size_t n, const int *orders, double *values)
{
    refresh(it);
    for (size_t i = 0; i < n; i++) {
        if (check_kind(it, 'R', refs[i]) != OK) return ERROR;
        if (orders[i] != 1 || !model_slope(state_of(it), refs[i], &values[i]))
            return say(it, ERROR, "Variable %u has no derivative of order %d.", refs[i], orders[i]);
    }
    return OK;
}

Status partials(Instance *it, const unsigned *unknowns, size_t n, const unsigned *knowns, size_t m, const double *seed,
                double *out)
{
    refresh(it);
    for (size_t i = 0; i < n; i++) {
        out[i] = 0.0;
        for (size_t j = 0; j < m; j++) {
            double partial;
            if (check_kind(it, 'R', unknowns[i]) != OK || check_kind(it, 'R', knowns[j]) != OK) return ERROR;
            if (LAYOUT.causality[unknowns[i]] != 'o' || LAYOUT.causality[knowns[j]] != 'i' ||
                !model_partial(state_of(it), unknowns[i], knowns[j], &partial))
                return say(it, ERROR, "No derivative of variable %u to variable %u.", unknowns[i], knowns[j]);
            out[i] += partial * seed[j];
        }
    }
    return OK;
}

Status enter_initialisation(Instance *it, double start_time)
{
    if (it->head->phase != NEW) return say(it, ERROR, "Initialisation was entered twice.");
    it->head->phase = INITIALISING;
    it->head->time = it->last.reached = start_time;
    it->stale = 1;
    return OK;
}

Status exit_initialisation(Instance *it)
{
    if (it->head->phase != INITIALISING) return say(it, ERROR, "Initialisation was left but not entered.");
    refresh(it);
    it->head->phase = it->event_mode ? EVENTS : STEPPING;
    return OK;
}

Status step(Instance *it, double time, double h)
{
    Head *m = it->head;
    if (m->phase != STEPPING) return say(it, ERROR, "A step was asked for in phase %d, not in step mode.", m->phase);
    if (m->event_pending) return say(it, ERROR, "A step was asked for before the event at %g s was handled.", m->time);
    if (fabs(time - m->time) > 1e-9 * fmax(1.0, fabs(m->time)))
        return say(it, ERROR, "The step starts at %.17g s, the model stands at %.17g s.", time, m->time);
    if (!(h > 0.0)) return say(it, ERROR, "The step size is %g s and must be above 0.", h);
    if (time + h > it->stop_time + 1e-9 * fmax(1.0, fabs(it->stop_time)))
        return say(it, ERROR, "The step ends at %.17g s, beyond the stop time %.17g s.", time + h, it->stop_time);
    m->time = time;
    it->last = model_step(state_of(it), it->work, h, it->may_return_early, it->event_mode);
    m->event_pending = it->last.event;
    it->stale = 1;
    if (it->last.message != NULL) say(it, it->last.status, "%s", it->last.message);
    return it->last.status;
}

int is_short(const Instance *it, double time, double h)
{
    return it->last.reached < time + h - 1e-12 * fmax(1.0, fabs(time));
}

Status terminate(Instance *it)
{
    if (it->head->phase < EVENTS) return say(it, ERROR, "The end came before initialisation was left.");
    it->head->phase = ENDED;
    return OK;
}

static Status check_rollback(Instance *it)
{
    return LAYOUT.rollback ? OK : say(it, ERROR, "This model neither saves nor restores its state.");
}

Status save(Instance *it, void **state)
{
    if (check_rollback(it) != OK) return ERROR;
    if (*state == NULL) *state = malloc(LAYOUT.state);
    refresh(it);
    memcpy(*state, it->head, LAYOUT.state);
    return OK;
}

Status restore(Instance *it, const void *state)
{
    if (check_rollback(it) != OK) return ERROR;
    if (state == NULL) return say(it, ERROR, "The state to restore is missing.");
    memcpy(it->head, state, LAYOUT.state);
    it->last = (Outcome){.reached = it->head->time};
    it->stale = 1;
    return OK;
}

Status release(Instance *it, void **state)
{
    if (check_rollback(it) != OK) return ERROR;
    free(*state);
    *state = NULL;
    return OK;
}

Status state_size(Instance *it, const void *state, size_t *size)
{
    if (check_rollback(it) != OK || state == NULL) return ERROR;
    *size = LAYOUT.state;
    return OK;
}

Status pack(Instance *it, const void *state, void *bytes, size_t size)
{
    if (check_rollback(it) != OK || state == NULL || size < LAYOUT.state) return ERROR;
    memcpy(bytes, state, LAYOUT.state);
    return OK;
}

Status unpack(Instance *it, const void *bytes, size_t size, void **state)
{
    if (check_rollback(it) != OK) return ERROR;
    if (size != LAYOUT.state) return say(it, ERROR, "A state has %zu bytes, not %zu.", LAYOUT.state, size);
    if (*state == NULL) *state = malloc(LAYOUT.state);
    memcpy(*state, bytes, LAYOUT.state);
    return OK;
}
