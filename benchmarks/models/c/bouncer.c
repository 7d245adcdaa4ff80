/* A ball in free flight, with its bounces inside the step; it rests once it leaves the ground slower than V_REST. */

#include "model.h"

#define V_REST 1e-6 /* m/s */
#define HEIGHT m->memory[0]
#define SPEED m->memory[1]
#define BOUNCES m->memory[2]

void model_start(State *m)
{
    HEIGHT = VALUE(h0);
    SPEED = VALUE(v0);
    BOUNCES = 0.0;
}

void model_outputs(State *m)
{
    VALUE(h) = HEIGHT;
    VALUE(v) = SPEED;
    VALUE(bounces) = BOUNCES;
}

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    double g = VALUE(g), rest = h;
    int resting = HEIGHT == 0.0 && SPEED == 0.0;
    while (!resting) {
        double impact = sqrt(SPEED * SPEED + 2.0 * g * HEIGHT), fall = (SPEED + impact) / g;
        if (fall > rest) break;
        HEIGHT = 0.0;
        SPEED = VALUE(e) * impact;
        BOUNCES += 1.0;
        rest -= fall;
        resting = SPEED < V_REST;
        if (resting) SPEED = 0.0;
    }
    if (!resting) {
        HEIGHT += rest * (SPEED - 0.5 * g * rest);
        SPEED -= g * rest;
    }
    return done(m, h);
}
