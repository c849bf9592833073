#include "extract/outlier.h"

#include "base/fixed.h"

enum {
    STRAY_BEAMS = 4,
    SPIKE_REACH = 7,
    SPIKE_FACTOR_Q8 = 4 * 256 /* deviations by which a point must stand out from both neighbours */
};

static void move_point(ale_extractor_t *e, int32_t to, int32_t from)
{
    e->beam[to] = e->beam[from];
    e->range_um[to] = e->range_um[from];
    e->inverse_q44[to] = e->inverse_q44[from];
}

void ale_outlier_remove(ale_extractor_t *e)
{
    int32_t kept = 0;
    int32_t first = 0;
    for (int32_t i = 0; i < e->count; i++) {
        if (!e->jump_after[i]) {
            continue;
        }
        for (int32_t k = first; i - first >= STRAY_BEAMS && k <= i; k++) {
            move_point(e, kept++, k);
        }
        first = i + 1;
    }
    e->outliers = (uint16_t)(e->outliers + e->count - kept);
    e->count = (uint16_t)kept;
}

/* A point stands out when both neighbours agree with each other and it lies off both on the same side,
 * the local slope taken off. */
static bool is_spike(const ale_extractor_t *e, int32_t i)
{
    const int64_t here = e->range_um[i];
    const int64_t slope = ((int64_t)e->range_um[i + 2] - e->range_um[i - 2]) / 4;
    const int64_t left = here - e->range_um[i - 1] - slope;
    const int64_t right = here - e->range_um[i + 1] + slope;
    const int64_t limit =
        (SPIKE_FACTOR_Q8 * (e->noise.sigma_um + (here * e->noise.sigma_per_range_q20 >> 20))) >> 8;
    return ((left > limit && right > limit) || (left < -limit && right < -limit)) &&
           ale_abs64(left - right) <= limit && e->beam[i + 2] - e->beam[i - 2] <= SPIKE_REACH;
}

void ale_outlier_remove_spikes(ale_extractor_t *e)
{
    int32_t kept = 0;
    bool spike[ALE_MAX_BEAMS];
    for (int32_t i = 0; i < e->count; i++) {
        spike[i] = i >= 2 && i + 2 < e->count && is_spike(e, i);
    }
    for (int32_t i = 0; i < e->count; i++) {
        if (!spike[i]) {
            move_point(e, kept++, i);
        }
    }
    e->outliers = (uint16_t)(e->outliers + e->count - kept);
    e->count = (uint16_t)kept;
}
