/* The tooth in mesh, and its stiffness: k for even teeth, k (1 + a) for odd ones. */

#include "model.h"

void model_start(State *m) { (void)m; }

void model_outputs(State *m)
{
    double tooth = floor(m->head.time / VALUE(period) + 1e-9);
    VALUE(tooth) = tooth;
    VALUE(stiffness) = VALUE(k) * (fmod(tooth, 2.0) == 0.0 ? 1.0 : 1.0 + VALUE(a));
}

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    return done(m, h);
}
