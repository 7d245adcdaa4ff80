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

/* SELDOM: beside the way of usual numbers. OFTEN: one copy for all calls, as a step is longer than what processors keep of
   decoded instructions; two calls with the same numbers are one. */
#ifdef __GNUC__
#define SELDOM static __attribute__((noinline, cold, unused))
#define OFTEN static __attribute__((noinline, const, unused))
#else
#define SELDOM static
#define OFTEN static inline
#endif

/* bits of a double: 1 of the sign, 11 of the exponent, 52 of the fraction */
#define LEAST_NORMAL 0x0010000000000000u
#define NORMAL 0x7fe0000000000000u /* positive normal numbers have bits from LEAST_NORMAL, and so many of them */
#define UPPER_HALF 0xfffffffff8000000u

static inline double smaller(double x, double y) { return y < x ? y : x; }
static inline double larger(double x, double y) { return y > x ? y : x; }
static inline double squared(double x) { return x * x; }
static inline double cubed(double x) { return x * x * x; }
static inline double fourth_power(double x) { return squared(squared(x)); }
static inline double eighth_power(double x) { return squared(fourth_power(x)); }
static inline double fourth_root(double x) { return sqrt(sqrt(x)); }
static inline double power_0_75(double x) { return sqrt(x) * fourth_root(x); }
static inline double power_1_5(double x) { return x * sqrt(x); }

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

/* The first 26 bits of a double: the product of two such numbers is exact. */
static inline double upper_half(double x) { return from_bits(bits_of(x) & UPPER_HALF); }

/* a power of e: 2^(n / 256), by what share of that it is more, and the rest of the exponent beyond n ln(2) / 256 */
struct exp_sum {
    double scale;
    double more;
    double rest;
};

/* e^(high + low) of |high| < 708 and a small low. What comes late, low and the ends of series, is added last: a processor
   does the others in the meantime. */
static inline struct exp_sum exp_parts(double high, double low)
{
    const double rounded = high * PARTS_PER_LN2 + 0x1.8p52; /* its last bits are those of n, a whole number */
    const double n = rounded - 0x1.8p52;
    const uint64_t bits = bits_of(rounded);
    const double *part = power_of_two[bits & 255];
    const double r = ((high - n * PART_UPPER) - n * PART_LOWER) + low; /* at most ln(2) / 512: Taylor's series */
    const double r2 = r * r;
    const double more = (part[1] + r) + r2 * ((0.5 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0));
    const struct exp_sum found = {from_bits(bits_of(part[0]) + ((bits >> 8) << 52)), more, r};
    return found;
}

/* e^(high + low) where exp_parts has an end: near the largest number, below the smallest normal one, and beyond */
SELDOM double exp_at_ends(double high, double low)
{
    if (high > 709.782712893384) {
        return INFINITY;
    }
    if (!(high > -746.0)) {
        return high != high ? high : 0.0;
    }
    const double half = high > 0.0 ? 64.0 : -64.0;
    const struct exp_sum found = exp_parts(high - half, low);
    return (found.scale + found.scale * found.more) * (high > 0.0 ? 0x1.425982cf597cdp+92 : 0x1.969d47321e4ccp-93);
}

static inline double exp_of(double high, double low)
{
    if (!(fabs(high) < 708.0)) {
        return exp_at_ends(high, low);
    }
    const struct exp_sum found = exp_parts(high, low);
    return found.scale + found.scale * found.more;
}

/* a logarithm as a sum: a large part, and what is missing in it */
struct log_sum {
    double high;
    double low;
};

/* ln(x) of a normal x > 0, from its bits */
static inline struct log_sum log_parts(uint64_t bits)
{
    const uint64_t above = bits - LEAST_MANTISSA;
    const double *near = centre[(above >> 44) & 255];
    const double n = (double)((int64_t)above >> 52);
    const double m = from_bits(bits - (above & 0xfff0000000000000u)); /* x / 2^n, from about 0.69 to 1.38 */
    const double r = (m - near[0]) * near[1]; /* at most 1/512: Taylor's series */
    const double r2 = r * r;
    const double series = r2 * ((r * (1.0 / 3.0) - 0.5) + r2 * ((r * (1.0 / 5.0) - 0.25) - r2 * (1.0 / 6.0)));
    const double large = n * LN2_UPPER + near[2]; /* exact */
    const double high = large + r;
    const struct log_sum found = {high, (((large - high) + r) + (near[3] + n * LN2_LOWER)) + series};
    return found;
}

