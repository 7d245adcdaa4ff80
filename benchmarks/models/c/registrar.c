/* y' = u; the library keeps a register of its instances, and takes no step for one that is not in it. */

#include "model.h"

enum { MOST = 8 };
static const State *known[MOST];
static unsigned count;

static int is_known(const State *m)
{
    for (unsigned i = 0; i < MOST; i++)
        if (known[i] == m) return 1;
    return 0;
}

void model_start(State *m)
{
    m->memory[0] = VALUE(y0);
    if (!is_known(m)) known[count++ % MOST] = m;
}

void model_outputs(State *m) { VALUE(y) = m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    if (!is_known(m)) return refused(m, ERROR, "This library knows of no such instance.");
    m->memory[0] += input_integral(m, V_u, h);
    return done(m, h);
}
