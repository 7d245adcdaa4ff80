/* Elementary functions to about two units in the last place, by plain arithmetic: the same bits on every platform. */

#ifndef ELEMENTARY_H
#define ELEMENTARY_H

#include <math.h>
#include <stdint.h>
#include <string.h>

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

#define LN2_HIGH 0x1.62e42feep-1 /* with zeros at its end: n times it is exact */
#define LN2_LOW 0x1.a39ef35793c76p-33

/* e^(high + low) for |low| far below one unit in the last place of high */
static inline double exp_of(double high, double low)
{
    if (!(high < 709.7)) {
        return high >= 709.7 ? INFINITY : high; /* or not a number */
    }
    if (high < -708.3) { /* below the smallest normal number */
        return high < -746.0 ? 0.0 : exp_of(high + 64.0, low) * 0x1.969d47321e4ccp-93; /* e^-64 */
    }
    const double rounded = high * 0x1.71547652b82fep+0 + 0x1.8p52; /* n in its last bits */
    const double n = rounded - 0x1.8p52;
    const double r = (high - n * LN2_HIGH) - (n * LN2_LOW - low); /* at most ln(2) / 2 */
    /* Taylor's series up to r^13, the remainder is 2e-17 */
    const double r2 = r * r;
    const double r4 = r2 * r2;
    const double first = (1.0 / 6.0 + r * (1.0 / 24.0)) + r2 * (1.0 / 120.0 + r * (1.0 / 720.0));
    const double second = (1.0 / 5040.0 + r * (1.0 / 40320.0)) + r2 * (1.0 / 362880.0 + r * (1.0 / 3628800.0));
    const double third = (1.0 / 39916800.0 + r * (1.0 / 479001600.0)) + r2 * (1.0 / 6227020800.0);
    const double tail = r2 * (0.5 + r * (first + r4 * (second + r4 * third)));
    return (1.0 + (r + tail)) * from_bits((uint64_t)(1023 + (int64_t)n) << 52);
}

/* ln(x) of x > 0 as a sum: a large part and what is missing in it */
static inline double log_of(double x, double *low)
{
    int64_t exponent = 0;
    if (x < 0x1p-1022) { /* not normal */
        x *= 0x1p54;
        exponent = -54;
    }
    uint64_t bits = bits_of(x);
    exponent += (int64_t)(bits >> 52) - 1023;
    bits = (bits & 0x000fffffffffffffu) | 0x3ff0000000000000u;
    double m = from_bits(bits);
    if (m > 0x1.6a09e667f3bcdp+0) { /* the square root of 2 */
        m *= 0.5;
        exponent += 1;
    }
    const double n = (double)exponent;
    const double f = m - 1.0; /* exact */
    const double s = f / (2.0 + f);
    const double z = s * s;
    /* ln(1 + f) = 2 artanh(s) = f - f^2/2 + s (f^2/2 + R), R = 2/3 z + 2/5 z^2 + ... up to z^10 */
    const double z2 = z * z;
    const double z4 = z2 * z2;
    const double near = (2.0 / 3.0 + z * (2.0 / 5.0)) + z2 * (2.0 / 7.0 + z * (2.0 / 9.0));
    const double far = (2.0 / 11.0 + z * (2.0 / 13.0)) + z2 * (2.0 / 15.0 + z * (2.0 / 17.0));
    const double last = (2.0 / 19.0 + z * (2.0 / 21.0)) + z2 * (2.0 / 23.0);
    const double rest = z * (near + z4 * (far + z4 * last));
    const double half = 0.5 * f * f;
    const double small = s * (half + rest) + n * LN2_LOW;
    const double large = n * LN2_HIGH;
    const double tail = half - small;
    const double high = large + (f - tail);
    *low = ((large - high) + f) - tail;
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
    const double high = log_of(x, &low);
    return high + low;
}

static inline double own_log10(double x) { return own_log(x) * 0x1.bcb7b1526e50ep-2; }

static inline double own_log1p(double x)
{
    const double u = 1.0 + x;
    if (!(u > 0.0) || u > 0x1.fffffffffffffp+1023) {
        return own_log(u);
    }
    const double lost = u > 2.0 ? 1.0 - (u - x) : x - (u - 1.0); /* in the rounding of u */
    return own_log(u) + lost / u;
}

static inline double own_expm1(double x)
{
    if (!(fabs(x) < 0.35)) {
        return own_exp(x) - 1.0;
    }
    double sum = 0.0;
    for (int k = 16; k > 0; --k) {
        sum = (1.0 + sum) * x / k; /* Taylor's series */
    }
    return sum;
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
    const double high = log_of(x, &low);
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
    const double ratio = small / large;
    return large * sqrt(1.0 + ratio * ratio);
}

#endif
