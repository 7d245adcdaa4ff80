/* What the source of a model includes: its variables and its state. */

#ifndef MODEL_H
#define MODEL_H

#include "interface.h"

/* Written by benchmarks/models/build.py for each FMU: N_..., one V_... per variable, KIND, CAUSALITY, START, START_TEXT, TOKEN,
   and the switches ROLLBACK, INTERPOLATES, HAS_EVENT_MODE.  Value references count parameters first, then inputs, then
   outputs; strings come after all numbers. */
#include "variables.h"

struct State {
    Head head;
    double value[N_NUMBERS + 1];   /* by value reference */
    double slope[2][N_INPUTS + 1]; /* first and second derivative of the inputs in the step to come */
    double end_slope[N_INPUTS + 1]; /* first derivative of the inputs at the end of the last step */
    double memory[N_MEMORY + 1];   /* the model's own */
    char text[N_STRINGS + 1][TEXT];
};

const Layout LAYOUT = {
    .n_variables = N_VARIABLES,
    .n_numbers = N_NUMBERS,
    .n_strings = N_STRINGS,
    .first_input = FIRST_INPUT,
    .slopes_per_order = N_INPUTS + 1,
    .state = sizeof(State),
    .value = offsetof(State, value),
    .slope = offsetof(State, slope),
    .text = offsetof(State, text),
    .kind = KIND,
    .causality = CAUSALITY,
    .size = SIZE,
    .start = START,
    .start_text = START_TEXT,
    .token = TOKEN,
    .rollback = ROLLBACK,
    .interpolates = INTERPOLATES,
    .intermediate = INTERMEDIATE,
    .has_event_mode = HAS_EVENT_MODE,
};

/* Helpers for models. */
#define VALUE(name) (m->value[V_##name])

/* Value of an input `s` after the start of the step. */
static inline double input_at(const State *m, int input, double s)
{
    int i = input - FIRST_INPUT;
    return m->value[input] + s * (m->slope[0][i] + 0.5 * s * m->slope[1][i]);
}

/* Its integral over the first `s` seconds of the step. */
static inline double input_integral(const State *m, int input, double s)
{
    int i = input - FIRST_INPUT;
    return s * (m->value[input] + s * (m->slope[0][i] / 2.0 + s * m->slope[1][i] / 6.0));
}

/* A step that went through: time and inputs move to its end, and the derivatives of the inputs are used up. */
static inline Outcome done(State *m, double h)
{
    for (int i = 0; i < N_INPUTS; i++) {
        m->value[FIRST_INPUT + i] = input_at(m, FIRST_INPUT + i, h);
        m->end_slope[i] = m->slope[0][i] + h * m->slope[1][i];
        m->slope[0][i] = m->slope[1][i] = 0.0;
    }
    m->head.time += h;
    return (Outcome){.reached = m->head.time};
}

/* A step that was not taken at all. */
static inline Outcome refused(const State *m, Status status, const char *message)
{
    return (Outcome){.reached = m->head.time, .status = status, .message = message};
}

#endif
