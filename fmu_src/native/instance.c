#include "instance.h"

#include <math.h>
#include <string.h>

#include "log.h"

/* Two communication points are the same if they differ by no more than PART of the step plus ROUNDED of the time. A step
   may end beyond the stop time by PAST in seconds, or as a share of a stop time above 1 s, but by no more than HALF of
   the step: the rounding of hosts. */
static const double PART = 1e-6, ROUNDED = 1e-12, PAST = 1e-5, HALF = 0.5;
static const double LONGEST_STEP = 1e9; /* s */

/* Serialised states are the bytes of a Moment: it must be as long as its members together. */
typedef char moment_has_padding[sizeof(Moment) == 2 * sizeof(contact_inputs) + sizeof(contact_state) +
                                                      sizeof(contact_outputs) + 2 * sizeof(double) +
                                                      4 * sizeof(uint32_t)
                                    ? 1
                                    : -1];

/* order of calls */

static Status out_of_turn(const Instance *it, const char *call) {
    static const char *const when[] = {"before initialisation", "in configuration mode", "in initialisation mode",
                                       "in initialisation mode", "after initialisation",
                                       "after initialisation"};
    if (it->asking)
        return log_error(it, "%s%s is not allowed in intermediate update mode. Nothing was done.", it->host.prefix, call);
    if (it->terminated)
        return log_error(it, "%s%s is not allowed after %sTerminate. Nothing was done.", it->host.prefix, call,
                         it->host.prefix);
    return log_error(it, "%s%s is not allowed %s. Nothing was done.", it->host.prefix, call, when[it->now.phase]);
}

static Status must_be(const Instance *it, const char *call, Phase first, Phase last) {
    int allowed = !it->asking && !it->terminated && first <= it->now.phase && it->now.phase <= last;
    return allowed ? OK : out_of_turn(it, call);
}

Status instance_may_change(Instance *it, const char *call) {
    return it->asking || it->terminated || it->now.phase == CONFIGURING ? out_of_turn(it, call) : OK;
}

Status instance_check_arrays(const Instance *it, const char *call, size_t count, const void *first,
                             const void *second) {
    if (!count || (first && second)) return OK;
    return log_error(it, "%s%s was called with NULL in place of %lu value%s. Nothing was done.", it->host.prefix, call,
                     (unsigned long)count, count == 1 ? "" : "s");
}

/* the contact */

/* `valid` becomes false; state and outputs stay as they are. */
static Status refuse(Instance *it, Status status, Category category, const char *why) {
    it->now.valid = 0;
    log_text(it, status, category, why);
    return status;
}

static double input(const Instance *it, size_t place) { return ((const double *)&it->now.inputs)[place]; }

static double output(const Instance *it, size_t place) {
    return ((const double *)&it->now.solution.outputs)[place];
}

static int usable(const Input *known, double value) { return known->minimum <= value && value <= known->maximum; }

/* A sentence for each input that cannot be used. */
static void describe_unusable(const Instance *it, Text *why) {
    for (size_t i = 0; i < INPUTS; i++) {
        const Input *known = &MODEL_INPUTS[i];
        double value = input(it, known->place);
        if (usable(known, value)) continue;
        text_add(why, "%s%s = %g%s%s (%s) must be %sat least %g and at most %g%s%s.", why->size ? " " : "", known->name,
                 value, *known->unit ? " " : "", known->unit, known->text, isfinite(value) ? "" : "finite and ",
                 known->minimum, known->maximum, *known->unit ? " " : "", known->unit);
    }
}

int inputs_usable(const contact_inputs *inputs) {
    const double *value = (const double *)inputs;
    int all = 1;
    for (size_t i = 0; i < INPUTS; i++) all &= usable(&MODEL_INPUTS[i], value[MODEL_INPUTS[i].place]);
    return all;
}

static Status check_inputs(Instance *it) {
    if (inputs_usable(&it->now.inputs)) return OK;
    Text why = {.size = 0};
    describe_unusable(it, &why);
    return refuse(it, WARNING, OF_VALIDITY, why.text);
}

/* A number is finite if the bits of its exponent are not all ones: one more then carries into the sign's. Whole numbers
   take a processor half the time that comparisons of doubles do. */
int outputs_finite(const contact_outputs *outputs) {
    const double *value = (const double *)outputs;
    uint64_t carried = 0;
    for (size_t i = 0; i < OUTPUTS; i++) {
        uint64_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        carried |= (bits & 0x7fffffffffffffffu) + 0x0010000000000000u;
    }
    return !(carried >> 63);
}

