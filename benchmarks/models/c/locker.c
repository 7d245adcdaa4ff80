/* y' = u; instances are made one after the other, under a lock, and take 20 ms each. */

#include <pthread.h>
#include <unistd.h>

#include "model.h"

static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

void model_made(void)
{
    pthread_mutex_lock(&turn);
    usleep(20000);
    pthread_mutex_unlock(&turn);
}

void model_freed(void)
{
    pthread_mutex_lock(&turn);
    pthread_mutex_unlock(&turn);
}

void model_start(State *m) { m->memory[0] = VALUE(y0); }

void model_outputs(State *m) { VALUE(y) = m->memory[0]; }

Outcome model_step(State *m, void *work, double h, int may_return_early, int event_mode)
{
    (void)work, (void)may_return_early, (void)event_mode;
    m->memory[0] += input_integral(m, V_u, h);
    return done(m, h);
}
