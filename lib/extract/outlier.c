#include "extract/outlier.h"

#include <string.h>

#include "base/fixed.h"

enum {
    STRAY_POINTS = 4, /* pieces of so few points are no surface */
    SPIKE_FACTOR = 4, /* deviations by which a spike stands out from both neighbours */
    SPIKE_REACH = 7   /* beams that a spike and two neighbours on each side may take */
};

/* Points to be removed, ascending. */
typedef struct {
    uint16_t point[ALE_MAX_BEAMS];
    int32_t count;
} removal_t;

static void move_points(ale_extractor_t *e, int32_t to, int32_t from, int32_t end)
{
    const size_t points = (size_t)(end - from);
    memmove(&e->beam[to], &e->beam[from], points * sizeof *e->beam);
    memmove(&e->range_um[to], &e->range_um[from], points * sizeof *e->range_um);
    memmove(&e->inverse_q44[to], &e->inverse_q44[from], points * sizeof *e->inverse_q44);
}

/* The suspects keep their places among the points that stay; those at a removed point become the place where
 * its neighbours meet. */
static void renumber_suspects(ale_extractor_t *e, const removal_t *r)
{
    int32_t kept = 0;
    int32_t before = -1;
    for (int32_t k = 0, gone = 0; k < e->suspect_count; k++) {
        while (gone < r->count && r->point[gone] <= e->suspect[k]) {
            gone++;
        }
        const int32_t i = e->suspect[k] - gone;
        if (i > before && i + 1 < e->count) {
            e->suspect[kept++] = (uint16_t)i;
            before = i;
        }
    }
    e->suspect_count = (uint16_t)kept;
}

static void remove_points(ale_extractor_t *e, const removal_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        const int32_t end = k + 1 < r->count ? r->point[k + 1] : e->count;
        move_points(e, r->point[k] - k, r->point[k] + 1, end);
    }
    e->outliers = (uint16_t)(e->outliers + r->count);
    e->count = (uint16_t)(e->count - r->count);
    renumber_suspects(e, r);
}

bool ale_outlier_remove_strays(ale_extractor_t *e)
{
    removal_t removal;
    removal.count = 0;
    for (int32_t k = 0; k < e->segment_count; k++) {
        const ale_segment_t piece = e->segment[k];
        if (piece.last + 1 - piece.first <= STRAY_POINTS) {
            for (int32_t i = piece.first; i <= piece.last; i++) {
                removal.point[removal.count++] = (uint16_t)i;
            }
        }
    }
    if (removal.count == 0) {
        return false;
    }
    remove_points(e, &removal);
    return true;
}

/* A point stands out when both neighbours agree with each other and it lies off both on the same side,
 * the local slope taken off. */
static bool is_spike(const ale_extractor_t *e, int32_t i)
{
    if (i < 2 || i + 2 >= e->count || e->beam[i + 2] - e->beam[i - 2] > SPIKE_REACH) {
        return false;
    }
    const int64_t here = e->range_um[i];
    const int64_t limit_um = SPIKE_FACTOR * (e->noise.sigma_um + (here * e->noise.sigma_per_range_q20 >> 20));
    const int64_t slope = ((int64_t)e->range_um[i + 2] - e->range_um[i - 2]) / 4;
    const int64_t left = here - e->range_um[i - 1] - slope;
    const int64_t right = here - e->range_um[i + 1] + slope;
    return ((left > limit_um && right > limit_um) || (left < -limit_um && right < -limit_um)) &&
           ale_abs64(left - right) <= limit_um;
}

void ale_outlier_remove_spikes(ale_extractor_t *e)
{
    removal_t removal;
    removal.count = 0;
    int32_t next = 0;
    for (int32_t k = 0; k < e->suspect_count; k++) {
        const int32_t i = e->suspect[k];
        for (int32_t point = i < next ? next : i; point <= i + 1; point++) {
            if (is_spike(e, point)) {
                removal.point[removal.count++] = (uint16_t)point;
            }
        }
        next = i + 2;
    }
    if (removal.count > 0) {
        remove_points(e, &removal);
    }
}
