/* Elementary functions to about two units in the last place, by plain arithmetic: the same bits on every platform. */

#ifndef ELEMENTARY_H
#define ELEMENTARY_H

#ifdef __FAST_MATH__
#error "These functions count on the order of their additions: compile without -ffast-math and -Ofast."
#endif

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "tables.h"

static inline double smaller(double x, double y) { return y < x ? y : x; }
static inline double larger(double x, double y) { return y > x ? y : x; }
static inline double squared(double x) { return x * x; }

static inline double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* e^(high + low) as a scale and what is to be added to it: for |low| far below one unit in the last place of high */
static inline double exp_parts(double high, double low, double *added)
{
    const double rounded = high * PARTS_PER_LN2 + 0x1.8p52; /* n in its last bits */
    const double n = rounded - 0x1.8p52;
    const double r = (high - n * PART_UPPER) - (n * PART_LOWER - low); /* at most ln(2) / 128: Taylor's series */
    const double r2 = r * r;
    const double end = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0);
    const double series = r + r2 * ((0.5 + r * (1.0 / 6.0)) + r2 * end);
    const int64_t whole = (int64_t)n;
    const double *part = power_of_two[whole & 63];
    const double scale = from_bits((uint64_t)(1023 + (whole >> 6)) << 52);
    *added = scale * (part[1] + part[0] * series);
    return scale * part[0];
}

static inline double exp_of(double high, double low)
{
    if (!(fabs(high) < 708.0)) {
        if (high > 709.782712893384) {
            return INFINITY;
        }
        if (high > -746.0) { /* near the largest number, or below the smallest normal one */
            const double half = high > 0.0 ? 64.0 : -64.0;
            return exp_of(high - half, low) * (high > 0.0 ? 0x1.425982cf597cdp+92 : 0x1.969d47321e4ccp-93);
        }
        return high != high ? high : 0.0;
    }
    double added;
    const double scale = exp_parts(high, low, &added);
    return scale + added;
}

/* ln(x + extra) of a finite x > 0 and an extra below its last place as a sum: a large part and what is missing in it */
static inline double log_of(double x, double extra, double *low)
{
    int64_t exponent = 0;
    if (x < 0x1p-1022) { /* not normal */
        x *= 0x1p54;
        exponent = -54;
    }
    uint64_t bits = bits_of(x);
    const int64_t above = (bits & 0x000fffffffffffffu) > 0x6a09e667f3bcdu; /* the square root of 2 */
    const int64_t power = (int64_t)(bits >> 52) - 1023 + above;
    bits = (bits & 0x000fffffffffffffu) | (uint64_t)(1023 - above) << 52;
    const double m = from_bits(bits);
    const int k = (int)(m * 128.0 + 0.5);
    const double *near = centre[k - FIRST_CENTRE];
    const double n = (double)(exponent + power);
    const double shift = extra == 0.0 ? 0.0 : extra * from_bits((uint64_t)(1023 - power) << 52);
    const double r = ((m - k * 0x1p-7) + shift) * near[0]; /* at most 1/180: Taylor's series */
    const double r2 = r * r;
    const double series = r2 * ((r * (1.0 / 3.0) - 0.5) + r2 * ((r * (1.0 / 5.0) - 0.25) + r2 * (r * (1.0 / 7.0) - 1.0 / 6.0)));
    const double large = n * LN2_UPPER + near[1]; /* exact */
    const double high = large + r;
    *low = ((large - high) + r) + (series + (near[2] + n * LN2_LOWER));
    return high;
}

static inline double own_exp(double x) { return exp_of(x, 0.0); }

static inline double own_log(double x)
{
    if (!(x > 0.0)) {
        return x < 0.0 || x != x ? NAN : -INFINITY;
    }
    if (x > 0x1.fffffffffffffp+1023) {
        return x;
    }
    double low;
    const double high = log_of(x, 0.0, &low);
    return high + low;
}

static inline double own_log10(double x) { return own_log(x) * 0x1.bcb7b1526e50ep-2; }

static inline double own_log1p(double x)
{
    const double u = 1.0 + x;
    if (!(u > 0.0) || u > 0x1p52) {
        return own_log(u);
    }
    double low;
    const double high = log_of(u, u > 2.0 ? 1.0 - (u - x) : x - (u - 1.0), &low); /* lost in the rounding of u */
    return high + low;
}

static inline double own_expm1(double x)
{
    if (!(fabs(x) < 40.0)) {
        return own_exp(x) - 1.0;
    }
    double added;
    const double scale = exp_parts(x, 0.0, &added);
    return (scale - 1.0) + added;
}

/* x^y of x >= 0 */
static inline double own_pow(double x, double y)
{
    if (y == 0.0 || x == 1.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return x == 0.0 ? (y > 0.0 ? 0.0 : INFINITY) : NAN;
    }
    if (x > 0x1.fffffffffffffp+1023) {
        return y > 0.0 ? INFINITY : 0.0;
    }
    double low;
    const double high = log_of(x, 0.0, &low);
    const double product = high * y;
    if (!(fabs(product) < 750.0)) {
        return product != product ? NAN : product > 0.0 ? INFINITY : 0.0;
    }
    /* what the rounding of the product loses, by Dekker's halves */
    const double a = high * 134217729.0, b = y * 134217729.0;
    const double a1 = a - (a - high), b1 = b - (b - y);
    const double a2 = high - a1, b2 = y - b1;
    const double lost = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
    return exp_of(product, lost + low * y);
}

static inline double own_tanh(double x)
{
    if (!(fabs(x) < 20.0)) {
        return x != x ? x : x > 0.0 ? 1.0 : -1.0;
    }
    const double twice = own_expm1(2.0 * fabs(x));
    const double size = twice / (twice + 2.0);
    return x < 0.0 ? -size : size;
}

static inline double own_asinh(double x)
{
    const double size = fabs(x);
    const double square = size * size;
    const double found = size > 1e150 ? own_log(size) + 0x1.62e42fefa39efp-1
                                      : own_log1p(size + square / (1.0 + sqrt(1.0 + square)));
    return x < 0.0 ? -found : found;
}

static inline double own_hypot(double x, double y)
{
    const double large = larger(fabs(x), fabs(y)), small = smaller(fabs(x), fabs(y));
    if (large == 0.0 || large > 0x1.fffffffffffffp+1023) {
        return large;
    }
    if (y != y) {
        return y;
    }
    const double ratio = small / large;
    return large * sqrt(1.0 + ratio * ratio);
}

#endif
