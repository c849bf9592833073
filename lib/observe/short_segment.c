#include "observe/short_segment.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    SEGMENT_POINTS = 6,
    GAP_FLOOR_UM = 60000, /* neighbours farther apart than this and than GAP_SPACINGS end a run */
    GAP_SPACINGS = 4,
    POINT_UM = 150000,       /* largest extent of a point feature */
    POINT_CLEAR_UM = 100000, /* its neighbours must be farther by this */
    STRAIGHT_UM = 25000,     /* shortest segment that has a direction of its own */
    ROUNDNESS_UM = 10000,    /* one sigma: a small object shows another side from every pose */
    ANGLE_OWN_URAD = 150000, /* one sigma of the direction of a short segment */
    ANGLE_FACING_URAD = 600000,
    ROUNDING_UM = 10 /* by which the distance of two rounded points may exceed that bound */
};

typedef struct {
    ale_posed_scan_t from;
    const ale_noise_t *noise;
    ale_segment_workspace_t *memory;
    ale_observation_t *out;
    int32_t reach;  /* beams from a point to the next one of its surface, at most */
    int32_t points; /* of memory->beam */
    uint32_t runs;  /* found */
    uint32_t parts; /* short segments and point features that they make */
    uint32_t count; /* of those, written to out */
} segments_t;

static int32_t range_of(const segments_t *p, int32_t point)
{
    return p->from.scan->range_um[p->memory->beam[point]];
}

/* From beam to beam. */
static int64_t spacing_um(const segments_t *p, int32_t point)
{
    return ale_abs64((int64_t)p->from.scan->step_bam * range_of(p, point)) / ALE_BAM_PER_RAD;
}

static uint32_t bearing_of(const segments_t *p, int32_t point)
{
    return ale_posed_bearing(&p->from, p->memory->beam[point]);
}

