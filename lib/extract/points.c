#include "extract/points.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    PLACE_SHIFT = 36,
    FARTHEST_Q44 = ((int64_t)1 << 44) / ALE_MAX_RANGE_UM,
    BLOCK = 32,                          /* beams looked at together, */
    MOST_RANGE_UM = 1 << 26,             /* where none is farther */
    AHEAD = (ALE_MAX_BEAMS + 1) / 2 * 2, /* place of straight ahead among the half steps */
    DENSE = 4 /* times more points than other beams: a scan that is not sparse, for few lose a neighbour */
};

static const uint32_t SIGN = 0x80000000u;

/* Cosine or sine as what a range in micrometres is multiplied by: Q36 of points (1/16 mm) a micrometre, its
 * highest bit the sign. */
static uint32_t per_um_q36(int32_t cos_q30)
{
    const int64_t signed_q36 = ale_round_div((int64_t)cos_q30 * 128, 125);
    return (uint32_t)ale_abs64(signed_q36) | (signed_q36 < 0 ? SIGN : 0);
}

/* Mirrored to the other side of straight ahead. */
static void set_direction(ale_points_t *p, uint32_t half_steps, ale_direction_t d)
{
    ale_beam_directions_t *of = &p->direction[half_steps % 2];
    const uint32_t before = (AHEAD - half_steps) / 2;
    const uint32_t behind = (AHEAD + half_steps) / 2;
    const uint32_t cos_q36 = per_um_q36(d.cos_q30);
    const uint32_t sin_q36 = per_um_q36(d.sin_q30);
    of->cos_q36[before] = cos_q36;
    of->sin_q36[before] = sin_q36 ^ SIGN;
    of->cos_q36[behind] = cos_q36;
    of->sin_q36[behind] = sin_q36;
}

