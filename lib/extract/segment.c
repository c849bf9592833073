#include "extract/segment.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    SHARED_FACTOR = 5,
    NOISE_FACTOR = 7, /* of one beam's deviation: 5 of the difference of two */
    MAX_GAP_BEAMS = 8 /* beams without a value that a surface may have */
};

typedef struct {
    int64_t constant_um;
    int64_t per_range_q20; /* noise and one beam's advance at 45 degrees of incidence */
    int64_t step_q20;
} jump_limit_t;

static jump_limit_t jump_limit(const ale_extractor_t *e, const ale_scan_t *scan)
{
    const jump_limit_t limit = {
        .constant_um = SHARED_FACTOR *
                           ale_round_shift((int64_t)ale_isqrt((uint64_t)e->noise.shared_mm2_q36) * 1000, 18) +
                       NOISE_FACTOR * e->noise.sigma_um,
        .per_range_q20 = NOISE_FACTOR * e->noise.sigma_per_range_q20,
        .step_q20 =
            ale_round_shift(ale_bam_to_nrad((int32_t)ale_abs64(scan->step_bam)) * 1074, 10 + 0) / 1000000,
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

void ale_segment(ale_extractor_t *e, const ale_scan_t *scan)
{
    const jump_limit_t limit = jump_limit(e, scan);
    int64_t before_um = 0;
    int64_t here_um = slope_um(e, 0);
    for (int32_t i = 0; i + 1 < e->count; i++) {
        const int64_t after_um = slope_um(e, i + 1);
        const int64_t gap = e->beam[i + 1] - e->beam[i];
        const int64_t range_um = ale_min64(e->range_um[i], e->range_um[i + 1]);
        const int64_t incidence_um =
            (range_um * limit.step_q20 >> 20) + ale_min64(before_um, after_um) * 3 / 2;
        const int64_t allowed_um =
            limit.constant_um + (range_um * limit.per_range_q20 >> 20) + gap * incidence_um;
        e->jump_after[i] = gap > MAX_GAP_BEAMS || here_um * gap > allowed_um;
        before_um = here_um;
        here_um = after_um;
    }
    if (e->count > 0) {
        e->jump_after[e->count - 1] = true;
    }
}
