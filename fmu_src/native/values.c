#include <math.h>
#include <string.h>

#include "instance.h"
#include "log.h"

/* Hosts print and read parameters as text: two numbers that differ by this share are one. */
static const double ROUNDED = 1e-12;

static const char *const KINDS[] = {"Real", "Integer", "Boolean", "String"};

const Variable *instance_variable(Instance *it, Kind kind, uint32_t reference) {
    if (reference < MODEL_VARIABLES_COUNT && MODEL_VARIABLES[reference].kind == kind) return &MODEL_VARIABLES[reference];
    log_error(it, "There is no %s variable with value reference %lu.", KINDS[kind], (unsigned long)reference);
    return NULL;
}

int32_t instance_integer(double value) {
    return -2147483648.0 <= value && value <= 2147483647.0 ? (int32_t)value : 0;
}

static double value_of(const Instance *it, const Variable *v) {
    switch (v->role) {
    case INPUT: return ((const double *)&it->now.inputs)[v->place];
    case OUTPUT:
    case DERIVATIVE: return ((const double *)&it->now.solution.outputs)[v->place];
    case VALID: return it->now.valid;
    case FIDELITY_USED: return it->now.fidelity_used;
    case TIME: return it->now.time;
    case FIXED: break;
    }
    return v->start;
}

/* Settle or derive if the variable needs it. A warning is about the model, and logged: the values are valid. */
static void renew(Instance *it, const Variable *v) {
    if (v->role == INPUT || v->role == FIXED) return;
    instance_refresh(it);
    if (v->role == DERIVATIVE) instance_derive(it);
}

Status instance_get(Instance *it, Kind kind, uint32_t reference, double *value) {
    const Variable *v = instance_variable(it, kind, reference);
    if (!v) return ERROR;
    renew(it, v);
    *value = value_of(it, v);
    return OK;
}

Status instance_get_text(Instance *it, uint32_t reference, const char **text) {
    if (!instance_variable(it, STRING, reference)) return ERROR;
    *text = "";
    return OK;
}

static Status check_role(Instance *it, const Variable *v) {
    if (instance_may_change(it, "Set") != OK) return ERROR;
    if (v->role == TIME)
        return log_error(it, "%s is the independent variable: %s%s and %sDoStep set it.", v->name, it->host.prefix,
                         it->host.experiment, it->host.prefix);
    if (v->role != INPUT && v->role != FIXED)
        return log_error(it, "%s is an output and cannot be set.", v->name);
    if (v->role == FIXED && it->now.phase >= STEPPING)
        return log_error(it, "%s is a fixed parameter: after initialisation it cannot be set.", v->name);
    return OK;
}

static Status refuse_parameter(Instance *it, const Variable *v, const char *value) {
    Text why = {.size = 0};
    text_add(&why, "%s = %s is not possible: it is built into this FMU as ", v->name, value);
    if (v->kind == STRING)
        text_add(&why, "the empty text");
    else
        text_add(&why, "%.15g", v->start);
    text_add(&why, ". Build the FMU anew with the value, or build another flavour, whose parameters can be set.");
    log_text(it, ERROR, OF_VALIDITY, why.text);
    return ERROR;
}

Status instance_check(Instance *it, Kind kind, uint32_t reference, double value) {
    const Variable *v = instance_variable(it, kind, reference);
    if (!v || check_role(it, v) != OK) return ERROR;
    if (v->role == INPUT || fabs(value - v->start) <= ROUNDED * fabs(v->start)) return OK;
    Text text = {.size = 0};
    text_add(&text, "%.15g", value);
    return refuse_parameter(it, v, text.text);
}

Status instance_check_text(Instance *it, uint32_t reference, const char *text) {
    const Variable *v = instance_variable(it, STRING, reference);
    if (!v || check_role(it, v) != OK) return ERROR;
    if (!text || !*text) return OK;
    Text shown = {.size = 0};
    text_add(&shown, "'%.200s'", text);
    return refuse_parameter(it, v, shown.text);
}

void instance_store(Instance *it, uint32_t reference, double value) {
    const Variable *v = &MODEL_VARIABLES[reference];
    if (v->role == INPUT) ((double *)&it->now.inputs)[v->place] = value;
    if (it->now.phase == SETTLED) it->now.phase = UNSETTLED;
    if (it->now.phase == STEPPING && MODEL_FOLLOWS && v->role == INPUT) it->now.phase = BEHIND;
}