/* ln(x) of any finite x > 0 */
SELDOM struct log_sum log_of(double x)
{
    const uint64_t bits = bits_of(x);
    if (bits >= LEAST_NORMAL) {
        return log_parts(bits);
    }
    const struct log_sum found = log_parts(bits_of(x * 0x1p54));
    const struct log_sum scaled = {found.high - 54.0 * LN2_UPPER, found.low - 54.0 * LN2_LOWER};
    return scaled;
}

static inline double own_exp(double x) { return exp_of(x, 0.0); }

/* ln(x) of an x that is not normal, or not above 0 */
SELDOM double log_at_ends(double x)
{
    if (!(x > 0.0 && x < INFINITY)) {
        return x == 0.0 ? -INFINITY : x > 0.0 ? x : NAN;
    }
    const struct log_sum found = log_of(x);
    return found.high + found.low;
}

static inline double own_log(double x)
{
    const uint64_t bits = bits_of(x);
    if (bits - LEAST_NORMAL >= NORMAL) {
        return log_at_ends(x);
    }
    const struct log_sum found = log_parts(bits);
    return found.high + found.low;
}

static inline double own_log10(double x) { return own_log(x) * 0x1.bcb7b1526e50ep-2; }

static inline double own_log1p(double x)
{
    const double u = 1.0 + x;
    if (!(u > 0.0) || u > 0x1p52) {
        return own_log(u);
    }
    const double lost = u > 2.0 ? 1.0 - (u - x) : x - (u - 1.0); /* in the rounding of u */
    const struct log_sum found = log_parts(bits_of(u));
    return found.high + (found.low + lost / u);
}

static inline double own_expm1(double x)
{
    if (!(fabs(x) < 40.0)) {
        return own_exp(x) - 1.0;
    }
    const struct exp_sum found = exp_parts(x, 0.0);
    const double r = found.rest, r2 = r * r;
    const double more = found.more + r2 * r2 * (r * (1.0 / 120.0)); /* which counts where x is small */
    return (found.scale - 1.0) + found.scale * more;
}

/* x^y of an x that is zero, below the normal numbers, infinite or not a number */
SELDOM double power_at_ends(double x, double y)
{
    if (y == 0.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return x == 0.0 ? (y > 0.0 ? 0.0 : INFINITY) : NAN;
    }
    if (x > 0x1.fffffffffffffp+1023) {
        return y > 0.0 ? INFINITY : 0.0;
    }
    const struct log_sum found = log_of(x);
    return exp_of(found.high * y, found.low * y);
}

/* x^y, given the logarithm of a normal x */
static inline double power_of(struct log_sum of_x, double y)
{
    const double first = upper_half(of_x.high), of_y = upper_half(y);
    const double high = first * of_y; /* exact */
    return exp_of(high, (first * (y - of_y) + (of_x.high - first) * y) + of_x.low * y);
}

/* x^y of x >= 0 */
OFTEN double own_pow(double x, double y)
{
    const uint64_t bits = bits_of(x);
    if (x == 1.0) {
        return 1.0;
    }
    if (bits - LEAST_NORMAL >= NORMAL) {
        return power_at_ends(x, y);
    }
    return power_of(log_parts(bits), y);
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
    double found;
    if (!(size < 1e150)) {
        found = own_log(size) + LN2;
    } else {
        const double square = size * size;
        const double root = sqrt(1.0 + square);
        if (size > 1.0) {
            const struct log_sum of_sum = log_parts(bits_of(size + root));
            found = of_sum.high + of_sum.low;
        } else {
            const double more = size + square / (1.0 + root);
            const double u = 1.0 + more;
            const struct log_sum of_u = log_parts(bits_of(u));
            found = of_u.high + (of_u.low + (more - (u - 1.0)) / u);
        }
    }
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
