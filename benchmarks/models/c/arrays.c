/* Arrays of each type: y' = u, z = gains u column by column, counts that have one added, flags that are turned round. */

#include "model.h"

void model_start(State *m) { memset(m->memory, 0, sizeof m->memory); }

void model_outputs(State *m)
{
    const double *u = &VALUE(u);
    for (int i = 0; i < 3; i++) {
        (&VALUE(y))[i] = m->memory[i];
        (&VALUE(counted))[i] = (&VALUE(counts))[i] + 1.0;
    }
    for (int i = 0; i < 4; i++) {
        (&VALUE(z))[i] = (&VALUE(gains))[i] * u[i % 2];
        (&VALUE(flagged))[i] = !(&VALUE(flags))[i];
    }
}

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    for (int i = 0; i < 3; i++) m->memory[i] += input_integral(m, V_u + i, h);
    return done(m, h);
}
