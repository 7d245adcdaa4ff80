/* y' = u; a step that ends after t_fail is an error. */

#include "model.h"

void model_start(State *m) { m->memory[0] = VALUE(y0); }

void model_outputs(State *m) { VALUE(y) = m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    if (m->head.time + h > VALUE(t_fail) + 1e-9) return refused(m, ERROR, "The model fails after t_fail, as it was asked to.");
    m->memory[0] += input_integral(m, V_u, h);
    return done(m, h);
}
