#include "extract/segment.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    NOISE_FACTOR = 7,  /* deviations of one beam's own error: 5 of the difference of two */
    SHARED_FACTOR = 5, /* the same of the constant part of the shared error */
    MAX_GAP_BEAMS = 8  /* beams without a value that a surface may have */
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
static int64_t slope_um(const ale_extractor_t *e, int32_t i)
{
    if (i < 0 || i + 1 >= e->count) {
        return 0;
    }
    return ale_abs64((int64_t)e->range_um[i + 1] - e->range_um[i]) / (e->beam[i + 1] - e->beam[i]);
}

/* A change of range that noise and 45 degrees of incidence do not explain is a jump, unless both
 * neighbouring changes show that the surface is steeper than that. */
static bool is_jump(const ale_extractor_t *e, const jump_limit_t *limit, int32_t i, int64_t change_um)
{
    const int64_t gap = e->beam[i + 1] - e->beam[i];
    const int64_t range_um = ale_min64(e->range_um[i], e->range_um[i + 1]);
    const int64_t allowed_um =
        limit->constant_um + (range_um * (limit->noise_q20 + gap * limit->incidence_q20) >> 20);
    const int64_t neighbours_um = ale_min64(slope_um(e, i - 1), slope_um(e, i + 1));
    return change_um > allowed_um && (change_um - allowed_um) * 2 > 3 * gap * neighbours_um;
}

static void end_segment(ale_extractor_t *e, int32_t first, int32_t last)
{
    e->segment[e->segment_count].first = (uint16_t)first;
    e->segment[e->segment_count].last = (uint16_t)last;
    e->segment_count++;
}

void ale_segment(ale_extractor_t *e, const ale_scan_t *scan)
{
    const jump_limit_t limit = jump_limit(e, scan);
    int32_t first = 0;
    e->segment_count = 0;
    for (int32_t i = 0; i + 1 < e->count; i++) {
        const int64_t change_um = ale_abs64((int64_t)e->range_um[i + 1] - e->range_um[i]);
        const bool far = e->beam[i + 1] - e->beam[i] > MAX_GAP_BEAMS;
        const int64_t noise_um = limit.constant_um + (e->range_um[i] * limit.noise_q20 >> 20);
        e->jump_after[i] = far || (change_um > noise_um / 2 && is_jump(e, &limit, i, change_um));
        if (e->jump_after[i]) {
            end_segment(e, first, i);
            first = i + 1;
        }
    }
    if (e->count > 0) {
        e->jump_after[e->count - 1] = true;
        end_segment(e, first, e->count - 1);
    }
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
