/* Elementary functions of arrays, each in its place. Compilers that have vectors compute two numbers at a time, by the
   operations of elementary.h in their order: the bits are those of one at a time. */

#ifndef ELEMENTARY_ARRAYS_H
#define ELEMENTARY_ARRAYS_H

#include "elementary.h"

#ifdef __GNUC__

#define SIGN 0x8000000000000000u
#define WHOLE_AT_2_52 0x4330000000000000u /* 2^52, the last bits of whose fraction count ones */

typedef double pair __attribute__((vector_size(16)));
typedef uint64_t pair_bits __attribute__((vector_size(16)));
typedef int64_t pair_test __attribute__((vector_size(16)));

static inline pair pair_from(const double *from)
{
    pair found;
    memcpy(&found, from, sizeof found);
    return found;
}

static inline void pair_to(double *to, pair x) { memcpy(to, &x, sizeof x); }
static inline pair pair_size(pair x) { return (pair)((pair_bits)x & ~SIGN); }
static inline int pair_is(pair_test test) { return (test[0] & test[1]) != 0; }

/* exp_of, of |high| < 708 */
static inline pair pair_exp_of(pair high, pair low)
{
    const pair rounded = high * PARTS_PER_LN2 + 0x1.8p52;
    const pair n = rounded - 0x1.8p52;
    const pair_bits bits = (pair_bits)rounded;
    const double *one = power_of_two[bits[0] & 255], *two = power_of_two[bits[1] & 255];
    const pair part = {one[0], two[0]}, missing = {one[1], two[1]};
    const pair r = ((high - n * PART_UPPER) - n * PART_LOWER) + low;
    const pair r2 = r * r;
    const pair more = (missing + r) + r2 * ((0.5 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0));
    const pair scale = (pair)((pair_bits)part + ((bits >> 8) << 52));
    return scale + scale * more;
}

struct pair_log {
    pair high;
    pair low;
};

/* log_parts of normal x > 0 */
static inline struct pair_log pair_log_parts(pair x)
{
    const pair_bits bits = (pair_bits)x, above = bits - LEAST_MANTISSA;
    const double *one = centre[(above[0] >> 44) & 255], *two = centre[(above[1] >> 44) & 255];
    const pair near_0 = {one[0], two[0]}, near_1 = {one[1], two[1]};
    const pair near_2 = {one[2], two[2]}, near_3 = {one[3], two[3]};
    /* n has 12 bits, of which the first one counts -2048: added to 2^52 as a whole number, and taken off again */
    const pair n = (pair)((above >> 52) ^ (WHOLE_AT_2_52 | 2048u)) - (0x1p52 + 2048.0);
    const pair m = (pair)(bits - (above & 0xfff0000000000000u));
    const pair r = (m - near_0) * near_1;
    const pair r2 = r * r;
    const pair series = r2 * ((r * (1.0 / 3.0) - 0.5) + r2 * ((r * (1.0 / 5.0) - 0.25) - r2 * (1.0 / 6.0)));
    const pair large = n * LN2_UPPER + near_2;
    const pair high = large + r;
    const struct pair_log found = {high, (((large - high) + r) + (near_3 + n * LN2_LOWER)) + series};
    return found;
}

/* own_exp; 0 where one of both is beyond the ends of exp_of */
static inline int pair_exp(double *x)
{
    const pair high = pair_from(x);
    if (!pair_is(pair_size(high) < 708.0)) {
        return 0;
    }
    pair_to(x, pair_exp_of(high, high - high));
    return 1;
}

/* own_pow; 0 where one of both is at an end */
static inline int pair_pow(pair *x, pair y)
{
    if (!pair_is((*x >= 0x1p-1022) & (*x <= 0x1.fffffffffffffp+1023))) {
        return 0;
    }
    const struct pair_log of_x = pair_log_parts(*x);
    const pair first = (pair)((pair_bits)of_x.high & UPPER_HALF), of_y = (pair)((pair_bits)y & UPPER_HALF);
    const pair high = first * of_y;
    if (!pair_is(pair_size(high) < 708.0)) {
        return 0;
    }
    *x = pair_exp_of(high, (first * (y - of_y) + (of_x.high - first) * y) + of_x.low * y);
    return 1;
}

static inline int pair_of_pows(double *x, double y)
{
    pair both = pair_from(x);
    if (!pair_pow(&both, (pair){y, y})) {
        return 0;
    }
    pair_to(x, both);
    return 1;
}

/* own_asinh; 0 where both are not on the same side of 1, or one has no square */
static inline int pair_asinh(double *x)
{
    const pair given = pair_from(x), size = pair_size(given);
    const int large = pair_is((size > 1.0) & (size < 1e150));
    if (!large && !pair_is(size <= 1.0)) {
        return 0;
    }
    const pair square = size * size, sum = 1.0 + square;
    const pair root = {sqrt(sum[0]), sqrt(sum[1])};
    pair found;
    if (large) {
        const struct pair_log of_sum = pair_log_parts(size + root);
        found = of_sum.high + of_sum.low;
    } else {
        const pair more = size + square / (1.0 + root);
        const pair u = 1.0 + more;
        const struct pair_log of_u = pair_log_parts(u);
        found = of_u.high + (of_u.low + (more - (u - 1.0)) / u);
    }
    pair_to(x, (pair)((pair_bits)found ^ ((pair_bits)(given < 0.0) & SIGN)));
    return 1;
}

#else

static inline int pair_exp(double *x) { return (void)x, 0; }
static inline int pair_of_pows(double *x, double y) { return (void)x, (void)y, 0; }
static inline int pair_asinh(double *x) { return (void)x, 0; }

#endif

static inline void own_exps(int count, double *x)
{
    for (int i = 0; i < count; ++i) {
        if (i + 1 < count && pair_exp(x + i)) {
            ++i;
        } else {
            x[i] = own_exp(x[i]);
        }
    }
}

static inline void own_pows(int count, double *x, double y)
{
    for (int i = 0; i < count; ++i) {
        if (i + 1 < count && pair_of_pows(x + i, y)) {
            ++i;
        } else {
            x[i] = own_pow(x[i], y);
        }
    }
}

static inline void own_asinhs(int count, double *x)
{
    for (int i = 0; i < count; ++i) {
        if (i + 1 < count && pair_asinh(x + i)) {
            ++i;
        } else {
            x[i] = own_asinh(x[i]);
        }
    }
}

struct two_powers {
    double first;
    double second;
};

SELDOM struct two_powers powers_one_by_one(double x, double a, double y, double b)
{
    const struct two_powers found = {own_pow(x, a), own_pow(y, b)};
    return found;
}

/* x^a and y^b */
OFTEN struct two_powers own_two_powers(double x, double a, double y, double b)
{
#ifdef __GNUC__
    pair both = {x, y};
    if (pair_pow(&both, (pair){a, b})) {
        return (struct two_powers){both[0], both[1]};
    }
#endif
    return powers_one_by_one(x, a, y, b);
}

#endif
