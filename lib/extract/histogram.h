/* Quantiles of many values at once, by counting them in logarithmic bins: four to the octave, so a quantile
 * is within 13 % of the exact one before the interpolation in the bin, within 3 % after it. */
#ifndef ALE_EXTRACT_HISTOGRAM_H
#define ALE_EXTRACT_HISTOGRAM_H

#include <stdint.h>

#define ALE_HISTOGRAM_BINS 112

/* Bin of a value; values from 2^28 on share the last bin. Constant time. */
uint32_t ale_histogram_bin(uint64_t v);

/* The value below which percent of the samples lie. samples: the sum of bins, > 0. O(bins). */
int64_t ale_histogram_quantile(const uint16_t bins[ALE_HISTOGRAM_BINS], int32_t samples, int32_t percent);

#endif
