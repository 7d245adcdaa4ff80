/* u^2 + v^2 + w^2 = r2, with w >= 0. */

#include "model.h"

void model_start(State *m) { (void)m; }

void model_outputs(State *m) { VALUE(w) = sqrt(VALUE(r2) - VALUE(u) * VALUE(u) - VALUE(v) * VALUE(v)); }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    return done(m, h);
}
