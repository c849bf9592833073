#include "extract/points.h"

#include "base/fixed.h"
#include "base/trig.h"

enum { PLACE_SHIFT = 36 };

/* Cosine or sine as what a range in micrometres is multiplied by: Q36 of points (1/16 mm) a micrometre. */
static int32_t per_um_q36(int32_t cos_q30)
{
    return (int32_t)ale_round_div((int64_t)cos_q30 * 128, 125);
}

/* Directions of as many multiples of half a beam as the scan is wide. */
static void cache_directions(ale_points_t *p, const ale_scan_t *scan)
{
    if (p->direction_step_bam != scan->step_bam) {
        p->directions = 0;
        p->direction_step_bam = scan->step_bam;
    }
    for (int32_t m = p->directions; m < scan->beams; m++) {
        const ale_direction_t d = ale_direction((uint32_t)((int64_t)m * scan->step_bam / 2));
        p->cos_q36[m] = per_um_q36(d.cos_q30);
        p->sin_q36[m] = per_um_q36(d.sin_q30);
    }
    p->directions = (int32_t)ale_max64(p->directions, scan->beams);
}

/* Beams of the whole turn, as ale_scan_turn_beams has it. The robot's own turn since the first beam opens the
 * seam of a straightened scan, or lays its beams over each other. */
static int32_t turn_beams(const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    const int32_t beams = ale_scan_turn_beams(scan);
    if (beams == 0 || !bearing_bam) {
        return beams;
    }
    const int32_t last = scan->beams - 1;
    const int64_t ahead_bam = ale_bam_diff(bearing_bam[0], bearing_bam[last]);
    const int64_t gap = ale_round_div(scan->step_bam < 0 ? -ahead_bam : ahead_bam, ale_abs64(scan->step_bam));
    return gap > ALE_MAX_GAP_BEAMS ? 0 : last + (int32_t)ale_max64(gap, 1);
}

void ale_points_note_gaps(ale_points_t *p)
{
    p->gap_count = 0;
    for (int32_t i = 0; i + 1 < p->count; i++) {
        if (p->beam[i + 1] - p->beam[i] > ALE_MAX_GAP_BEAMS) {
            p->gap_after[p->gap_count++] = (uint16_t)i;
        }
    }
}

void ale_points_list(ale_points_t *p, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    const uint32_t span_um = ALE_MAX_RANGE_UM - ALE_MIN_RANGE_UM;
    uint32_t n = 0;
    p->gap_count = 0;
    for (uint32_t k = 0; k < scan->beams; k++) {
        const int32_t range_um = scan->range_um[k];
        if (scan->flag[k] == ALE_BEAM_VALID && (uint32_t)range_um - ALE_MIN_RANGE_UM <= span_um) {
            p->beam[n] = (uint16_t)k;
            p->range_um[n] = range_um;
            p->inverse_q44[n] = (int32_t)(((int64_t)1 << 44) / range_um);
            n++;
        } else if (n > 0 && k - p->beam[n - 1] == ALE_MAX_GAP_BEAMS) {
            p->gap_after[p->gap_count++] = (uint16_t)(n - 1);
        }
    }
    p->count = (uint16_t)n;
    p->sparse = ale_scan_is_sparse(scan);
    p->step_nrad = ale_bam_to_nrad((int32_t)ale_abs64(scan->step_bam));
    p->turn_beams = turn_beams(scan, bearing_bam);
}

static inline int32_t coordinate_q4(int64_t range_um, int64_t per_um)
{
    return (int32_t)ale_round_shift(range_um * per_um, PLACE_SHIFT);
}

/* Midway between the first and the last point, as the mirror turns. */
static uint32_t middle_bam(const ale_points_t *p, const ale_scan_t *scan)
{
    if (p->count == 0) {
        return scan->first_bearing_bam;
    }
    if (p->turn_beams > 0 || scan->own_bearings) {
        const uint32_t first_bam = ale_scan_bearing(scan, ale_points_beam(p, 0));
        const uint32_t last_bam = ale_scan_bearing(scan, ale_points_beam(p, p->count - 1));
        return scan->step_bam < 0 ? first_bam - (first_bam - last_bam) / 2
                                  : first_bam + (last_bam - first_bam) / 2;
    }
    const int64_t half_beams = (int64_t)p->beam[0] + p->beam[p->count - 1];
    return scan->first_bearing_bam + (uint32_t)(half_beams * scan->step_bam / 2);
}

/* Each point in its own direction. */
static void place_each(ale_points_t *p, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    for (int32_t i = 0; i < p->count; i++) {
        const uint16_t beam = ale_points_beam(p, i);
        const uint32_t here_bam = bearing_bam ? bearing_bam[beam] : ale_scan_bearing(scan, beam);
        const ale_direction_t d = ale_direction(here_bam - p->frame_bam);
        p->x_q4[i] = coordinate_q4(p->range_um[i], per_um_q36(d.cos_q30));
        p->y_q4[i] = coordinate_q4(p->range_um[i], per_um_q36(d.sin_q30));
    }
}

void ale_points_place(ale_points_t *p, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    p->frame_bam = middle_bam(p, scan);
    if (p->count == 0) {
        return;
    }
    if (bearing_bam || scan->own_bearings || p->turn_beams > 0) {
        place_each(p, scan, bearing_bam);
        return;
    }
    cache_directions(p, scan);
    const int32_t middle = p->beam[0] + p->beam[p->count - 1];
    int32_t i = 0;
    for (; 2 * p->beam[i] < middle; i++) {
        const int32_t m = middle - 2 * p->beam[i];
        p->x_q4[i] = coordinate_q4(p->range_um[i], p->cos_q36[m]);
        p->y_q4[i] = -coordinate_q4(p->range_um[i], p->sin_q36[m]);
    }
    for (; i < p->count; i++) {
        const int32_t m = 2 * p->beam[i] - middle;
        p->x_q4[i] = coordinate_q4(p->range_um[i], p->cos_q36[m]);
        p->y_q4[i] = coordinate_q4(p->range_um[i], p->sin_q36[m]);
    }
}

void ale_points_place_smoothed(ale_points_t *p, const int32_t *smooth_q44)
{
    for (int32_t i = 0; i < p->count; i++) {
        const int64_t ratio_q30 = ((int64_t)p->inverse_q44[i] << 30) / ale_max64(smooth_q44[i], 1);
        p->x_q4[i] = (int32_t)ale_round_shift(p->x_q4[i] * ratio_q30, 30);
        p->y_q4[i] = (int32_t)ale_round_shift(p->y_q4[i] * ratio_q30, 30);
    }
}

int32_t ale_points_reading_direction(const ale_points_t *p, int32_t first, int32_t last)
{
    for (int32_t a = first, b = last; a < b; a++, b--) {
        if (p->range_um[a] != p->range_um[b]) {
            return p->range_um[a] < p->range_um[b] ? 1 : -1;
        }
    }
    return 1;
}
