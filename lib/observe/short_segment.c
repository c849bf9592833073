#include "observe/short_segment.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    SEGMENT_BEAMS = 6,
    GAP_FLOOR_UM = 60000, /* neighbours farther apart than this and than GAP_SPACINGS end a run */
    GAP_SPACINGS = 4,
    POINT_UM = 150000,       /* largest extent of a point feature */
    POINT_CLEAR_UM = 100000, /* its neighbours must be farther by this */
    STRAIGHT_UM = 25000,     /* shortest segment that has a direction of its own */
    ROUNDNESS_UM = 10000,    /* one sigma: a small object shows another side from every pose */
    ANGLE_OWN_URAD = 150000, /* one sigma of the direction of a short segment */
    ANGLE_FACING_URAD = 600000,
    BAM_PER_RAD = 683565276,
    ROUNDING_UM = 10 /* by which the distance of two rounded points may exceed that bound */
};

typedef struct {
    ale_posed_scan_t from;
    const ale_noise_t *noise;
    ale_segment_workspace_t *memory;
    ale_observation_t *out;
    uint32_t runs;  /* found */
    uint32_t parts; /* short segments and point features that they make */
    uint32_t count; /* of those, written to out */
} segments_t;

static int64_t spacing_um(const ale_scan_t *scan, int32_t beam)
{
    return ale_abs64((int64_t)scan->step_bam * scan->range_um[beam]) / BAM_PER_RAD;
}

static uint32_t bearing_of(const segments_t *p, int32_t beam)
{
    return p->from.bearing_bam ? p->from.bearing_bam[beam] : ale_scan_bearing(p->from.scan, beam);
}

/* Computed on demand: most beams of a dense scan lie in lines and need no point. */
static ale_point_t point_of(const segments_t *p, int32_t beam)
{
    ale_segment_workspace_t *memory = p->memory;
    if (!memory->known[beam]) {
        memory->point[beam] = ale_polar(p->from.scan->range_um[beam], bearing_of(p, beam));
        memory->known[beam] = true;
    }
    return memory->point[beam];
}

static int64_t distance2(ale_point_t a, ale_point_t b)
{
    const int64_t x = (int64_t)a.x_um - b.x_um;
    const int64_t y = (int64_t)a.y_um - b.y_um;
    return x * x + y * y;
}

/* Mean and second moments of a few points about it; the moments in 2^10 um^2, which int64 always holds. */
typedef struct {
    ale_point_t mean;
    int64_t xx;
    int64_t yy;
    int64_t xy;
} moments_t;

static moments_t moments_of(const segments_t *p, int32_t first, int32_t last)
{
    moments_t c = {{0, 0}, 0, 0, 0};
    int64_t x = 0;
    int64_t y = 0;
    const int32_t n = last - first + 1;
    for (int32_t k = first; k <= last; k++) {
        const ale_point_t q = point_of(p, k);
        x += q.x_um;
        y += q.y_um;
    }
    c.mean = (ale_point_t){(int32_t)ale_round_div(x, n), (int32_t)ale_round_div(y, n)};
    for (int32_t k = first; k <= last; k++) {
        const ale_point_t q = ale_minus(p->memory->point[k], c.mean);
        c.xx += ale_round_shift((int64_t)q.x_um * q.x_um, 10);
        c.yy += ale_round_shift((int64_t)q.y_um * q.y_um, 10);
        c.xy += ale_round_shift((int64_t)q.x_um * q.y_um, 10);
    }
    return c;
}

/* Direction of the longer axis, or false when it is about as wide as long: (l1 - l2) / (l1 + l2)
 * below 0.8. */
static bool direction_of(const moments_t *c, uint32_t *direction_bam)
{
    const int64_t sum = c->xx + c->yy;
    const int64_t difference = c->xx - c->yy;
    const int64_t spread =
        (int64_t)ale_isqrt((uint64_t)(ale_round_shift(difference, 8) * ale_round_shift(difference, 8) +
                                      4 * ale_round_shift(c->xy, 8) * ale_round_shift(c->xy, 8)))
        << 8;
    *direction_bam = ale_atan2_bam(2 * c->xy, difference) / 2;
    return spread * 5 > sum * 4;
}

