/* Quantiles of many values at once, by counting them in logarithmic bins: four to the octave, so a quantile
 * is within 13 % of the exact one before the interpolation in the bin, within 3 % after it. */
#ifndef ALE_BASE_HISTOGRAM_H
#define ALE_BASE_HISTOGRAM_H

#include <stdint.h>

#include "base/fixed.h"

#define ALE_HISTOGRAM_BINS 112

/* Bin of a value, nearly linear below 4; values from 7 * 2^27 on share the last bin. Constant time. */
/*@ assigns \nothing;
  @ ensures \result < ALE_HISTOGRAM_BINS; */
static inline uint32_t ale_histogram_bin(uint64_t v)
{
    const uint64_t most = ((uint64_t)1 << 30) - 5;
    const uint64_t from_four = (v < most ? v : most) + 4;
    const unsigned octave = ale_bit_length(from_four) - 3;
    return (octave << 2) + (uint32_t)(from_four >> octave) - 4;
}

/* The value below which percent, > 0, of the samples lie. samples: the sum of bins, > 0. O(bins). */
/*@ requires 0 < samples <= ALE_HISTOGRAM_BINS * UINT16_MAX && 0 < percent <= 100;
  @ assigns \nothing; */
int64_t ale_histogram_quantile(const uint16_t bins[ALE_HISTOGRAM_BINS], int32_t samples, int32_t percent);

#endif
