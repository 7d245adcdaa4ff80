/* F = -c u - q u |u|, worked out in a step only, from u as it was held: no feedthrough, as of a quasi-static contact. */

#include "model.h"

static void answer(State *m)
{
    double u = VALUE(u);
    m->memory[0] = -VALUE(c) * u - VALUE(q) * u * fabs(u);
    m->memory[1] = -VALUE(c) - 2.0 * VALUE(q) * fabs(u);
}

void model_start(State *m) { answer(m); }

void model_outputs(State *m)
{
    VALUE(F) = m->memory[0];
    VALUE(dF_du) = m->memory[1];
}

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    answer(m);
    return done(m, h);
}
