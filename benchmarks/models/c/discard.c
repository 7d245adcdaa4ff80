/* y' = u, in steps of at most h_max: a longer one is refused, or with `partial` ends after h_max. */

#include "model.h"

void model_start(State *m) { m->memory[0] = VALUE(y0); }

void model_outputs(State *m) { VALUE(y) = m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)event_mode;
    int too_long = h > VALUE(h_max) * (1.0 + 1e-9);
    if (too_long && !(VALUE(partial) && may_return_early))
        return refused(m, DISCARD, "The step is longer than h_max.");
    if (too_long) h = VALUE(h_max);
    m->memory[0] += input_integral(m, V_u, h);
    return done(m, h);
}
