/* Rounding shifts and divisions, roots, lengths, for all that their contracts allow.
 *
 * proves: lib/base/fixed.c
 * settles: ale_round_shift ale_beyond ale_isqrt ale_bit_length ale_mul_nano
 * options: -eva-slevel 70 */
#include "unknown.h"

#include "base/fixed.h"

static void shifts(void)
{
    //@ loop unroll 63;
    for (unsigned shift = 0; shift <= 62; shift++) {
        const int64_t most = INT64_MAX - (shift == 0 ? 0 : (int64_t)1 << (shift - 1));
        ale_round_shift(unknown(-most, most), shift);
        ale_beyond(unknown(INT64_MIN, INT64_MAX), shift);
    }
}

/* |num| + den / 2 <= INT64_MAX, for divisors of one length at a time. */
static void divisions(void)
{
    //@ loop unroll 64;
    for (unsigned bits = 1; bits <= 63; bits++) {
        const int64_t least = (int64_t)1 << (bits - 1);
        const int64_t most = INT64_MAX - (least - 1 + least) / 2;
        ale_round_div(unknown(-most, most), unknown(least, least - 1 + least));
    }
}

/* Fewer than 2^30 billions, more of them, and less than none of them. */
static void nanos(void)
{
    const int64_t most = ((INT64_C(1) << 30) - 1) * 1000000000 + 999999999;
    const int64_t b = unknown(-(INT64_C(1) << 32), INT64_C(1) << 32);
    ale_mul_nano(unknown(-most, most), b);
    ale_mul_nano(unknown(most + 1, INT64_MAX), b);
    ale_mul_nano(unknown(INT64_MIN, -most - 1), b);
}

void main(void)
{
    shifts();
    divisions();
    ale_isqrt(unknown_unsigned(0, UINT64_MAX));
    ale_bit_length(unknown_unsigned(0, UINT64_MAX));
    nanos();
    ale_abs64(unknown(-INT64_MAX, INT64_MAX));
    const int64_t a = unknown(INT64_MIN, INT64_MAX);
    const int64_t b = unknown(INT64_MIN, INT64_MAX);
    ale_min64(a, b);
    ale_max64(a, b);
    ale_clamp64(a, unknown(INT64_MIN, 0), unknown(0, INT64_MAX));
}
