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
static void move_points(ale_extractor_t *e, int32_t to, int32_t from, int32_t end)
{
    const size_t points = (size_t)(end - from);
    if (points > SHORT_STRETCH) {
        memmove(&e->beam[to], &e->beam[from], points * sizeof *e->beam);
        memmove(&e->range_um[to], &e->range_um[from], points * sizeof *e->range_um);
        memmove(&e->inverse_q44[to], &e->inverse_q44[from], points * sizeof *e->inverse_q44);
        return;
    }
    for (; from < end; from++, to++) {
        e->beam[to] = e->beam[from];
        e->range_um[to] = e->range_um[from];
        e->inverse_q44[to] = e->inverse_q44[from];
    }
}

static void remove_points(ale_extractor_t *e, const removal_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        const int32_t end = k + 1 < r->count ? r->point[k + 1] : e->count;
        move_points(e, r->point[k] - k, r->point[k] + 1, end);
    }
    e->outliers = (uint16_t)(e->outliers + r->count);
    e->count = (uint16_t)(e->count - r->count);
}

/* Once stray pieces are gone a surface may have another neighbour, on which the change beside it depends,
 * too: nowhere else do jumps become other ones. */
static void suspect_ends(ale_extractor_t *e, int32_t first, int32_t last)
{
    uint16_t *suspect = &e->suspect[e->suspect_count];
    suspect[0] = (uint16_t)first;
    suspect[1] = (uint16_t)(last - 1);
    suspect[2] = (uint16_t)last;
    e->suspect_count = (uint16_t)(e->suspect_count + 3);
}

bool ale_outlier_remove_strays(ale_extractor_t *e)
{
    removal_t removal;
    removal.count = 0;
    e->suspect_count = 0;
    for (int32_t k = 0; k < e->segment_count; k++) {
        const ale_segment_t piece = e->segment[k];
        if (piece.last + 1 - piece.first > STRAY_POINTS) {
            suspect_ends(e, piece.first - removal.count, piece.last - removal.count);
            continue;
        }
        for (int32_t i = piece.first; i <= piece.last; i++) {
            removal.point[removal.count++] = (uint16_t)i;
        }
    }
    if (removal.count == 0) {
        return false;
    }
    remove_points(e, &removal);
    if (e->suspect_count > 0) {
        e->suspect_count--; /* nothing follows the last piece */
    }
    return true;
}

/* How far the point lies off where two neighbours on one side lead. */
static int64_t off_course_um(const int32_t *range_um, int64_t side)
{
    return ale_abs64((int64_t)range_um[0] - 2 * (int64_t)range_um[side] + range_um[2 * side]);
}

/* A point stands out when both neighbours agree with each other and it lies off both on the same side,
 * the local slope taken off, but goes on on neither: that is a step. Where the bearing errs more than the
 * range none is told. 2 <= i < count - 2. */
static inline bool is_spike(const ale_extractor_t *e, int32_t i)
{
    const int32_t *range_um = &e->range_um[i];
    const int64_t sigma_um = e->noise.sigma_um + (range_um[0] * e->noise.sigma_per_range_q20 >> 20);
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
        e->beam[i + 2] - e->beam[i - 2] > SPIKE_REACH) {
        return false;
    }
    const int64_t bearing_error = ale_abs64(slope_um) * e->config.noise.bearing_nrad;
    return bearing_error > sigma_um * e->step_nrad ||
           (off_course_um(range_um, -1) > limit_um && off_course_um(range_um, 1) > limit_um);
}

/* The suspects keep their places among the points that stay; those at a removed point become the place where
 * its neighbours meet. */
static void renumber_suspects(ale_extractor_t *e, const removal_t *r)
{
    int32_t kept = 0;
    int32_t gone = 0;
    for (int32_t k = 0; k < e->suspect_count; k++) {
        while (gone < r->count && r->point[gone] <= e->suspect[k]) {
            gone++;
        }
        const uint16_t point = (uint16_t)(e->suspect[k] - gone);
        if (kept == 0 || point != e->suspect[kept - 1]) {
            e->suspect[kept++] = point;
        }
    }
    e->suspect_count = (uint16_t)kept;
}

void ale_outlier_remove_spikes(ale_extractor_t *e)
{
    removal_t removal;
    removal.count = 0;
    if (e->unruly) {
        return; /* where changes stand out everywhere no point does */
    }
    int32_t next = 2;
    for (int32_t k = 0; k < e->suspect_count; k++) {
        const int32_t suspect = e->suspect[k];
        const int32_t last = suspect + 3 < e->count ? suspect + 1 : e->count - 3;
        for (int32_t i = suspect < next ? next : suspect; i <= last; i++) {
            if (is_spike(e, i)) {
                removal.point[removal.count++] = (uint16_t)i;
            }
        }
        next = suspect + 2 > next ? suspect + 2 : next;
    }
    if (removal.count > 0) {
        remove_points(e, &removal);
        renumber_suspects(e, &removal);
    }
}
