#include "extract/outlier.h"

#include "base/fixed.h"

enum {
    STRAY_POINTS = 4, /* pieces of so few points are no surface */
    SPIKE_FACTOR = 4, /* deviations by which a spike stands out from both neighbours */
    SPIKE_REACH = 7   /* beams that a spike and two neighbours on each side may take */
};

static void move_point(ale_extractor_t *e, int32_t to, int32_t from)
{
    e->beam[to] = e->beam[from];
    e->range_um[to] = e->range_um[from];
    e->inverse_q44[to] = e->inverse_q44[from];
}

bool ale_outlier_remove_strays(ale_extractor_t *e)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < e->segment_count; k++) {
        const ale_run_t piece = e->segment[k];
        const int32_t points = piece.last + 1 - piece.first;
        if (points <= STRAY_POINTS) {
            continue;
        }
        for (int32_t i = piece.first; kept != piece.first && i <= piece.last; i++) {
            move_point(e, kept + i - piece.first, i);
        }
        kept += points;
    }
    const bool removed = kept < e->count;
    e->outliers = (uint16_t)(e->outliers + e->count - kept);
    e->count = (uint16_t)kept;
    return removed;
}

/* A point stands out when both neighbours agree with each other and it lies off both on the same side,
 * the local slope taken off. */
static bool is_spike(const ale_extractor_t *e, int32_t i, int64_t limit_um)
{
    const int64_t here = e->range_um[i];
    const int64_t slope = ((int64_t)e->range_um[i + 2] - e->range_um[i - 2]) / 4;
    const int64_t left = here - e->range_um[i - 1] - slope;
    const int64_t right = here - e->range_um[i + 1] + slope;
    return ((left > limit_um && right > limit_um) || (left < -limit_um && right < -limit_um)) &&
           ale_abs64(left - right) <= limit_um && e->beam[i + 2] - e->beam[i - 2] <= SPIKE_REACH;
}

/* The first spike from point i on, or the end of the points. */
static int32_t next_spike(const ale_extractor_t *e, int32_t i)
{
    const int64_t constant_um = SPIKE_FACTOR * e->noise.sigma_um;
    const int64_t per_range_q20 = SPIKE_FACTOR * e->noise.sigma_per_range_q20;
    for (i = i < 2 ? 2 : i; i + 2 < e->count; i++) {
        const int64_t here = e->range_um[i];
        const int64_t limit_um = constant_um + (here * per_range_q20 >> 20);
        const int64_t bend_um = ale_abs64(2 * here - e->range_um[i - 1] - e->range_um[i + 1]);
        if (bend_um > 2 * limit_um && is_spike(e, i, limit_um)) {
            return i;
        }
    }
    return e->count;
}

void ale_outlier_remove_spikes(ale_extractor_t *e)
{
    uint16_t spike[ALE_MAX_BEAMS];
    int32_t spikes = 0;
    for (int32_t i = next_spike(e, 0); i < e->count; i = next_spike(e, i + 1)) {
        spike[spikes++] = (uint16_t)i;
    }
    if (spikes == 0) {
        return;
    }
    int32_t kept = spike[0];
    for (int32_t i = spike[0], k = 0; i < e->count; i++) {
        if (k < spikes && spike[k] == i) {
            k++;
        } else {
            move_point(e, kept++, i);
        }
    }
    e->outliers = (uint16_t)(e->outliers + spikes);
    e->count = (uint16_t)kept;
}
