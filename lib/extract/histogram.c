#include "extract/histogram.h"

#include "base/fixed.h"

enum { BINS_PER_OCTAVE_SHIFT = 2 };

/* Nearly linear below 4. */
uint32_t ale_histogram_bin(uint64_t v)
{
    if (v >> 40) {
        return ALE_HISTOGRAM_BINS - 1;
    }
    const unsigned bits = ale_bit_length(v + 4);
    const uint32_t bin = ((bits - 3) << BINS_PER_OCTAVE_SHIFT) + (uint32_t)((v + 4) >> (bits - 3)) - 4;
    return bin < ALE_HISTOGRAM_BINS ? bin : ALE_HISTOGRAM_BINS - 1;
}

/* Lower end of a bin. */
static int64_t bin_value(uint32_t bin)
{
    return ((int64_t)(4u + (bin & 3u)) << (bin >> BINS_PER_OCTAVE_SHIFT)) - 4;
}

/* Linear within the bin. */
int64_t ale_histogram_quantile(const uint16_t bins[ALE_HISTOGRAM_BINS], int32_t samples, int32_t percent)
{
    int32_t below = 0;
    for (uint32_t b = 0; b < ALE_HISTOGRAM_BINS - 1; b++) {
        if (100 * (below + bins[b]) >= samples * percent && bins[b] > 0) {
            const int64_t width = bin_value(b + 1) - bin_value(b);
            return bin_value(b) +
                   width * ((int64_t)samples * percent - (int64_t)100 * below) / ((int64_t)100 * bins[b]);
        }
        below += bins[b];
    }
    return bin_value(ALE_HISTOGRAM_BINS - 1);
}
