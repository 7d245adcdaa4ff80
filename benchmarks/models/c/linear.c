/* x' = A x + B u + b, y = C x + D u + c: exact where the inputs are polynomials of degree two over the step.

The matrix exponential of the system that the inputs' derivatives enlarge (Van Loan 1978, doi 10.1109/TAC.1978.1101743)
carries x, u, u' and u'' over the step; it is worked out again only where the step or a parameter has changed.

variables.h gives N_X, N_U = N_INPUTS + 1 (the last input is the constant one), N_Y, FIRST_OUTPUT and
matrices(value, A, B, C, D), starts(value, x). */

#include "model.h"

#define N (N_X + 3 * N_U) /* x, u, u', u'' */
#define TERMS 18          /* 2^-18 / 18! < 1e-21 */

typedef struct {
    double h, parameters[N_PARAMETERS + 1];
    int filled;
    double propagator[N_X][N];
} Work;

size_t model_work(void) { return sizeof(Work); }

static void multiply(double a[N][N], double b[N][N], double out[N][N])
{
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) out[i][j] = 0.0;
        for (int k = 0; k < N; k++)
            if (a[i][k] != 0.0)
                for (int j = 0; j < N; j++) out[i][j] += a[i][k] * b[k][j];
    }
}

/* exp(M) - 1 by the Taylor series of M / 2^n, doubled n times by exp(2 M) - 1 = (E + 2) E: a small step loses no digit. */
static void exponential_less_one(double M[N][N], double E[N][N])
{
    static const size_t size = sizeof(double[N][N]);
    double norm = 0.0, term[N][N], next[N][N];
    int doublings = 0;
    for (int i = 0; i < N; i++) {
        double row = 0.0;
        for (int j = 0; j < N; j++) row += fabs(M[i][j]);
        norm = fmax(norm, row);
    }
    for (; norm > 0.5; norm *= 0.5) doublings++;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) M[i][j] = ldexp(M[i][j], -doublings);
    memcpy(term, M, size);
    memcpy(E, M, size);
    for (int k = 2; k <= TERMS; k++) {
        multiply(term, M, next);
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) E[i][j] += term[i][j] = next[i][j] / k;
    }
    for (; doublings > 0; doublings--) {
        multiply(E, E, next);
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) E[i][j] = 2.0 * E[i][j] + next[i][j];
    }
}

static void fill(Work *work, const State *m, double h)
{
    double A[N_X][N_X], B[N_X][N_U], C[N_Y][N_X], D[N_Y][N_U], M[N][N] = {{0.0}}, E[N][N];
    matrices(m->value, A, B, C, D);
    for (int i = 0; i < N_X; i++) {
        for (int j = 0; j < N_X; j++) M[i][j] = h * A[i][j];
        for (int j = 0; j < N_U; j++) M[i][N_X + j] = h * B[i][j];
    }
    /* u' and u'' are scaled by h and h^2 / 2, so that every entry is of the size of h A or below 2 */
    for (int j = 0; j < N_U; j++) {
        M[N_X + j][N_X + N_U + j] = 1.0;
        M[N_X + N_U + j][N_X + 2 * N_U + j] = 2.0;
    }
    exponential_less_one(M, E);
    memcpy(work->propagator, E, sizeof work->propagator);
    work->h = h;
    memcpy(work->parameters, m->value, N_PARAMETERS * sizeof(double));
    work->filled = 1;
}

static double input(const State *m, int j) { return j < N_INPUTS ? m->value[FIRST_INPUT + j] : 1.0; }

void model_start(State *m) { starts(m->value, m->memory); }

void model_outputs(State *m)
{
    double A[N_X][N_X], B[N_X][N_U], C[N_Y][N_X], D[N_Y][N_U];
    matrices(m->value, A, B, C, D);
    for (int i = 0; i < N_Y; i++) {
        double y = 0.0;
        for (int j = 0; j < N_X; j++) y += C[i][j] * m->memory[j];
        for (int j = 0; j < N_U; j++) y += D[i][j] * input(m, j);
        m->value[FIRST_OUTPUT + i] = y;
    }
}

Outcome model_step(State *m, void *memory, double h, int may_return_early, int event_mode)
{
    (void)may_return_early, (void)event_mode;
    Work *work = memory;
    if (!work->filled || work->h != h || memcmp(work->parameters, m->value, N_PARAMETERS * sizeof(double)) != 0)
        fill(work, m, h);
    double z[N] = {0.0}, change[N_X];
    memcpy(z, m->memory, N_X * sizeof(double));
    for (int j = 0; j < N_U; j++) z[N_X + j] = input(m, j);
    for (int j = 0; j < N_INPUTS; j++) {
        z[N_X + N_U + j] = h * m->slope[0][j];
        z[N_X + 2 * N_U + j] = 0.5 * h * h * m->slope[1][j];
    }
    for (int i = 0; i < N_X; i++) {
        change[i] = 0.0;
        for (int j = 0; j < N; j++) change[i] += work->propagator[i][j] * z[j];
    }
    for (int i = 0; i < N_X; i++) m->memory[i] += change[i];
    return done(m, h);
}

int model_partial(const State *m, int output, int known, double *value)
{
    double A[N_X][N_X], B[N_X][N_U], C[N_Y][N_X], D[N_Y][N_U];
    matrices(m->value, A, B, C, D);
    *value = D[output - FIRST_OUTPUT][known - FIRST_INPUT];
    return 1;
}

int model_slope(const State *m, int output, double *value)
{
    double A[N_X][N_X], B[N_X][N_U], C[N_Y][N_X], D[N_Y][N_U];
    if (output < FIRST_OUTPUT) return 0;
    matrices(m->value, A, B, C, D);
    *value = 0.0;
    for (int i = 0; i < N_X; i++) {
        double rate = 0.0;
        for (int j = 0; j < N_X; j++) rate += A[i][j] * m->memory[j];
        for (int j = 0; j < N_U; j++) rate += B[i][j] * input(m, j);
        *value += C[output - FIRST_OUTPUT][i] * rate;
    }
    for (int j = 0; j < N_INPUTS; j++) *value += D[output - FIRST_OUTPUT][j] * m->end_slope[j];
    return 1;
}
