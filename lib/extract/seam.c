#include "extract/seam.h"

#include <string.h>

#include "base/fixed.h"
#include "extract/breakpoint.h"
#include "extract/merge.h"
#include "extract/runs.h"

enum { MAX_GAP_POINTS = 8 }; /* as between any runs that may be joined */

/* Moves the first elements of an array behind its others. scratch: room for the array. */
static void rotate(void *array, size_t size, int32_t count, int32_t first, void *scratch)
{
    uint8_t *bytes = array;
    const size_t front = (size_t)first * size;
    const size_t rest = (size_t)(count - first) * size;
    memcpy(scratch, bytes, front);
    memmove(bytes, bytes + front, rest);
    memcpy(bytes + rest, scratch, front);
}

/* Lets point `first` be the first one: those before it follow the last one. */
static void rotate_listed(ale_points_t *p, int32_t first, void *scratch)
{
    const int32_t turned = p->beam[first] >= p->turn_beams ? p->turn_beams : 0;
    rotate(p->beam, sizeof *p->beam, p->count, first, scratch);
    rotate(p->range_um, sizeof *p->range_um, p->count, first, scratch);
    rotate(p->inverse_q44, sizeof *p->inverse_q44, p->count, first, scratch);
    for (int32_t i = 0; i < p->count; i++) {
        const bool beyond = i >= p->count - first;
        p->beam[i] = (uint16_t)(p->beam[i] + (beyond ? p->turn_beams : 0) - turned);
    }
}

static int32_t next_of(const ale_points_t *p, int32_t i)
{
    return i + 1 < p->count ? i + 1 : 0;
}

static int64_t change_um(const ale_points_t *p, int32_t i)
{
    return ale_abs64((int64_t)p->range_um[next_of(p, i)] - p->range_um[i]);
}

/* How likely a surface ends between point i and the next one, given the change before and after: a wide gap
 * comes before any change. */
static int64_t ending(const ale_points_t *p, int32_t i, int64_t before_um, int64_t here_um, int64_t after_um)
{
    const int32_t next = next_of(p, i);
    const int64_t gap = p->beam[next] - p->beam[i] + (next == 0 ? p->turn_beams : 0);
    return gap > ALE_MAX_GAP_BEAMS ? (gap << 32) + here_um : here_um - ale_max64(before_um, after_um);
}

void ale_seam_open(ale_prepared_scan_t *scan)
{
    ale_points_t *p = &scan->points;
    if (p->count < 2) {
        return;
    }
    int32_t best = p->count - 1;
    int64_t most = INT64_MIN;
    int64_t farthest_um = 0; /* of equals: the scan may begin anywhere */
    int64_t before_um = change_um(p, p->count - 1);
    int64_t here_um = change_um(p, 0);
    for (int32_t i = 0; i < p->count; i++) {
        const int64_t after_um = change_um(p, next_of(p, i));
        const int64_t likely = ending(p, i, before_um, here_um, after_um);
        const int64_t ranges_um = (int64_t)p->range_um[i] + p->range_um[next_of(p, i)];
        if (likely > most || (likely == most && ranges_um > farthest_um)) {
            most = likely;
            farthest_um = ranges_um;
            best = i;
        }
        before_um = here_um;
        here_um = after_um;
    }
    rotate_listed(p, next_of(p, best), scan->sum);
    ale_points_note_gaps(p);
}

/* The first run behind the break that is nearest to the middle of the points. */
static int32_t run_at_middle(const ale_run_list_t *r)
{
    int32_t best = 1;
    for (int32_t k = 2; k < r->count; k++) {
        const int64_t off = ale_abs64(2 * r->run[k].first - r->scan.points.count);
        best = off < ale_abs64(2 * r->run[best].first - r->scan.points.count) ? k : best;
    }
    return best;
}

/* Turns the order of points and runs so that run k is the first one. */
static void rotate_runs(ale_run_list_t *r, int32_t k)
{
    ale_points_t *p = &r->scan.points;
    ale_segments_t *s = &r->scan.segments;
    void *scratch = r->scan.sum;
    const int32_t first = r->run[k].first;
    const bool jump_at_new_seam = s->jump_after[first - 1];
    rotate_listed(p, first, scratch);
    rotate(p->x_q4, sizeof *p->x_q4, p->count, first, scratch);
    rotate(p->y_q4, sizeof *p->y_q4, p->count, first, scratch);
    s->jump_after[p->count - 1] = s->jump_at_seam;
    rotate(s->jump_after, sizeof *s->jump_after, p->count, first, scratch);
    s->jump_at_seam = jump_at_new_seam;
    s->jump_after[p->count - 1] = true;
    rotate(r->run, sizeof *r->run, r->count, k, scratch);
    for (int32_t i = 0; i < r->count; i++) {
        ale_run_t *run = &r->run[i];
        const int32_t moved = i < r->count - k ? -first : p->count - first;
        run->first = (uint16_t)(run->first + moved);
        run->last = (uint16_t)(run->last + moved);
    }
    ale_moments_build(&r->scan);
}

/* Whether the outer runs may be one, or their break may lie elsewhere. */
static bool may_meet(const ale_run_list_t *r)
{
    const ale_points_t *p = &r->scan.points;
    if (r->count < 2 || p->beam[0] + p->turn_beams - p->beam[p->count - 1] > ALE_MAX_GAP_BEAMS) {
        return false;
    }
    const int32_t loose = r->run[0].first + p->count - 1 - r->run[r->count - 1].last;
    return loose < MAX_GAP_POINTS && (loose > 0 || !r->scan.segments.jump_at_seam);
}

void ale_seam_close(ale_run_list_t *r)
{
    if (!may_meet(r)) {
        return;
    }
    const int32_t k = run_at_middle(r);
    const int32_t before_seam = r->count - k - 1;
    rotate_runs(r, k);
    r->run[before_seam].settled = false;
    r->run[before_seam + 1].settled = false;
    ale_merge_runs(r);
    ale_runs_place_again(r, ALE_BREAK_WIDE_STEP);
}
