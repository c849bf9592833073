#include "histogram.h"

#include "base/fixed.h"

/* Values below 16 have a bucket each; above, the octave and the three bits after its leading one count:
 * bucket = 8 * (octave - 3) + (v >> (octave - 3)), which is 16..23 in the first such octave. */
static uint32_t bucket_of(int64_t time_ns)
{
    if (time_ns < 16) {
        return time_ns < 0 ? 0 : (uint32_t)time_ns;
    }
    const unsigned shift = ale_bit_length((uint64_t)time_ns) - 4;
    const int64_t bucket = 8 * (int64_t)shift + (time_ns >> shift);
    return (uint32_t)ale_min64(bucket, ALE_HISTOGRAM_BUCKETS - 1);
}

static int64_t upper_end(uint32_t bucket)
{
    if (bucket < 16) {
        return bucket;
    }
    const unsigned shift = bucket / 8 - 1;
    return ((int64_t)(bucket % 8 + 9) << shift) - 1;
}

void ale_histogram_add(ale_histogram_t *histogram, int64_t time_ns)
{
    histogram->count++;
    histogram->last_ns = time_ns;
    histogram->worst_ns = ale_max64(histogram->worst_ns, time_ns);
    histogram->bucket[bucket_of(time_ns)]++;
}

int64_t ale_histogram_quantile(const ale_histogram_t *histogram, uint32_t permille)
{
    const uint64_t wanted = ((uint64_t)histogram->count * permille + 999) / 1000;
    uint64_t seen = 0;
    for (uint32_t k = 0; k < ALE_HISTOGRAM_BUCKETS; k++) {
        seen += histogram->bucket[k];
        if (seen >= wanted) {
            return ale_min64(upper_end(k), histogram->worst_ns);
        }
    }
    return histogram->worst_ns;
}
