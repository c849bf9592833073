/* Quotients of 64-bit numbers in fixed point without a wide division. */
#ifndef ALE_MOTION_RATIO_H
#define ALE_MOTION_RATIO_H

#include <stdint.h>

#include "base/fixed.h"

/* num / den in Q30, to 30 significant bits of den; den > 0; |num / den| < 2^32. */
static inline int64_t ale_ratio_q30(int64_t num, int64_t den)
{
    const unsigned bits = ale_bit_length((uint64_t)ale_max64(ale_abs64(num), den));
    const unsigned drop = bits > 32 ? bits - 32 : 0;
    const int64_t d = ale_max64(den >> drop, 1);
    return ale_round_div(ale_round_shift(num, drop) * ((int64_t)1 << 30), d);
}

#endif
