#include "extract/histogram.h"

enum { BINS_PER_OCTAVE_SHIFT = 2 };

/* Lower end of a bin. */
static int64_t bin_value(uint32_t bin)
{
    return ((int64_t)(4u + (bin & 3u)) << (bin >> BINS_PER_OCTAVE_SHIFT)) - 4;
}

/* Linear within the bin. */
int64_t ale_histogram_quantile(const uint16_t bins[ALE_HISTOGRAM_BINS], int32_t samples, int32_t percent)
{
    const int64_t wanted = (int64_t)samples * percent;
    int64_t below = 0; /* in hundredths of a sample */
    for (uint32_t b = 0; b < ALE_HISTOGRAM_BINS - 1; b++) {
        const int64_t in_bin = (int64_t)100 * bins[b];
        if (below + in_bin >= wanted && in_bin > 0) {
            const int64_t width = bin_value(b + 1) - bin_value(b);
            return bin_value(b) + width * (wanted - below) / in_bin;
        }
        below += in_bin;
    }
    return bin_value(ALE_HISTOGRAM_BINS - 1);
}
