#include "base/fixed.h"

#include <stdbool.h>

typedef struct {
    uint64_t high;
    uint64_t low;
} wide_t;

static uint64_t magnitude(int64_t v)
{
    return v < 0 ? (uint64_t)0 - (uint64_t)v : (uint64_t)v;
}

static int64_t signed_saturated(uint64_t magnitude_of, bool negative)
{
    if (magnitude_of > (uint64_t)INT64_MAX) {
        return negative ? INT64_MIN : INT64_MAX;
    }
    return negative ? -(int64_t)magnitude_of : (int64_t)magnitude_of;
}

static wide_t wide_multiply(uint64_t a, uint64_t b)
{
    const uint64_t a_low = a & UINT32_MAX;
    const uint64_t a_high = a >> 32;
    const uint64_t b_low = b & UINT32_MAX;
    const uint64_t b_high = b >> 32;
    const uint64_t low = a_low * b_low;
    const uint64_t mid = a_high * b_low + (low >> 32);
    const uint64_t mid2 = a_low * b_high + (mid & UINT32_MAX);
    const wide_t product = {a_high * b_high + (mid >> 32) + (mid2 >> 32), (mid2 << 32) | (low & UINT32_MAX)};
    return product;
}

static wide_t wide_add(wide_t a, uint64_t high, uint64_t low)
{
    const uint64_t sum_low = a.low + low;
    const wide_t sum = {a.high + high + (sum_low < low ? 1u : 0u), sum_low};
    return sum;
}

/* Three steps of Newton from the straight line 0.354 + 0.667 v, which is within 4.2 % of the root of a v
 * between 1/4 and 1: the errors are 9e-4, 4e-7 and 8e-14, less than half a unit of the result. */
uint32_t ale_isqrt(uint64_t v)
{
    if (v == 0) {
        return 0;
    }
    const unsigned shift = (64 - ale_bit_length(v)) & ~1u;
    const uint64_t scaled = v << shift;
    uint64_t root = 1520826057 + (scaled >> 33) * 4 / 3;
    for (int step = 0; step < 3; step++) {
        root = (root + scaled / root) / 2;
    }
    root = root > UINT32_MAX ? UINT32_MAX : root;
    root -= root * root > scaled ? 1 : 0;
    return (uint32_t)(root >> (shift / 2));
}

/* Products of 82 bits are made of two halves, each in 64 bits: a b = (a b_high) 2^20 + a b_low. */
enum { HALF_BITS = 20, MIDDLE_FACTOR_BITS = 42, MIDDLE_BITS = 82 };

static bool is_middle(uint64_t a, uint64_t b)
{
    const unsigned bits = ale_bit_length(a);
    return bits <= MIDDLE_FACTOR_BITS && bits + ale_bit_length(b) <= MIDDLE_BITS;
}

static uint64_t middle_mul_shift(uint64_t a, uint64_t b, unsigned shift)
{
    const uint64_t low = a * (b & (((uint64_t)1 << HALF_BITS) - 1)) + ((uint64_t)1 << (shift - 1));
    return (a * (b >> HALF_BITS) + (low >> HALF_BITS)) >> (shift - HALF_BITS);
}

int64_t ale_wide_mul_shift(int64_t a, int64_t b, unsigned shift)
{
    const bool negative = (a < 0) != (b < 0);
    const uint64_t size_a = magnitude(a);
    const uint64_t size_b = magnitude(b);
    if (shift > HALF_BITS && shift <= 62 && is_middle(size_a, size_b)) {
        return signed_saturated(middle_mul_shift(size_a, size_b, shift), negative);
    }
    wide_t p = wide_multiply(size_a, size_b);
    if (shift == 0) {
        return signed_saturated(p.high != 0 ? UINT64_MAX : p.low, negative);
    }
    const unsigned half_bit = shift - 1;
    p = half_bit < 64 ? wide_add(p, 0, (uint64_t)1 << half_bit)
                      : wide_add(p, (uint64_t)1 << (half_bit - 64), 0);
    if (shift >= 64) {
        return signed_saturated(p.high >> (shift - 64), negative);
    }
    if (p.high >> shift) {
        return signed_saturated(UINT64_MAX, negative);
    }
    return signed_saturated((p.high << (64 - shift)) | (p.low >> shift), negative);
}

int64_t ale_mul_nano(int64_t a, int64_t b)
{
    const int64_t billion = 1000000000;
    const int64_t whole = a / billion;
    if (ale_abs64(whole) < (int64_t)1 << 30) {
        return whole * b + ale_round_div(a % billion * b, billion);
    }
    return ale_mul_shift(a, ale_round_div(b * 1099511628, 1000000), 40); /* 2^40 / 10^9 */
}

/* Next 32 bits of a quotient: (high * 2^32 + low) / divisor for high < divisor, divisor normalised (highest
 * bit set); *high becomes the remainder. Knuth, volume 2, 4.3.1, algorithm D: at most two corrections. */
static uint64_t quotient_digit(uint64_t *high, uint64_t low, uint64_t divisor)
{
    const uint64_t top = (divisor >> 32) | 0x80000000u; /* the bit is set: nothing here divides by zero */
    const uint64_t bottom = divisor & UINT32_MAX;
    uint64_t digit = *high / top;
    uint64_t rest = *high - digit * top;
    for (int correction = 0; correction < 2; correction++) {
        if (rest >> 32 == 0 && (digit >> 32 != 0 || digit * bottom > ((rest << 32) | low))) {
            digit--;
            rest += top;
        }
    }
    *high = ((*high << 32) | low) - digit * divisor;
    return digit;
}

int64_t ale_wide_mul_div(int64_t a, int64_t b, int64_t c)
{
    const uint64_t divisor = magnitude(c);
    const bool negative = ((a < 0) != (b < 0)) != (c < 0);
    const wide_t p = wide_add(wide_multiply(magnitude(a), magnitude(b)), 0, divisor / 2);
    if (p.high >= divisor) {
        return signed_saturated(UINT64_MAX, negative);
    }
    const unsigned shift = (64 - ale_bit_length(divisor)) & 63u;
    const uint64_t low = p.low << shift;
    uint64_t high = shift > 0 ? (p.high << shift) | (p.low >> (64 - shift)) : p.high;
    const uint64_t upper = quotient_digit(&high, low >> 32, divisor << shift);
    const uint64_t lower = quotient_digit(&high, low & UINT32_MAX, divisor << shift);
    return signed_saturated((upper << 32) | lower, negative);
}
