/* How long something took, over a whole run in constant memory: worst case exactly, quantiles to 12 %.
 *
 * Buckets are eighths of octaves, from 1 ns to hours. One thread; every call is constant time
 * but the quantile, which looks at each bucket once. */
#ifndef ALE_FIRMWARE_TELEMETRY_DURATIONS_H
#define ALE_FIRMWARE_TELEMETRY_DURATIONS_H

#include <stdint.h>

enum { ALE_DURATIONS_BUCKETS = 41 * 8 };

typedef struct {
    uint32_t count;
    int64_t last_ns;
    int64_t worst_ns;
    uint32_t bucket[ALE_DURATIONS_BUCKETS];
} ale_durations_t; /* all zero: empty */

/* Negative times count as zero. */
void ale_durations_add(ale_durations_t *durations, int64_t time_ns);

/* The time that `permille` of 1000 values do not exceed: the upper end of its bucket, at most the worst.
 * 0 when empty. */
int64_t ale_durations_quantile(const ale_durations_t *durations, uint32_t permille);

/* How many took from 2^octave up to twice as many nanoseconds; octave 0 to 42. The first counts zeros too,
 * the last all that is longer. */
uint32_t ale_durations_octave(const ale_durations_t *durations, uint32_t octave);

#endif
