/* Products of all pairs of numbers, wide and narrow, by every shift and divisor.
 *
 * proves: lib/base/fixed.c
 * settles: ale_mul_shift ale_mul_div ale_wide_mul_shift ale_wide_mul_div wide_multiply wide_add is_middle
 *  middle_mul_shift quotient_digit magnitude signed_saturated
 * options: -eva-precision 0 -eva-split-return full -eva-slevel-function model_clzll:80,ale_wide_mul_shift:4
 *
 * Whether a product fits is asked of the lengths of both factors. The cases: a factor of a certain length,
 * and of the other one all that fit beside it, all that are too large, all that are too small. */
#include "unknown.h"

#include "base/fixed.h"

static void multiply(int64_t a, int64_t b)
{
    ale_mul_shift(a, b, (unsigned)unknown(0, 126));
    ale_mul_div(a, b, unknown(1, INT64_MAX));
    ale_mul_div(a, b, unknown(INT64_MIN, -1));
}

void main(void)
{
    //@ loop unroll 64;
    for (unsigned bits = 0; bits <= 63; bits++) {
        //@ loop unroll 2;
        for (int negative = 0; negative <= 1; negative++) {
            const int64_t a = unknown_of_bits(bits, negative);
            const int64_t fits = bits <= 61 ? (int64_t)1 << (61 - bits) : 0;
            multiply(a, unknown(-fits, fits > 0 ? fits - 1 : 0));
            multiply(a, unknown(INT64_MIN, -fits - 1));
            multiply(a, unknown(fits, INT64_MAX));
        }
    }
}