static void add(segments_t *p, int32_t first, int32_t last, bool is_point)
{
    const moments_t c = moments_of(p, first, last);
    const int32_t n = last - first + 1;
    const int32_t middle = (first + last) / 2;
    const uint32_t facing_bam = ale_atan2_bam(-c.mean.y_um, -c.mean.x_um);
    const int64_t length_um = ale_isqrt((uint64_t)distance2(point_of(p, first), point_of(p, last)));
    const int64_t half_um = length_um / 2 + spacing_um(p->from.scan, middle) / 2;
    uint32_t direction_bam;
    const bool straight = !is_point && n >= 3 && length_um > STRAIGHT_UM && direction_of(&c, &direction_bam);
    uint32_t normal_bam = straight ? direction_bam + ALE_BAM_QUARTER_TURN : facing_bam;
    if (ale_abs64(ale_bam_diff(normal_bam, facing_bam)) > ALE_BAM_QUARTER_TURN) {
        normal_bam += ALE_BAM_HALF_TURN;
    }
    const int64_t angle_urad = straight ? ANGLE_OWN_URAD : ANGLE_FACING_URAD;
    const int64_t systematic_um = p->noise->surface_um / 2;
    const int64_t round_um = straight ? 0 : ROUNDNESS_UM;
    const int32_t time_us = ale_scan_beam_offset_us(p->from.scan, middle);
    p->out[p->count++] = (ale_observation_t){
        .centre = ale_pose_apply(p->from.sensor, c.mean),
        .normal_bam = normal_bam + p->from.sensor.theta_bam,
        .start_um = (int32_t)-half_um,
        .end_um = (int32_t)half_um,
        .var_offset_um2 = ale_noise_own_var_um2(p->noise, p->from.scan->range_um[middle]) / n +
                          ale_noise_shared_var_um2(p->noise, p->from.scan->range_um[middle]) +
                          systematic_um * systematic_um + round_um * round_um,
        .var_angle_urad2 = angle_urad * angle_urad,
        .start_time_us = time_us,
        .end_time_us = time_us,
        .first_beam = (uint16_t)first,
        .last_beam = (uint16_t)last,
        .kind = is_point ? ALE_OBSERVATION_POINT : ALE_OBSERVATION_SEGMENT,
    };
}

/* Whether the beam beside a run met nothing or something clearly farther. */
static bool is_clear(const segments_t *p, int32_t beam, int32_t range_um)
{
    if (beam < 0 || beam >= p->from.scan->beams) {
        return false;
    }
    const uint8_t flag = p->from.scan->flag[beam];
    return flag == ALE_BEAM_NO_RETURN ||
           (flag == ALE_BEAM_VALID && p->from.scan->range_um[beam] > range_um + POINT_CLEAR_UM);
}

/* Stores a run and the number of short segments that it makes. */
static void store_run(segments_t *p, int32_t first, int32_t last)
{
    const int32_t n = last - first + 1;
    if (n < 2) {
        return;
    }
    const bool small = distance2(point_of(p, first), point_of(p, last)) < (int64_t)POINT_UM * POINT_UM;
    const bool is_point = small && is_clear(p, first - 1, p->from.scan->range_um[first]) &&
                          is_clear(p, last + 1, p->from.scan->range_um[last]);
    const int32_t parts = is_point ? 0 : (n + SEGMENT_BEAMS - 1) / SEGMENT_BEAMS;
    p->memory->surface_run[p->runs++] = (ale_surface_run_t){(uint16_t)first, (uint16_t)last, (uint16_t)parts};
    p->parts += is_point ? 1 : (uint32_t)parts;
}

/* Cuts the runs into short segments; where there is no room for all, an even choice of them. */
static void cut(segments_t *p, uint32_t room)
{
    uint32_t number = 0;
    for (uint32_t i = 0; i < p->runs; i++) {
        const ale_surface_run_t *run = &p->memory->surface_run[i];
        const int32_t n = run->last - run->first + 1;
        const int32_t parts = run->parts > 0 ? run->parts : 1;
        for (int32_t k = 0; k < parts; k++) {
            if (ale_is_chosen(number++, p->parts, room)) {
                add(p, run->first + n * k / parts, run->first + n * (k + 1) / parts - 1, run->parts == 0);
            }
        }
    }
}

/* Whether beam k continues the surface of beam k - 1. The sum of the steps along and across the beam, which
 * is cheap, bounds their distance from above. */
static bool continues(const segments_t *p, int32_t k)
{
    const int64_t range_um = p->from.scan->range_um[k];
    const int64_t along_um = ale_abs64(range_um - p->from.scan->range_um[k - 1]);
    const int64_t turn_bam = ale_abs64(ale_bam_diff(bearing_of(p, k), bearing_of(p, k - 1)));
    const int64_t path_um = along_um + turn_bam * range_um / BAM_PER_RAD + ROUNDING_UM;
    if (path_um < GAP_FLOOR_UM) {
        return true;
    }
    const int64_t gap_um = ale_max64(GAP_FLOOR_UM, GAP_SPACINGS * spacing_um(p->from.scan, k));
    return path_um < gap_um || distance2(point_of(p, k - 1), point_of(p, k)) < gap_um * gap_um;
}

uint32_t ale_observe_segments(const ale_features_t *features, const ale_posed_scan_t *from,
                              const ale_noise_t *noise, ale_segment_workspace_t *memory, uint32_t room,
                              ale_observation_t out[])
{
    segments_t p = {.from = *from, .noise = noise, .memory = memory, .out = out};
    const ale_scan_t *scan = from->scan;
    int32_t begun = -1;
    uint32_t line = 0;
    for (int32_t k = 0; k < scan->beams; k++) {
        while (line < features->line_count && features->line[line].last < k) {
            line++;
        }
        const bool in_line = line < features->line_count && features->line[line].first <= k;
        const bool free = scan->flag[k] == ALE_BEAM_VALID && !in_line;
        memory->known[k] = false;
        if (begun >= 0 && (!free || !continues(&p, k))) {
            store_run(&p, begun, k - 1);
            begun = -1;
        }
        begun = free && begun < 0 ? k : begun;
    }
    if (begun >= 0) {
        store_run(&p, begun, scan->beams - 1);
    }
    cut(&p, room);
    return p.count;
}
