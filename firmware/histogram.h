/* How long something took, over a whole run in constant memory: worst case exactly, quantiles to 12 %.
 *
 * Buckets are eighths of octaves, from 1 ns to hours. One thread; every call is constant time
 * but the quantile, which looks at each bucket once. */
#ifndef ALE_FIRMWARE_HISTOGRAM_H
#define ALE_FIRMWARE_HISTOGRAM_H

#include <stdint.h>

enum { ALE_HISTOGRAM_BUCKETS = 41 * 8 };

typedef struct {
    uint32_t count;
    int64_t last_ns;
    int64_t worst_ns;
    uint32_t bucket[ALE_HISTOGRAM_BUCKETS];
} ale_histogram_t; /* all zero: empty */

/* Negative times count as zero. */
void ale_histogram_add(ale_histogram_t *histogram, int64_t time_ns);

/* The time that `permille` of 1000 values do not exceed: the upper end of its bucket, at most the worst.
 * 0 when empty. */
int64_t ale_histogram_quantile(const ale_histogram_t *histogram, uint32_t permille);

#endif