static Status refuse_broken(Instance *it) {
    Text why = {.size = 0};
    text_add(&why, "No finite");
    for (size_t i = 0; i < MODEL_VARIABLES_COUNT; i++) {
        const Variable *v = &MODEL_VARIABLES[i];
        if ((v->role == OUTPUT || v->role == DERIVATIVE) && !isfinite(output(it, v->place)))
            text_add(&why, "%s %s", why.size > strlen("No finite") ? "," : "", v->name);
    }
    text_add(&why, " came out at");
    for (size_t i = 0; i < INPUTS; i++)
        text_add(&why, "%s %s = %g", i ? "," : "", MODEL_INPUTS[i].name, input(it, MODEL_INPUTS[i].place));
    text_add(&why, ". Change the inputs, or go back to an earlier state.");
    it->now.solution = it->before;
    return refuse(it, WARNING, OF_SOLVER, why.text);
}

static uint32_t flags(const Instance *it) {
    return MODEL_RANGE_FLAGS < OUTPUTS ? (uint32_t)instance_integer(output(it, MODEL_RANGE_FLAGS)) : 0;
}

static void log_flags(const Instance *it, uint32_t appeared) {
    for (size_t i = 0; appeared && i < MODEL_FLAGS_COUNT; i++) {
        Text text = {.size = 0};
        if (!(appeared & MODEL_FLAGS[i].value)) continue;
        text_add(&text, "range_flags: %s.", MODEL_FLAGS[i].text);
        log_text(it, OK, MODEL_FLAGS[i].category, text.text);
    }
}

/* Take over what the contact has made of `before`, or go back to it. */
static Status accept(Instance *it, int failed, const contact_message *why, uint32_t known_flags) {
    if (failed) {
        it->now.solution = it->before;
        return refuse(it, WARNING, OF_VALIDITY, why->text);
    }
    if (!outputs_finite(&it->now.solution.outputs)) return refuse_broken(it);
    it->now.used = it->now.inputs;
    it->now.fidelity_used = MODEL_FIDELITY;
    it->now.ready = it->now.valid = 1;
    it->now.derived = 0;
    log_flags(it, flags(it) & ~known_flags);
    return OK;
}

static Status initialise(Instance *it) {
    contact_message why;
    uint32_t known_flags = flags(it);
    it->now.ready = 0;
    if (check_inputs(it) != OK) return WARNING;
    why.text[0] = 0;
    it->before = it->now.solution;
    int failed = contact_initialise(&it->now.inputs, &it->now.solution.state, &it->now.solution.outputs, &why);
    return accept(it, failed, &why, known_flags);
}

/* Advance, from fresh surfaces if the inputs could not be used before. */
static Status advance(Instance *it, double size) {
    contact_message why;
    Solution *now = &it->now.solution;
    uint32_t known_flags = flags(it);
    if (check_inputs(it) != OK) return WARNING;
    if (!(0.0 <= size && size <= LONGEST_STEP)) {
        Text wrong = {.size = 0};
        text_add(&wrong, "The step dt = %g s must be at least 0 and at most %g s.", size, LONGEST_STEP);
        return refuse(it, WARNING, OF_VALIDITY, wrong.text);
    }
    why.text[0] = 0;
    it->before = *now;
    int failed = it->now.ready ? 0 : contact_initialise(&it->now.inputs, &now->state, &now->outputs, &why);
    failed = failed ? failed : contact_step(&it->now.inputs, size, &now->state, &now->outputs, &why);
    return accept(it, failed, &why, known_flags);
}

/* initialisation */

Status instance_set_up(Instance *it, double start, double stop) {
    if (must_be(it, it->host.experiment, NEW, NEW) != OK) return ERROR;
    if (!isfinite(start)) {
        Text why = {.size = 0};
        text_add(&why, "startTime = %g s must be a finite number. Correct it in %s%s.", start, it->host.prefix,
                 it->host.experiment);
        return refuse(it, WARNING, OF_WARNINGS, why.text);
    }
    it->now.time = start;
    it->anywhere = 0;
    it->stop = stop;
    return OK;
}

Status instance_configure(Instance *it, int begin) {
    Phase from = begin ? NEW : CONFIGURING;
    if (must_be(it, begin ? "EnterConfigurationMode" : "ExitConfigurationMode", from, from) != OK) return ERROR;
    it->now.phase = begin ? CONFIGURING : NEW;
    return OK;
}

Status instance_enter(Instance *it) {
    if (must_be(it, "EnterInitializationMode", NEW, NEW) != OK) return ERROR;
    it->now.phase = UNSETTLED;
    return OK;
}

Status instance_refresh(Instance *it) {
    if (it->now.phase == BEHIND) {
        it->now.phase = STEPPING; /* also if they cannot be had: they stand */
        return it->now.ready ? advance(it, 0.0) : OK;
    }
    if (it->now.phase != UNSETTLED) return OK;
    it->now.phase = SETTLED;
    return initialise(it);
}

