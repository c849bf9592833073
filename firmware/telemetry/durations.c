#include "telemetry/durations.h"

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
    return (uint32_t)ale_min64(bucket, ALE_DURATIONS_BUCKETS - 1);
}

static int64_t upper_end(uint32_t bucket)
{
    if (bucket < 16) {
        return bucket;
    }
    const unsigned shift = bucket / 8 - 1;
    return ((int64_t)(bucket % 8 + 9) << shift) - 1;
}

void ale_durations_add(ale_durations_t *durations, int64_t time_ns)
{
    durations->count++;
    durations->last_ns = time_ns;
    durations->worst_ns = ale_max64(durations->worst_ns, time_ns);
    durations->bucket[bucket_of(time_ns)]++;
}

int64_t ale_durations_quantile(const ale_durations_t *durations, uint32_t permille)
{
    const uint64_t wanted = ((uint64_t)durations->count * permille + 999) / 1000;
    uint64_t seen = 0;
    for (uint32_t k = 0; k < ALE_DURATIONS_BUCKETS; k++) {
        seen += durations->bucket[k];
        if (seen >= wanted) {
            return ale_min64(upper_end(k), durations->worst_ns);
        }
    }
    return durations->worst_ns;
}

/* Buckets below 16 are single nanoseconds, so that octave 3 is buckets 8 to 15, like any other above. */
uint32_t ale_durations_octave(const ale_durations_t *durations, uint32_t octave)
{
    const uint32_t first = octave < 3 ? 1U << octave : 8 * (octave - 2);
    const uint32_t count = octave < 3 ? 1U << octave : 8;
    uint32_t sum = octave == 0 ? durations->bucket[0] : 0;
    for (uint32_t k = first; k < first + count && k < ALE_DURATIONS_BUCKETS; k++) {
        sum += durations->bucket[k];
    }
    return sum;
}
