/* y = a u + b + c u^2. */

#include "model.h"

void model_start(State *m) { (void)m; }

void model_outputs(State *m) { VALUE(y) = VALUE(a) * VALUE(u) + VALUE(b) + VALUE(c) * VALUE(u) * VALUE(u); }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    return done(m, h);
}

int model_partial(const State *m, int output, int input, double *value)
{
    (void)output, (void)input;
    *value = VALUE(a) + 2.0 * VALUE(c) * VALUE(u);
    return 1;
}