/* Directions of as many multiples of half a beam as the scan is wide. */
static void cache_directions(ale_points_t *p, const ale_scan_t *scan)
{
    if (p->direction_step_bam != scan->step_bam) {
        p->directions = 0;
        p->direction_step_bam = scan->step_bam;
    }
    for (int32_t m = p->directions; m < scan->beams; m++) {
        set_direction(p, (uint32_t)m, ale_direction((uint32_t)((int64_t)m * scan->step_bam / 2)));
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

static inline bool is_point(const ale_scan_t *scan, int32_t k)
{
    const uint32_t span_um = ALE_MAX_RANGE_UM - ALE_MIN_RANGE_UM;
    return scan->flag[k] == ALE_BEAM_VALID && (uint32_t)scan->range_um[k] - ALE_MIN_RANGE_UM <= span_um;
}

/* Whether all beams of the block from k on are points, of the ranges of most: no branch, for the compiler
 * takes several at once. */
static bool are_points(const ale_scan_t *scan, int32_t k)
{
    uint8_t flags = 0;
    uint32_t above_least = 0;
    for (int32_t j = k; j < k + BLOCK; j++) {
        above_least |= (uint32_t)scan->range_um[j] - ALE_MIN_RANGE_UM;
    }
    for (int32_t j = k; j < k + BLOCK; j++) {
        flags = (uint8_t)(flags | scan->flag[j]);
    }
    return flags == ALE_BEAM_VALID && above_least < MOST_RANGE_UM;
}

static inline int32_t inverse_q44(int32_t range_um)
{
    return (int32_t)(((int64_t)1 << 44) / range_um);
}

/* Lists those of the beams first..end - 1 that are points. */
static void list_points(ale_points_t *p, const ale_scan_t *scan, int32_t first, int32_t end)
{
    int32_t n = p->count;
    for (int32_t k = first; k < end; k++) {
        if (is_point(scan, k)) {
            p->beam[n] = (uint16_t)k;
            p->range_um[n] = scan->range_um[k];
            p->inverse_q44[n] = inverse_q44(scan->range_um[k]);
            n++;
        } else if (n > 0 && k - p->beam[n - 1] == ALE_MAX_GAP_BEAMS) {
            p->gap_after[p->gap_count++] = (uint16_t)(n - 1);
        }
    }
    p->count = (uint16_t)n;
}

static void list_block(ale_points_t *p, const ale_scan_t *scan, int32_t first)
{
    memcpy(&p->range_um[p->count], &scan->range_um[first], BLOCK * sizeof *p->range_um);
    for (int32_t j = 0; j < BLOCK; j++) {
        p->beam[p->count + j] = (uint16_t)(first + j);
    }
    for (int32_t j = 0; j < BLOCK; j++) {
        p->inverse_q44[p->count + j] = inverse_q44(scan->range_um[first + j]);
    }
    p->count = (uint16_t)(p->count + BLOCK);
}

void ale_points_list(ale_points_t *p, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    p->count = 0;
    p->gap_count = 0;
    int32_t k = 0;
    for (; k + BLOCK <= scan->beams; k += BLOCK) {
        if (are_points(scan, k)) {
            list_block(p, scan, k);
        } else {
            list_points(p, scan, k, k + BLOCK);
        }
    }
    list_points(p, scan, k, scan->beams);
    p->sparse = p->count - 1 < DENSE * (scan->beams - p->count) && ale_scan_is_sparse(scan);
    p->step_nrad = ale_bam_to_nrad((int32_t)ale_abs64(scan->step_bam));
    p->turn_beams = turn_beams(scan, bearing_bam);
}

/* Rounded half away from zero. By magnitudes and without a branch: so the compiler takes several at once. */
static inline int32_t coordinate_q4(int32_t range_um, uint32_t per_um)
{
    const uint64_t half = (uint64_t)1 << (PLACE_SHIFT - 1);
    const uint32_t sign = 0u - (per_um >> 31);
    const uint32_t size = per_um & ~SIGN;
    const uint32_t q4 = (uint32_t)(((uint32_t)range_um * (uint64_t)size + half) >> PLACE_SHIFT);
    return (int32_t)((q4 ^ sign) - sign);
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

static inline void place_stretch(ale_points_t *p, int32_t first, int32_t points,
                                 const uint32_t *restrict cos_q36, const uint32_t *restrict sin_q36)
{
    for (int32_t j = 0; j < points; j++) {
        p->x_q4[first + j] = coordinate_q4(p->range_um[first + j], cos_q36[j]);
        p->y_q4[first + j] = coordinate_q4(p->range_um[first + j], sin_q36[j]);
    }
}

/* All points in the cached directions, those of a block whose beams follow one another together. */
static void place_evenly(ale_points_t *p)
{
    const int32_t width = p->beam[p->count - 1] - p->beam[0];
    const ale_beam_directions_t *of = &p->direction[width % 2];
    const int32_t ahead = (AHEAD - width) / 2 - p->beam[0]; /* place of a beam's direction less the beam */
    int32_t i = 0;
    while (i < p->count) {
        const int32_t k = ahead + p->beam[i];
        if (i + BLOCK <= p->count && p->beam[i + BLOCK - 1] - p->beam[i] == BLOCK - 1) {
            place_stretch(p, i, BLOCK, &of->cos_q36[k], &of->sin_q36[k]);
            i += BLOCK;
        } else {
            place_stretch(p, i, 1, &of->cos_q36[k], &of->sin_q36[k]);
            i++;
        }
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
    place_evenly(p);
}

/* No farther than a range may be: what the sums of the points fit int64 for. */
static int32_t moved_q4(int64_t v_q4, int64_t ratio_q30)
{
    return (int32_t)ale_clamp64(ale_round_shift(v_q4 * ratio_q30, 30), -ALE_POINT_MAX_Q4, ALE_POINT_MAX_Q4);
}

void ale_points_place_smoothed(ale_points_t *p, const int32_t *smooth_q44)
{
    for (int32_t i = 0; i < p->count; i++) {
        const int64_t ratio_q30 = ((int64_t)p->inverse_q44[i] << 30) / ale_max64(smooth_q44[i], FARTHEST_Q44);
        p->x_q4[i] = moved_q4(p->x_q4[i], ratio_q30);
        p->y_q4[i] = moved_q4(p->y_q4[i], ratio_q30);
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

_Static_assert(MOST_RANGE_UM + ALE_MIN_RANGE_UM <= ALE_MAX_RANGE_UM,
               "blocks of points are listed without another look");
