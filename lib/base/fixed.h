/* Integer arithmetic of the core: rounding, roots, and one portable wide multiply.
 *
 * All rounding in the project is symmetric (half away from zero) and happens here, so that a mirrored
 * scan gives the mirrored result and every machine gives the same bytes.
 *
 * Pure functions of constant time: thread-safe, no error is returned, nothing traps. What an argument must
 * keep to is said at the function; beyond it the result means nothing. Bounds: tests/lib/base/test_fixed.cpp,
 * against double and 128-bit arithmetic. */
#ifndef ALE_BASE_FIXED_H
#define ALE_BASE_FIXED_H

#include <assert.h>
#include <stdint.h>

/* cppcheck-suppress shiftNegativeLHS; it is what is asked here */
static_assert((-3 >> 1) == -2, "ale_round_shift stands on the arithmetic shift of gcc and clang");

/* v / 2^shift, rounded half away from zero. shift 0..62; |v| + 2^(shift-1) must fit int64. No branch: it is
 * the innermost step of most loops. */
/*@ requires shift <= 62;
  @ requires shift > 0 ==> -INT64_MAX + (1 << (shift - 1)) <= v <= INT64_MAX - (1 << (shift - 1));
  @ assigns \nothing; */
static inline int64_t ale_round_shift(int64_t v, unsigned shift)
{
    if (shift == 0) {
        return v;
    }
    const int64_t half = (int64_t)1 << (shift - 1);
    return (v + half - (v < 0)) >> shift;
}

/* num / den, rounded half away from zero. den > 0; |num| + den/2 must fit int64. */
/*@ requires den > 0 && -INT64_MAX + den / 2 <= num <= INT64_MAX - den / 2;
  @ assigns \nothing;
  @ ensures \result == (num >= 0 ? (num + den / 2) / den : -((-num + den / 2) / den)); */
static inline int64_t ale_round_div(int64_t num, int64_t den)
{
    return num >= 0 ? (num + den / 2) / den : -((-num + den / 2) / den);
}

/* |v|; v > INT64_MIN. */
/*@ requires v > INT64_MIN;
  @ assigns \nothing;
  @ ensures \result == (v < 0 ? -v : v); */
static inline int64_t ale_abs64(int64_t v)
{
    return v < 0 ? -v : v;
}

/*@ assigns \nothing;
  @ ensures \result == (a < b ? a : b); */
static inline int64_t ale_min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/*@ assigns \nothing;
  @ ensures \result == (a > b ? a : b); */
static inline int64_t ale_max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* v held between low and high; low <= high. */
/*@ requires low <= high;
  @ assigns \nothing;
  @ ensures low <= \result <= high; */
static inline int64_t ale_clamp64(int64_t v, int64_t low, int64_t high)
{
    return v < low ? low : (v > high ? high : v);
}

/* Number of the highest set bit plus one; 0 for 0. */
static inline unsigned ale_bit_length(uint64_t v)
{
    return v ? ((unsigned)__builtin_clzll(v) ^ 63u) + 1 : 0;
}

/* floor(sqrt(v)). Three divisions. */
/*@ assigns \nothing; */
uint32_t ale_isqrt(uint64_t v);

/* What v has beyond so many bits and a sign: 0 when -2^bits <= v < 2^bits. bits 0..62. Several of them,
 * or'ed, tell with one branch whether all products of what was asked for fit int64. */
static inline uint64_t ale_beyond(int64_t v, unsigned bits)
{
    return ((uint64_t)v + ((uint64_t)1 << bits)) >> (bits + 1);
}

/* a * b / 2^shift with a 128-bit product, rounded half away from zero and saturated to int64.
 * shift 0..126. Made of 32-bit limbs: __int128 does not exist on 32-bit targets. */
/*@ requires shift <= 126;
  @ assigns \nothing; */
int64_t ale_wide_mul_shift(int64_t a, int64_t b, unsigned shift);

/* The same; a product that 62 bits hold, as most do, is made at a quarter of the cost. */
/*@ requires shift <= 126;
  @ assigns \nothing;
  @ ensures -(\abs(a) * \abs(b) / (1 << shift)) - 1 <= \result <= \abs(a) * \abs(b) / (1 << shift) + 1; */
static inline int64_t ale_mul_shift(int64_t a, int64_t b, unsigned shift)
{
    const unsigned bits =
        ale_bit_length((uint64_t)(a < 0 ? ~a : a)) + ale_bit_length((uint64_t)(b < 0 ? ~b : b));
    return bits <= 61 && shift <= 62 ? ale_round_shift(a * b, shift) : ale_wide_mul_shift(a, b, shift);
}

/* a * b / 10^9 rounded, saturated to int64; |b| <= 2^32. From |a| = 2^30 10^9 on b / 10^9 is taken to
 * 2^-41 and 2^-31 of itself: what a variance needs. */
/*@ requires -4294967296 <= b <= 4294967296;
  @ assigns \nothing; */
int64_t ale_mul_nano(int64_t a, int64_t b);

/* a * b / c with a 128-bit product, rounded half away from zero, saturated to int64. c != 0.
 * Two long-division steps. */
/*@ requires c != 0;
  @ assigns \nothing; */
int64_t ale_wide_mul_div(int64_t a, int64_t b, int64_t c);

/* The same, with one plain division where 62 bits hold the product. */
/*@ requires c != 0;
  @ assigns \nothing; */
static inline int64_t ale_mul_div(int64_t a, int64_t b, int64_t c)
{
    const unsigned bits =
        ale_bit_length((uint64_t)(a < 0 ? ~a : a)) + ale_bit_length((uint64_t)(b < 0 ? ~b : b));
    return bits <= 61 && c > 0 ? ale_round_div(a * b, c) : ale_wide_mul_div(a, b, c);
}

#endif
