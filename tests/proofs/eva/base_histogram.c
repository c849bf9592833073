/* Any bins of any samples, in quantiles from the first to beyond the last.
 *
 * proves: lib/base/histogram.c
 * options: -eva-slevel 130 */
#include "unknown.h"

#include "base/histogram.h"

void main(void)
{
    uint16_t bins[ALE_HISTOGRAM_BINS];
    Frama_C_make_unknown((char *)bins, sizeof bins);
    ale_histogram_bin(unknown_unsigned(0, UINT64_MAX));
    ale_histogram_quantile(bins, (int32_t)unknown(1, ALE_HISTOGRAM_BINS * UINT16_MAX),
                           (int32_t)unknown(1, 100));
}
