#include "base/histogram.h"

enum { BINS_PER_OCTAVE_SHIFT = 2, BINS_PER_OCTAVE = 1 << BINS_PER_OCTAVE_SHIFT };

/* Lower end of a bin. */
static int64_t bin_value(uint32_t bin)
{
    return ((int64_t)(4u + (bin & 3u)) << (bin >> BINS_PER_OCTAVE_SHIFT)) - 4;
}

/* Linear within the bin. */
int64_t ale_histogram_quantile(const uint16_t bins[ALE_HISTOGRAM_BINS], int32_t samples, int32_t percent)
{
    const int64_t wanted = (int64_t)samples * percent; /* in hundredths of a sample */
    const int32_t whole = (int32_t)((wanted + 99) / 100);
    int32_t below = 0;
    uint32_t b = 0;
    for (; b < ALE_HISTOGRAM_BINS - BINS_PER_OCTAVE; b += BINS_PER_OCTAVE) {
        const int32_t octave = bins[b] + bins[b + 1] + bins[b + 2] + bins[b + 3];
        if (below + octave >= whole) {
            break;
        }
        below += octave;
    }
    for (; b < ALE_HISTOGRAM_BINS - 1 && below + bins[b] < whole; b++) {
        below += bins[b];
    }
    if (b == ALE_HISTOGRAM_BINS - 1) {
        return bin_value(b);
    }
    const int64_t width = bin_value(b + 1) - bin_value(b);
    const int64_t in_bin = ale_max64(bins[b], 1); /* the quantile lies in it: there are some */
    return bin_value(b) + width * (wanted - (int64_t)100 * below) / (100 * in_bin);
}
