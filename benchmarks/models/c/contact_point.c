/* F = F_ref (x / x_ref)^(3/2) + c v while x > 0, never below zero. */

#include "model.h"

/* Force and its derivatives to x and v; all zero out of contact. */
static double force(const State *m, double *dF_dx, double *dF_dv)
{
    double x = fmax(VALUE(x), 0.0) / VALUE(x_ref), root = sqrt(x);
    double F = VALUE(F_ref) * x * root + VALUE(c) * VALUE(v);
    int touches = VALUE(x) > 0.0 && F > 0.0;
    *dF_dx = touches ? 1.5 * VALUE(F_ref) / VALUE(x_ref) * root : 0.0;
    *dF_dv = touches ? VALUE(c) : 0.0;
    return touches ? F : 0.0;
}

void model_start(State *m) { (void)m; }

void model_outputs(State *m)
{
    VALUE(F) = force(m, &VALUE(dF_dx), &VALUE(dF_dv));
    VALUE(in_contact) = VALUE(x) > 0.0;
}

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    return done(m, h);
}

int model_partial(const State *m, int output, int input, double *value)
{
    double dF_dx, dF_dv;
    force(m, &dF_dx, &dF_dv);
    *value = input == V_x ? dF_dx : dF_dv;
    return output == V_F;
}
