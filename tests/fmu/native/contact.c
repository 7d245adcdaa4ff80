/* Stands in for the equations of a scene: closed formulas, a state that grows, and inputs that are refused. */

#include "contact.h"

#include <math.h>
#include <stdio.h>

static const double HOTTEST = 450.0, ODD_SPEED = 99.0; /* K, m/s: refused; not a number comes out */
static const double BEDDING = 500.0;                   /* N: the fresh state depends on the load */

static int refuse(const contact_inputs *in, contact_message *why)
{
    if (in->temperature <= HOTTEST) return 0;
    snprintf(why->text, sizeof why->text, "temperature = %g K must be at most %g K at 100 %% load. Choose a lower one.",
             in->temperature, HOTTEST);
    return 1;
}

static double friction(const contact_inputs *in, const contact_state *state)
{
    double sliding = in->speed_1 - in->speed_2;
    return -in->load * sliding / sqrt(1e-4 + sliding * sliding) * (0.1 + 0.01 * state->film / (1.0 + state->film)) +
           1e-3 * (in->temperature - 300.0);
}

static void evaluate(const contact_inputs *in, const contact_state *state, contact_outputs *out)
{
    out->friction_force = friction(in, state);
    out->power_loss = fabs(out->friction_force * (in->speed_1 - in->speed_2));
    out->wear_volume_1 = state->worn;
    out->tribofilm_1 = state->film;
    out->h_c = sqrt(in->radius_x) * in->load / (1.0 + state->film);
    out->load_cycles_1 = state->cycles;
    out->range_flags = in->load > 1000.0 ? 512.0 + 8.0 : 0.0;
    if (in->speed_1 == ODD_SPEED) out->h_c = sqrt(-1.0);
}

int contact_initialise(const contact_inputs *in, contact_state *state, contact_outputs *out, contact_message *why)
{
    const contact_state fresh = {0.0, 0.0, in->load > BEDDING ? 1.0 : 0.0};
    if (in->load == 0.0) {
        snprintf(why->text, sizeof why->text, "load = 0 N must be above 0 N at the start. Choose a higher one.");
        return 1;
    }
    if (refuse(in, why)) return 1;
    *state = fresh;
    evaluate(in, state, out);
    return 0;
}

int contact_step(const contact_inputs *in, double dt, contact_state *state, contact_outputs *out, contact_message *why)
{
    if (refuse(in, why)) return 1;
    state->film += dt / 10.0 * (1.0 - state->film / 3.0) / (1.0 + dt);
    state->worn += 1e-16 * in->load * fabs(in->speed_1 - in->speed_2) * dt / (1.0 + state->film);
    state->cycles += fabs(in->speed_1) * dt / 0.1;
    evaluate(in, state, out);
    return 0;
}

int contact_derivatives(const contact_inputs *in, const contact_state *state, contact_outputs *out, contact_message *why)
{
    double sliding = in->speed_1 - in->speed_2, root = sqrt(1e-4 + sliding * sliding);
    double share = 0.1 + 0.01 * state->film / (1.0 + state->film);
    if (refuse(in, why)) return 1;
    out->dfriction_dspeed_1 = -in->load * share * 1e-4 / (root * root * root);
    out->dfriction_dspeed_2 = -out->dfriction_dspeed_1;
    out->dfriction_dload = -share * sliding / root;
    out->dfriction_dtemperature = 1e-3;
    return 0;
}
