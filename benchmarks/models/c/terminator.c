/* y' = u up to t_end, where the model ends the simulation. */

#include "model.h"

void model_start(State *m) { m->memory[0] = VALUE(y0); }

void model_outputs(State *m) { VALUE(y) = m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)event_mode;
    double rest = VALUE(t_end) - m->head.time;
    int ends = h > rest - 1e-9 * h;
    if (rest <= 1e-9 * h) return refused(m, ERROR, "The model has ended the simulation and takes no more steps.");
    if (ends && may_return_early) h = fmin(h, rest);
    m->memory[0] += input_integral(m, V_u, h);
    Outcome outcome = done(m, h);
    outcome.terminate = ends;
    return outcome;
}
