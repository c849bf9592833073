#include "extract/outlier.h"

#include <string.h>

#include "base/fixed.h"

enum {
    STRAY_POINTS = 4, /* pieces of so few points are no surface */
    SPIKE_FACTOR = 4, /* deviations by which a spike stands out from both neighbours */
    SHORT_STRETCH = 8,
    SPIKE_REACH = 7 /* beams that a spike and two neighbours on each side may take */
};

/* Points to be removed, ascending. */
typedef struct {
    uint16_t point[ALE_MAX_BEAMS];
    int32_t count;
} removal_t;

/* A short stretch is not worth three calls. */
static void move_points(ale_points_t *p, int32_t to, int32_t from, int32_t end)
{
    const size_t points = (size_t)(end - from);
    if (points > SHORT_STRETCH) {
        memmove(&p->beam[to], &p->beam[from], points * sizeof *p->beam);
        memmove(&p->range_um[to], &p->range_um[from], points * sizeof *p->range_um);
        memmove(&p->inverse_q44[to], &p->inverse_q44[from], points * sizeof *p->inverse_q44);
        return;
    }
    for (; from < end; from++, to++) {
        p->beam[to] = p->beam[from];
        p->range_um[to] = p->range_um[from];
        p->inverse_q44[to] = p->inverse_q44[from];
    }
}

static void remove_points(ale_points_t *p, const removal_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        const int32_t end = k + 1 < r->count ? r->point[k + 1] : p->count;
        move_points(p, r->point[k] - k, r->point[k] + 1, end);
    }
    p->count = (uint16_t)(p->count - r->count);
}

/* Once stray pieces are gone a surface may have another neighbour, on which the change beside it depends,
 * too: nowhere else do jumps become other ones. */
static void suspect_ends(ale_segments_t *s, int32_t first, int32_t last)
{
    uint16_t *suspect = &s->suspect[s->suspect_count];
    suspect[0] = (uint16_t)first;
    suspect[1] = (uint16_t)(last - 1);
    suspect[2] = (uint16_t)last;
    s->suspect_count = (uint16_t)(s->suspect_count + 3);
}

int32_t ale_outlier_remove_strays(ale_points_t *points, ale_segments_t *s)
{
    removal_t removal;
    removal.count = 0;
    s->suspect_count = 0;
    for (int32_t k = 0; k < s->count; k++) {
        const ale_segment_t piece = s->segment[k];
        if (piece.last + 1 - piece.first > STRAY_POINTS) {
            suspect_ends(s, piece.first - removal.count, piece.last - removal.count);
            continue;
        }
        for (int32_t i = piece.first; i <= piece.last; i++) {
            removal.point[removal.count++] = (uint16_t)i;
        }
    }
    if (removal.count == 0) {
        return 0;
    }
    remove_points(points, &removal);
    if (s->suspect_count > 0) {
        s->suspect_count--; /* nothing follows the last piece */
    }
    return removal.count;
}

/* How far the point lies off where two neighbours on one side lead. */
static int64_t off_course_um(const int32_t *range_um, int64_t side)
{
    return ale_abs64((int64_t)range_um[0] - 2 * (int64_t)range_um[side] + range_um[2 * side]);
}

/* A point stands out when both neighbours agree with each other and it lies off both on the same side,
 * the local slope taken off, but goes on on neither: that is a step. Where the bearing errs more than the
 * range none is told. 2 <= i < count - 2. */
static inline bool is_spike(const ale_points_t *p, const ale_scan_noise_t *noise, int32_t i)
{
    const int32_t *range_um = &p->range_um[i];
    const int64_t sigma_um = noise->sigma_um + (range_um[0] * noise->sigma_per_range_q20 >> 20);
    const int64_t limit_um = SPIKE_FACTOR * sigma_um;
    if (ale_abs64(2 * (int64_t)range_um[0] - range_um[-1] - range_um[1]) <= 2 * limit_um) {
        return false; /* most are not worth the slope */
    }
    const int32_t slope_um = (range_um[2] - range_um[-2]) / 4;
    const int32_t left_um = range_um[0] - range_um[-1] - slope_um;
    const int32_t right_um = range_um[0] - range_um[1] + slope_um;
    if ((left_um < 0) != (right_um < 0)) {
        return false;
    }
    const int64_t left = ale_abs64(left_um);
    const int64_t right = ale_abs64(right_um);
    if (left <= limit_um || right <= limit_um || ale_abs64(left - right) > limit_um ||
        p->beam[i + 2] - p->beam[i - 2] > SPIKE_REACH) {
        return false;
    }
    const int64_t bearing_error = ale_abs64(slope_um) * noise->bearing_nrad;
    return bearing_error > sigma_um * p->step_nrad ||
           (off_course_um(range_um, -1) > limit_um && off_course_um(range_um, 1) > limit_um);
}

/* The suspects keep their places among the points that stay; those at a removed point become the place where
 * its neighbours meet. */
static void renumber_suspects(ale_segments_t *s, const removal_t *r)
{
    int32_t kept = 0;
    int32_t gone = 0;
    for (int32_t k = 0; k < s->suspect_count; k++) {
        while (gone < r->count && r->point[gone] <= s->suspect[k]) {
            gone++;
        }
        const uint16_t point = (uint16_t)(s->suspect[k] - gone);
        if (kept == 0 || point != s->suspect[kept - 1]) {
            s->suspect[kept++] = point;
        }
    }
    s->suspect_count = (uint16_t)kept;
}

int32_t ale_outlier_remove_spikes(ale_points_t *points, ale_segments_t *s, const ale_scan_noise_t *noise)
{
    removal_t removal;
    removal.count = 0;
    if (s->unruly) {
        return 0; /* where changes stand out everywhere no point does */
    }
    int32_t next = 2;
    for (int32_t k = 0; k < s->suspect_count; k++) {
        const int32_t suspect = s->suspect[k];
        const int32_t last = suspect + 3 < points->count ? suspect + 1 : points->count - 3;
        for (int32_t i = suspect < next ? next : suspect; i <= last; i++) {
            if (is_spike(points, noise, i)) {
                removal.point[removal.count++] = (uint16_t)i;
            }
        }
        next = suspect + 2 > next ? suspect + 2 : next;
    }
    if (removal.count > 0) {
        remove_points(points, &removal);
        renumber_suspects(s, &removal);
    }
    return removal.count;
}
