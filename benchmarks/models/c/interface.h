/* Between a model and the FMI functions, which are compiled once for all models.

The state of a model is one block of plain data, so that saving it is copying it. */

#ifndef INTERFACE_H
#define INTERFACE_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#define TEXT 128 /* bytes of a string, with its end */

typedef enum { OK, WARNING, DISCARD, ERROR } Status; /* the numbers of FMI 2 and FMI 3 */
typedef enum { NEW, INITIALISING, EVENTS, STEPPING, ENDED } Phase;

/* Where any state starts; what follows is the model's. */
typedef struct {
    double time;
    int phase;
    int event_pending;
} Head;

typedef struct State State;

/* A model's variables, and where its state holds them. */
typedef struct {
    unsigned n_variables, n_numbers, n_strings, first_input, slopes_per_order;
    size_t state, value, slope, text; /* size of the state, offsets in it */
    const char *kind, *causality;     /* a letter per variable; each element of an array counts as one */
    const unsigned *size;             /* of the array whose first element this is */
    const double *start;
    const char *const *start_text;
    const char *token;
    int rollback, interpolates, intermediate, has_event_mode;
} Layout;

extern const Layout LAYOUT;

typedef struct {
    double reached; /* time up to which the step was taken */
    Status status;
    int event; /* must be handled in event mode */
    int terminate;
    const char *message;
} Outcome;

/* What a model is: `value` of its state holds parameters and inputs, and model_outputs writes the outputs. */
void model_start(State *);   /* memory from parameters */
void model_outputs(State *); /* outputs from memory, inputs and time */
Outcome model_step(State *, void *work, double h, int may_return_early, int event_mode);

/* What a model may leave out. */
void model_event(State *);               /* event mode: the pending event happens */
double model_next_event(const State *);  /* its time, or NAN */
int model_partial(const State *, int output, int input, double *value); /* d output / d input; 0: unknown */
int model_slope(const State *, int output, double *value);              /* d output / dt; 0: unknown */
void model_made(void);  /* a new instance */
void model_freed(void); /* one that is to go */
size_t model_work(void); /* bytes of scratch memory of an instance, zero at first, never part of the state */

#endif
