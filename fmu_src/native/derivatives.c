/* Derivatives of outputs by inputs at the present state and inputs. Those of friction_force by load, speeds and
   temperature are the contact's own, in closed form; `temperature` stands there for oil and bodies together. All others
   are central differences of the outputs at a step of 0; where a neighbour cannot be used, one-sided ones. */

#include <math.h>

#include "instance.h"
#include "log.h"

/* Near the cube root of the rounding error, best for central differences: share of an input's value, at least of its
   nominal one. */
static const double SHARE = 6e-6;

typedef struct {
    contact_state state;
    contact_outputs low, high;
} Trial;

static Status refuse(const Instance *it, Status status, const char *what, const char *why) {
    Text text = {.size = 0};
    text_add(&text, "%s cannot be computed: %s", what, *why ? why : "a value is not finite.");
    log_text(it, status, OF_VALIDITY, text.text);
    return status;
}

Status instance_derive(Instance *it) {
    contact_message why;
    if (it->now.derived || !it->now.ready) return OK;
    contact_outputs kept = it->now.solution.outputs;
    it->now.derived = 1; /* once for each solution, also if it fails */
    why.text[0] = 0;
    if (contact_derivatives(&it->now.used, &it->now.solution.state, &it->now.solution.outputs, &why) == 0 &&
        outputs_finite(&it->now.solution.outputs))
        return OK;
    it->now.solution.outputs = kept;
    return refuse(it, WARNING, "The derivative of friction_force", why.text);
}

/* the inputs and outputs of a call */

static const Input *input_at(size_t place) {
    size_t i = 0;
    while (MODEL_INPUTS[i].place != place) i++;
    return &MODEL_INPUTS[i];
}

static Status check_references(Instance *it, const uint32_t unknown[], size_t unknowns, const uint32_t known[],
                               size_t knowns) {
    if (instance_may_change(it, "GetDirectionalDerivative") != OK) return ERROR;
    for (size_t i = 0; i < unknowns; i++) {
        const Variable *v = instance_variable(it, REAL, unknown[i]);
        if (!v) return ERROR;
        if (v->role != OUTPUT) return log_error(it, "%s is no output that has derivatives.", v->name);
    }
    for (size_t j = 0; j < knowns; j++) {
        const Variable *v = instance_variable(it, REAL, known[j]);
        if (!v) return ERROR;
        if (v->role != INPUT) return log_error(it, "%s is no input: derivatives are by inputs only.", v->name);
    }
    instance_refresh(it);
    if (!inputs_usable(&it->now.inputs))
        return refuse(it, DISCARD, "A directional derivative", "an input is out of its range.");
    if (it->now.ready) return OK;
    log_text(it, DISCARD, OF_VALIDITY,
             "There are no derivatives before the contact is initialised with inputs that can be used.");
    return DISCARD;
}

static const Derivative *own(const Variable *unknown, const Variable *known) {
    if (unknown->place != MODEL_FRICTION_FORCE) return NULL;
    for (size_t k = 0; k < MODEL_DERIVATIVES_COUNT; k++)
        if (MODEL_DERIVATIVES[k].input == known->place) return &MODEL_DERIVATIVES[k];
    return NULL;
}

/* columns of the matrix of derivatives */

/* Return 1 and the outputs at another value of an input, or 0 and why there are none. */
static int evaluated(const Instance *it, size_t place, double value, Trial *trial, contact_outputs *outputs,
                     contact_message *why) {
    contact_inputs inputs = it->now.inputs;
    ((double *)&inputs)[place] = value;
    trial->state = it->now.solution.state;
    *outputs = it->now.solution.outputs;
    why->text[0] = 0;
    return contact_step(&inputs, 0.0, &trial->state, outputs, why) == 0 && outputs_finite(outputs);
}

/* Derivatives of all outputs by one input, in trial->high. */
static Status differences(const Instance *it, size_t place, Trial *trial) {
    const Input *known = input_at(place);
    contact_message why;
    double value = ((const double *)&it->now.inputs)[place];
    double step = SHARE * fmax(fabs(value), known->nominal);
    double low = fmax(value - step, known->minimum), high = fmin(value + step, known->maximum);
    if (!evaluated(it, place, low, trial, &trial->low, &why)) low = value;
    if (!evaluated(it, place, high, trial, &trial->high, &why)) high = value;
    contact_outputs *here = low == value ? &trial->low : &trial->high;
    if (low == high || ((low == value || high == value) && !evaluated(it, place, value, trial, here, &why)))
        return refuse(it, DISCARD, "A directional derivative", why.text);
    double *above = (double *)&trial->high;
    const double *below = (const double *)&trial->low;
    for (size_t i = 0; i < OUTPUTS; i++) above[i] = (above[i] - below[i]) / (high - low);
    return OK;
}

/* The contact's own derivatives, in trial->low. */
static Status own_derivatives(const Instance *it, Trial *trial) {
    contact_message why;
    trial->low = it->now.solution.outputs;
    why.text[0] = 0;
    if (contact_derivatives(&it->now.inputs, &it->now.solution.state, &trial->low, &why) == 0 && outputs_finite(&trial->low))
        return OK;
    return refuse(it, DISCARD, "A directional derivative", why.text);
}

/* Derivatives of the unknowns by one input, in place of theirs in trial->high. */
static Status column(const Instance *it, const uint32_t unknown[], size_t unknowns, const Variable *known, Trial *trial) {
    const Derivative *found = NULL;
    int others = 0;
    for (size_t i = 0; i < unknowns; i++) {
        const Derivative *of_this = own(&MODEL_VARIABLES[unknown[i]], known);
        found = of_this ? of_this : found;
        others |= !of_this;
    }
    if (others && differences(it, known->place, trial) != OK) return DISCARD;
    if (!found) return OK;
    if (own_derivatives(it, trial) != OK) return DISCARD;
    ((double *)&trial->high)[MODEL_FRICTION_FORCE] = ((const double *)&trial->low)[found->output];
    return OK;
}

Status instance_forward(Instance *it, const uint32_t unknown[], size_t unknowns, const uint32_t known[], size_t knowns,
                        const double seed[], double change[]) {
    Trial trial;
    Status status = check_references(it, unknown, unknowns, known, knowns);
    for (size_t i = 0; i < unknowns; i++) change[i] = 0.0;
    for (size_t j = 0; j < knowns && status == OK; j++) {
        status = column(it, unknown, unknowns, &MODEL_VARIABLES[known[j]], &trial);
        for (size_t i = 0; i < unknowns && status == OK; i++)
            change[i] += seed[j] * ((const double *)&trial.high)[MODEL_VARIABLES[unknown[i]].place];
    }
    return status;
}

Status instance_backward(Instance *it, const uint32_t unknown[], size_t unknowns, const uint32_t known[], size_t knowns,
                         const double seed[], double change[]) {
    Trial trial;
    Status status = check_references(it, unknown, unknowns, known, knowns);
    for (size_t j = 0; j < knowns; j++) change[j] = 0.0;
    for (size_t j = 0; j < knowns && status == OK; j++) {
        status = column(it, unknown, unknowns, &MODEL_VARIABLES[known[j]], &trial);
        for (size_t i = 0; i < unknowns && status == OK; i++)
            change[j] += seed[i] * ((const double *)&trial.high)[MODEL_VARIABLES[unknown[i]].place];
    }
    return status;
}
