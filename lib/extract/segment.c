#include "extract/segment.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    NOISE_FACTOR = 7,  /* deviations of one beam's own error: 5 of the difference of two */
    SHARED_FACTOR = 5, /* the same of the constant part of the shared error */
    UNRULY_PERCENT = 45,
    SUSPECT_HALVES = 7 /* half deviations that a suspicious change exceeds: less than a spike or a jump has */
};

typedef struct {
    int64_t constant_um;
    int64_t noise_q20;     /* part of the range that the noise may make */
    int64_t incidence_q20; /* part of the range that one beam advances at 45 degrees of incidence */
} jump_limit_t;

static jump_limit_t jump_limit(const ale_extractor_t *e, const ale_scan_t *scan)
{
    const int64_t shared_um = ((int64_t)ale_isqrt((uint64_t)e->noise.shared_mm2_q36) * 1000) >> 18;
    const int64_t step_nrad = ale_bam_to_nrad((int32_t)ale_abs64(scan->step_bam));
    const jump_limit_t limit = {
        .constant_um = NOISE_FACTOR * e->noise.sigma_um + SHARED_FACTOR * shared_um,
        .noise_q20 = NOISE_FACTOR * e->noise.sigma_per_range_q20,
        .incidence_q20 = (step_nrad << 20) / 1000000000,
    };
    return limit;
}

/* Change of range a beam, from point i to the next; 0 beyond the ends. */
static inline int64_t slope_um(const ale_extractor_t *e, int32_t i)
{
    if (i < 0 || i + 1 >= e->count) {
        return 0;
    }
    const int32_t change_um = e->range_um[i + 1] - e->range_um[i];
    return (change_um < 0 ? -change_um : change_um) / (e->beam[i + 1] - e->beam[i]);
}

/* A change of range that noise and 45 degrees of incidence do not explain is a jump, unless both
 * neighbouring changes show that the surface is steeper than that; so is a wide gap. */
static bool is_jump(const ale_extractor_t *e, const jump_limit_t *limit, int32_t i)
{
    const int64_t change_um = ale_abs64((int64_t)e->range_um[i + 1] - e->range_um[i]);
    const int64_t gap = e->beam[i + 1] - e->beam[i];
    const int64_t range_um = ale_min64(e->range_um[i], e->range_um[i + 1]);
    const int64_t allowed_um =
        limit->constant_um + (range_um * (limit->noise_q20 + gap * limit->incidence_q20) >> 20);
    if (change_um <= allowed_um) {
        return gap > ALE_MAX_GAP_BEAMS;
    }
    const int64_t beyond_um = (change_um - allowed_um) * 2;
    return gap > ALE_MAX_GAP_BEAMS || beyond_um > 3 * gap * slope_um(e, i - 1) ||
           beyond_um > 3 * gap * slope_um(e, i + 1);
}

static void end_segment(ale_extractor_t *e, int32_t first, int32_t last)
{
    e->segment[e->segment_count].first = (uint16_t)first;
    e->segment[e->segment_count].last = (uint16_t)last;
    e->segment_count++;
}

/* Adds the suspects among first..last - 1. */
static void add_suspects(ale_extractor_t *e, int32_t first, int32_t last)
{
    const int64_t constant_q20 = SUSPECT_HALVES * (e->noise.sigma_um << 20) / 2;
    const int64_t per_sum_q20 = SUSPECT_HALVES * e->noise.sigma_per_range_q20 / 4;
    uint32_t suspects = e->suspect_count;
    int64_t here_um = e->range_um[first];
    for (int32_t i = first; i < last; i++) {
        const int64_t next_um = e->range_um[i + 1];
        const int64_t limit_q20 = constant_q20 + (here_um + next_um) * per_sum_q20;
        if (ale_abs64(next_um - here_um) << 20 > limit_q20) {
            e->suspect[suspects++] = (uint16_t)i;
        }
        here_um = next_um;
    }
    e->suspect_count = (uint16_t)suspects;
}

void ale_segment_suspect(ale_extractor_t *e)
{
    int32_t first = 0;
    e->suspect_count = 0;
    for (int32_t k = 0; k < e->gap_count && e->gap_after[k] + 1 < e->count; k++) {
        add_suspects(e, first, e->gap_after[k]);
        e->suspect[e->suspect_count++] = e->gap_after[k];
        first = e->gap_after[k] + 1;
    }
    add_suspects(e, first, e->count - 1);
    e->effort = e->suspect_count;
    e->unruly = e->suspect_count * 100 > e->count * UNRULY_PERCENT;
}

void ale_segment(ale_extractor_t *e, const ale_scan_t *scan)
{
    e->segment_count = 0;
    if (e->count == 0) {
        return;
    }
    const jump_limit_t limit = jump_limit(e, scan);
    int32_t first = 0;
    memset(e->jump_after, 0, e->count * sizeof *e->jump_after);
    for (int32_t k = 0; k < e->suspect_count; k++) {
        const int32_t i = e->suspect[k];
        if (is_jump(e, &limit, i)) {
            e->jump_after[i] = true;
            end_segment(e, first, i);
            first = i + 1;
        }
    }
    e->jump_after[e->count - 1] = true;
    end_segment(e, first, e->count - 1);
}

bool ale_segment_joins(const ale_extractor_t *e, int32_t i, int32_t j)
{
    for (int32_t k = i; k < j; k++) {
        if (e->jump_after[k]) {
            return false;
        }
    }
    return true;
}
