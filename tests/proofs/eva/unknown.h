/* What a harness feeds to the code under proof: values of which nothing is known but their range. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_H
#define ALE_PROOFS_EVA_UNKNOWN_H

#include <stddef.h>
#include <stdint.h>

#include "__fc_builtin.h"

static inline int64_t unknown(int64_t least, int64_t most)
{
    return Frama_C_long_interval(least, most);
}

static inline uint64_t unknown_unsigned(uint64_t least, uint64_t most)
{
    return Frama_C_unsigned_long_interval(least, most);
}

/* Every number of so many bits, 0 to 63, of one sign: the cases that ale_bit_length tells apart. */
static inline int64_t unknown_of_bits(unsigned bits, int negative)
{
    const int64_t least = bits == 0 ? 0 : (int64_t)1 << (bits - 1);
    const int64_t most = bits == 0 ? 0 : least - 1 + least;
    return negative ? -1 - unknown(least, most) : unknown(least, most);
}

/* What gcc computes for __builtin_clzll, of which Eva knows the range alone. */
static inline int model_clzll(unsigned long long v)
{
    int zeros = 63;
    //@ loop unroll 6;
    for (int step = 32; step > 0; step /= 2) {
        if (v >> step != 0) {
            zeros -= step;
            v >>= step;
        }
    }
    return zeros;
}
#define __builtin_clzll model_clzll

/* GNU's, which Frama-C's C library does not have. */
void *memmem(const void *in, size_t in_bytes, const void *of, size_t of_bytes);

#endif
