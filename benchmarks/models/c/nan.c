/* y' = u; the output is no number once t > t_nan. */

#include "model.h"

void model_start(State *m) { m->memory[0] = VALUE(y0); }

void model_outputs(State *m) { VALUE(y) = m->head.time > VALUE(t_nan) + 1e-9 ? NAN : m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    m->memory[0] += input_integral(m, V_u, h);
    return done(m, h);
}
