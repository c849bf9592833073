#include "extract/points.h"

#include "base/fixed.h"
#include "base/trig.h"

static const int64_t per_mille_q34 = 17179869; /* 2^34 / 1000 */

/* Directions of all multiples of half a beam, kept as long as the scanner stays the same. */
static void cache_directions(ale_extractor_t *e, const ale_scan_t *scan)
{
    if (e->direction_step_bam == scan->step_bam && e->direction_known) {
        return;
    }
    for (int32_t m = 0; m <= 2 * ALE_MAX_BEAMS; m++) {
        const uint32_t angle = (uint32_t)((int64_t)m * scan->step_bam / 2);
        e->cos_q30[m] = ale_cos_q30(angle);
        e->sin_q30[m] = ale_sin_q30(angle);
    }
    e->direction_step_bam = scan->step_bam;
    e->direction_known = true;
}

void ale_points_list(ale_extractor_t *e, const ale_scan_t *scan)
{
    int32_t n = 0;
    for (int32_t k = 0; k < scan->beams; k++) {
        const int32_t range_um = scan->range_um[k];
        if (scan->flag[k] == ALE_BEAM_VALID && range_um >= ALE_MIN_RANGE_UM && range_um <= ALE_MAX_RANGE_UM) {
            e->beam[n] = (uint16_t)k;
            e->range_um[n] = range_um;
            e->inverse_q44[n] = (int32_t)(((int64_t)1 << 44) / range_um);
            n++;
        }
    }
    e->count = (uint16_t)n;
    e->outliers = 0;
}

static void place_point(ale_extractor_t *e, int32_t i, int64_t c_q30, int64_t s_q30)
{
    const int64_t range_mm_q12 = (e->range_um[i] * per_mille_q34) >> 22;
    e->x_q4[i] = (int32_t)ale_round_shift(range_mm_q12 * c_q30, 38);
    e->y_q4[i] = (int32_t)ale_round_shift(range_mm_q12 * s_q30, 38);
}

uint32_t ale_points_frame_bam(const ale_extractor_t *e, const ale_scan_t *scan)
{
    if (e->count == 0) {
        return scan->first_bearing_bam;
    }
    const int64_t half_beams = (int64_t)e->beam[0] + e->beam[e->count - 1];
    return scan->first_bearing_bam + (uint32_t)(half_beams * scan->step_bam / 2);
}

void ale_points_place(ale_extractor_t *e, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    if (e->count == 0) {
        return;
    }
    if (bearing_bam) {
        const uint32_t frame = ale_points_frame_bam(e, scan);
        for (int32_t i = 0; i < e->count; i++) {
            const uint32_t bearing = bearing_bam[e->beam[i]] - frame;
            place_point(e, i, ale_cos_q30(bearing), ale_sin_q30(bearing));
        }
        return;
    }
    cache_directions(e, scan);
    const int32_t middle = e->beam[0] + e->beam[e->count - 1];
    for (int32_t i = 0; i < e->count; i++) {
        const int32_t m = 2 * e->beam[i] - middle;
        const int32_t k = m < 0 ? -m : m;
        place_point(e, i, e->cos_q30[k], m < 0 ? -e->sin_q30[k] : e->sin_q30[k]);
    }
}

void ale_points_place_smoothed(ale_extractor_t *e)
{
    for (int32_t i = 0; i < e->count; i++) {
        const int64_t ratio_q30 = ((int64_t)e->inverse_q44[i] << 30) / ale_max64(e->smooth_q44[i], 1);
        e->x_q4[i] = (int32_t)ale_round_shift(e->x_q4[i] * ratio_q30, 30);
        e->y_q4[i] = (int32_t)ale_round_shift(e->y_q4[i] * ratio_q30, 30);
    }
}