Status instance_exit(Instance *it) {
    if (must_be(it, "ExitInitializationMode", UNSETTLED, SETTLED) != OK) return ERROR;
    /* once more if it has failed before: this call, too, says why */
    Status status = it->now.phase == UNSETTLED || !it->now.valid ? initialise(it) : OK;
    it->now.phase = STEPPING;
    return status;
}

/* steps */

static Status refuse_step(Instance *it, const Text *why) { return refuse(it, ERROR, OF_ERRORS, why->text); }

static Status refuse_time(Instance *it, double time) {
    Text why = {.size = 0};
    text_add(&why, "currentCommunicationPoint = %g s must be a finite number. Nothing was done.", time);
    return refuse_step(it, &why);
}

static Status refuse_gap(Instance *it, double time) {
    Text why = {.size = 0};
    text_add(&why,
             "currentCommunicationPoint = %.15g s must be %.15g s, where the last step has ended. Begin there, or "
             "restore a saved state. Nothing was done.",
             time, it->now.time);
    return refuse_step(it, &why);
}

static Status refuse_end(Instance *it, double time, double size) {
    Text why = {.size = 0};
    text_add(&why,
             "The step from %.15g s to %.15g s goes beyond stopTime = %.15g s. Give a later one, or none, in %s%s. "
             "Nothing was done.",
             time, time + size, it->stop, it->host.prefix, it->host.experiment);
    return refuse_step(it, &why);
}

/* A host's rounding at the end of a run can make the last step slightly negative. */
static double rounded(double time, double size) {
    return -ROUNDED * fabs(time) <= size && size < 0.0 ? 0.0 : size;
}

/* True for the end of a step beyond a stop time by more than a host's rounding. */
static int beyond(double end, double stop, double length) {
    return end > stop && end > stop + fmin(HALF * length, PAST * fmax(1.0, fabs(stop)));
}

Status instance_check_step(Instance *it, double time, double size) {
    if (must_be(it, "DoStep", STEPPING, BEHIND) != OK) return ERROR;
    size = rounded(time, size);
    double length = isfinite(size) ? fabs(size) : 0.0;
    if (!isfinite(time)) return refuse_time(it, time);
    if (!it->anywhere && !(fabs(time - it->now.time) <= PART * length + ROUNDED * fabs(time)))
        return refuse_gap(it, time);
    return beyond(time + size, it->stop, length) ? refuse_end(it, time, size) : OK;
}

Status instance_step(Instance *it, double time, double size) {
    size = rounded(time, size);
    it->now.time = size >= 0.0 && isfinite(time + size) ? time + size : time; /* also if the step cannot be computed */
    it->anywhere = 0;
    it->now.phase = STEPPING;
    return advance(it, size);
}

Status instance_terminate(Instance *it) {
    if (must_be(it, "Terminate", STEPPING, BEHIND) != OK) return ERROR;
    it->terminated = 1;
    return OK;
}

/* life */

static void begin(Instance *it) {
    memset(&it->now, 0, sizeof it->now);
    for (size_t i = 0; i < MODEL_VARIABLES_COUNT; i++) {
        const Variable *v = &MODEL_VARIABLES[i];
        if (v->role == INPUT) ((double *)&it->now.inputs)[v->place] = v->start;
    }
    it->now.used = it->now.inputs;
    it->terminated = 0;
    it->anywhere = 1;
    it->stop = NAN;
}

Status instance_reset(Instance *it) {
    if (it->asking) return out_of_turn(it, "Reset");
    begin(it);
    return OK;
}

static Instance *unborn(const Host *host, const char *name, const Text *why) {
    if (host->logger) host->deliver(host, name, ERROR, MODEL_CATEGORIES[OF_ERRORS], why->text);
    return NULL;
}

Instance *instance_new(const Host *host, const char *name, const char *token, int logging) {
    Text why = {.size = 0};
    if (!name) name = "";
    if (!token || strcmp(token, MODEL_TOKEN) != 0) {
        text_add(&why, "The library is that of the FMU %s, but the host loads %.80s. Unpack the FMU anew.", MODEL_TOKEN,
                 token ? token : "none");
        return unborn(host, name, &why);
    }
    size_t length = strlen(name) + 1, size = sizeof(Instance) + length;
    Instance *it = host->allocate(1, size);
    if (!it) {
        text_add(&why, "There is no memory for an instance of %lu bytes.", (unsigned long)size);
        return unborn(host, name, &why);
    }
    memset(it, 0, sizeof *it); /* not every host's allocation does */
    memcpy(it->name, name, length);
    it->host = *host;
    log_choose(it, 1, 0, NULL);
    if (!logging) it->logging = USUAL;
    begin(it);
    return it;
}

void instance_free(Instance *it) {
    if (it->asking) {
        out_of_turn(it, "FreeInstance");
        return;
    }
    instance_forget_all(it);
    it->host.release(it);
}