/* Computed on demand: of a run that is not chosen only a few are asked for. */
static ale_point_t point_of(const segments_t *p, int32_t point)
{
    ale_segment_workspace_t *memory = p->memory;
    if (!memory->known[point]) {
        memory->point[point] = ale_polar(range_of(p, point), bearing_of(p, point));
        memory->known[point] = true;
    }
    return memory->point[point];
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

/* 786 m^2: points so far apart are no piece of one surface, and the squares of larger moments do not fit. */
#define MOST_MOMENT INT64_C(768000000000)

/* Direction of the longer axis, or false when it is about as wide as long: (l1 - l2) / (l1 + l2)
 * below 0.8. */
static bool direction_of(const moments_t *c, uint32_t *direction_bam)
{
    const int64_t sum = c->xx + c->yy;
    const int64_t difference = c->xx - c->yy;
    if (sum > MOST_MOMENT) {
        return false;
    }
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
    const int64_t half_um = length_um / 2 + spacing_um(p, middle) / 2;
    uint32_t direction_bam;
    const bool straight = !is_point && n >= 3 && length_um > STRAIGHT_UM && direction_of(&c, &direction_bam);
    uint32_t normal_bam = straight ? direction_bam + ALE_BAM_QUARTER_TURN : facing_bam;
    if (ale_abs64(ale_bam_diff(normal_bam, facing_bam)) > ALE_BAM_QUARTER_TURN) {
        normal_bam += ALE_BAM_HALF_TURN;
    }
    const int64_t angle_urad = straight ? ANGLE_OWN_URAD : ANGLE_FACING_URAD;
    const int64_t systematic_um = p->noise->surface_um / 2;
    const int64_t round_um = straight ? 0 : ROUNDNESS_UM;
    const int32_t time_us = ale_scan_beam_offset_us(p->from.scan, p->memory->beam[middle]);
    p->out[p->count++] = (ale_observation_t){
        .centre = ale_pose_apply(p->from.sensor, c.mean),
        .normal_bam = normal_bam + p->from.sensor.theta_bam,
        .start_um = (int32_t)-half_um,
        .end_um = (int32_t)half_um,
        .var_offset_um2 = ale_noise_own_var_um2(p->noise, range_of(p, middle)) / n +
                          ale_noise_shared_var_um2(p->noise, range_of(p, middle)) +
                          systematic_um * systematic_um + round_um * round_um,
        .var_angle_urad2 = angle_urad * angle_urad,
        .start_time_us = time_us,
        .end_time_us = time_us,
        .first_beam = p->memory->beam[first],
        .last_beam = p->memory->beam[last],
        .kind = is_point ? ALE_OBSERVATION_POINT : ALE_OBSERVATION_SEGMENT,
    };
}

/* The next beam with an echo on one side, or the next beam where there is none within reach. */
static int32_t beam_beside(const segments_t *p, int32_t beam, int32_t side)
{
    const ale_scan_t *scan = p->from.scan;
    for (int32_t k = beam + side; ale_abs64(k - beam) <= p->reach && k >= 0 && k < scan->beams; k += side) {
        if (scan->flag[k] == ALE_BEAM_VALID) {
            return k;
        }
    }
    return beam + side;
}

/* Whether the beam beside a point at the end of a run met nothing or something clearly farther. */
static bool is_clear(const segments_t *p, int32_t point, int32_t side)
{
    const ale_scan_t *scan = p->from.scan;
    const int32_t beam = beam_beside(p, p->memory->beam[point], side);
    if (beam < 0 || beam >= scan->beams) {
        return false;
    }
    return scan->flag[beam] == ALE_BEAM_NO_RETURN ||
           (scan->flag[beam] == ALE_BEAM_VALID && scan->range_um[beam] > range_of(p, point) + POINT_CLEAR_UM);
}

/* Stores a run and the number of short segments that it makes. */
static void store_run(segments_t *p, int32_t first, int32_t last)
{
    const int32_t n = last - first + 1;
    if (n < 2) {
        return;
    }
    const bool small = distance2(point_of(p, first), point_of(p, last)) < (int64_t)POINT_UM * POINT_UM;
    const bool is_point = small && is_clear(p, first, -1) && is_clear(p, last, 1);
    const int32_t parts = is_point ? 0 : (n + SEGMENT_POINTS - 1) / SEGMENT_POINTS;
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

/* Whether point k continues the surface of point k - 1. The sum of the steps along and across the beam, which
 * is cheap, bounds their distance from above. */
static bool continues(const segments_t *p, int32_t k)
{
    if (p->memory->beam[k] - p->memory->beam[k - 1] > p->reach) {
        return false;
    }
    const int64_t range_um = range_of(p, k);
    const int64_t along_um = ale_abs64(range_um - range_of(p, k - 1));
    const int64_t turn_bam = ale_abs64(ale_bam_diff(bearing_of(p, k), bearing_of(p, k - 1)));
    const int64_t path_um = along_um + turn_bam * range_um / ALE_BAM_PER_RAD + ROUNDING_UM;
    if (path_um < GAP_FLOOR_UM) {
        return true;
    }
    const int64_t gap_um = ale_max64(GAP_FLOOR_UM, GAP_SPACINGS * spacing_um(p, k));
    return path_um < gap_um || distance2(point_of(p, k - 1), point_of(p, k)) < gap_um * gap_um;
}

static void end_run(segments_t *p, int32_t *first)
{
    if (*first < p->points) {
        store_run(p, *first, p->points - 1);
    }
    *first = p->points;
}

/* Whether the beam is in the line over the seam of a whole turn, or of the others in the first that does not
 * end before it. */
static bool is_in_line(const ale_features_t *features, int32_t k, uint32_t *line)
{
    const ale_line_t *over_seam = ale_features_line_over_seam(features);
    if (over_seam && (k >= over_seam->first || k <= over_seam->last)) {
        return true;
    }
    while (*line < features->line_count && features->line[*line].last < k) {
        (*line)++;
    }
    return *line < features->line_count && features->line[*line].first <= k;
}

/* Runs of the beams that have an echo and are in no line. */
static void find_runs(segments_t *p, const ale_features_t *features)
{
    const ale_scan_t *scan = p->from.scan;
    uint32_t line = 0;
    int32_t first = 0;
    for (int32_t k = 0; k < scan->beams; k++) {
        if (is_in_line(features, k, &line)) {
            end_run(p, &first);
        } else if (scan->flag[k] == ALE_BEAM_VALID) {
            p->memory->beam[p->points] = (uint16_t)k;
            p->memory->known[p->points] = false;
            if (first < p->points && !continues(p, p->points)) {
                end_run(p, &first);
            }
            p->points++;
        }
    }
    end_run(p, &first);
}

uint32_t ale_observe_segments(const ale_features_t *features, const ale_posed_scan_t *from,
                              const ale_noise_t *noise, ale_segment_workspace_t *memory, uint32_t room,
                              ale_observation_t out[])
{
    segments_t p = {.from = *from, .noise = noise, .memory = memory, .out = out};
    p.reach = ale_scan_is_sparse(from->scan) ? ALE_MAX_GAP_BEAMS : 1;
    find_runs(&p, features);
    cut(&p, room);
    return p.count;
}
