/* Any bins of any samples, in quantiles from the first to beyond the last.
 *
 * proves: lib/base/histogram.c
 * settles: ale_histogram_bin ale_histogram_quantile bin_value
 * options: -eva-slevel 130 */
#include "unknown.h"

#include "base/histogram.h"

/* Values by the octave of their bins. */
static void values(void)
{
    ale_histogram_bin(0);
    //@ loop unroll 64;
    for (unsigned bits = 2; bits <= 63; bits++) {
        const uint64_t least = ((uint64_t)1 << bits) - 4;
        ale_histogram_bin(unknown_unsigned(least, 2 * least + 3));
    }
    ale_histogram_bin(unknown_unsigned(UINT64_MAX - 3, UINT64_MAX));
}

void main(void)
{
    values();
    uint16_t bins[ALE_HISTOGRAM_BINS];
    Frama_C_make_unknown((char *)bins, sizeof bins);
    ale_histogram_quantile(bins, (int32_t)unknown(1, ALE_HISTOGRAM_BINS * UINT16_MAX),
                           (int32_t)unknown(1, 100));
}
