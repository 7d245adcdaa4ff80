/* y' = u with a jump of y by `jump` at each multiple of `period`. */

#include "model.h"

#define RAMP m->memory[0]
#define EVENTS_SO_FAR m->memory[1]

void model_start(State *m)
{
    RAMP = VALUE(y0);
    EVENTS_SO_FAR = floor(m->head.time / VALUE(period) + 1e-9);
}

void model_outputs(State *m)
{
    VALUE(y) = RAMP;
    VALUE(events) = EVENTS_SO_FAR;
}

void model_event(State *m)
{
    RAMP += VALUE(jump);
    EVENTS_SO_FAR += 1.0;
}

double model_next_event(const State *m) { return (EVENTS_SO_FAR + 1.0) * VALUE(period); }

/* With event mode, events are left to it: those at the end of the step always, those inside if it may end early. */
Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work;
    double end = m->head.time + h, close = 1e-9 * VALUE(period);
    int event = 0;
    while (!event && model_next_event(m) <= end + close) {
        double at = model_next_event(m);
        event = event_mode && (may_return_early || at >= end - close);
        if (!event) model_event(m);
        if (event && at < end - close) h = at - m->head.time;
    }
    RAMP += input_integral(m, V_u, h);
    Outcome outcome = done(m, h);
    outcome.event = event;
    return outcome;
}
