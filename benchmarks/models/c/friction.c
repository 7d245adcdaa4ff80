/* F = -N mu(u), mu = (mu_d + (mu_s - mu_d) exp(-|u| / u_s)) tanh(u / u_r). */

#include "model.h"

/* Force and its derivative to u. */
static double force(const State *m, double *dF_du)
{
    double u = VALUE(u), fall = (VALUE(mu_s) - VALUE(mu_d)) * exp(-fabs(u) / VALUE(u_s)), t = tanh(u / VALUE(u_r));
    double mu = VALUE(mu_d) + fall;
    /* |u|' tanh(u / u_r) = |tanh(u / u_r)| */
    *dF_du = -VALUE(N) * (mu * (1.0 - t * t) / VALUE(u_r) - fall / VALUE(u_s) * fabs(t));
    return -VALUE(N) * mu * t;
}

void model_start(State *m) { (void)m; }

void model_outputs(State *m) { VALUE(F) = force(m, &VALUE(dF_du)); }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    return done(m, h);
}

int model_partial(const State *m, int output, int input, double *value)
{
    force(m, value);
    return output == V_F && input == V_u;
}
