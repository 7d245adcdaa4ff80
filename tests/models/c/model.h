/* One model behind FMI 2 or FMI 3: its state is one block of plain data, so that saving it is copying it. */

#ifndef MODEL_H
#define MODEL_H

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Written by tests/models/build.py for each FMU: N_..., one V_... per variable, KIND, CAUSALITY, START, START_TEXT,
   and the switches ROLLBACK, INTERPOLATES.  Value references count parameters first, then inputs, then outputs; strings
   come after all numbers. */
#include "variables.h"

#define TEXT 128 /* bytes of a string, with its end */

typedef enum { OK, WARNING, DISCARD, ERROR } Status; /* the numbers of FMI 2 and FMI 3 */
typedef enum { NEW, INITIALISING, EVENTS, STEPPING, ENDED } Phase;

typedef struct {
    double time;
    double value[N_NUMBERS + 1];      /* by value reference */
    double slope[2][N_INPUTS + 1];    /* first and second derivative of the inputs in the step to come */
    double end_slope[N_INPUTS + 1];   /* first derivative of the inputs at the end of the last step */
    double memory[N_MEMORY + 1];      /* the model's own */
    char text[N_STRINGS + 1][TEXT];
    int phase;
    int event_pending;
} State;

typedef struct {
    double reached; /* time up to which the step was taken */
    Status status;
    int event;      /* must be handled in event mode */
    int terminate;
    const char *message;
} Outcome;

/* What a model is.  `m->value` holds parameters and inputs; model_outputs writes the outputs. */
void model_start(State *m);         /* memory from parameters */
void model_outputs(State *m);       /* outputs from memory, inputs and time */
Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode);

/* What a model may leave out. */
void model_event(State *m);         /* event mode: the pending event happens */
double model_next_event(const State *m); /* its time, or NAN */
int model_partial(const State *m, int output, int input, double *value);  /* d output / d input; 0: unknown */
int model_slope(const State *m, int output, double *value);              /* d output / dt; 0: unknown */
size_t model_work(void);             /* bytes of scratch memory of an instance, zero at first, never part of the state */

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
    m->time += h;
    return (Outcome){.reached = m->time};
}

/* A step that was not taken at all. */
static inline Outcome refused(const State *m, Status status, const char *message)
{
    return (Outcome){.reached = m->time, .status = status, .message = message};
}

#endif
