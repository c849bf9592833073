#include "extract/runs.h"

#include <string.h>

#include "base/fixed.h"
#include "extract/breakpoint.h"
#include "extract/moments.h"
#include "extract/segment.h"

enum {
    MAX_GAP_POINTS = 8,
    SETTLED_PART = 10, /* of its points that a run may gain or lose, and its breaks need not be placed anew */
    COSTLY_STEP = 4,   /* to the next try, where a costly scan has no line */
    MIN_SPLIT_POINTS = 16,
    STEP_WINDOWS = 4,     /* windows of a run that is looked at for a step */
    STEP_SHARED_Q8 = 173, /* shared variances of the difference of two adjoining windows' means, */
    STEP_DEVIATIONS_Q4 =
        76,        /* and its deviations that fewer than one run of 600 points in 1000 has anywhere */
    TRIM_MOST = 3, /* points given up at one end, */
    TRIM_SUSPICIOUS_Q8 = 333, /* where a run has more than its noise: chi square of a degree of freedom. */
    TRIM_FIRST = 10,          /* Own variances that one point given up must bring, */
    TRIM_NEXT = 4,            /* each further one, */
    TRIM_SHARED = 12,         /* and shared variances each */
    MOST_EFFORT_PLACED = ALE_MOST_EFFORT + 120, /* with the breaks that are placed again, */
    FINE_EFFORT = 8,                            /* which take each so much from a narrow step on, */
    WIDE_EFFORT = 16,                           /* and from a wide one */
    MOST_TRIED = 12 /* runs that are tried for a break: of polygons seldom more are suspicious */
};

static void add_run(ale_run_list_t *r, int32_t a, int32_t b, const ale_run_fit_t *fit)
{
    if (r->count >= ALE_MAX_RUNS) {
        r->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    ale_run_t *run = &r->run[r->count++];
    run->first = (uint16_t)(a < b ? a : b);
    run->last = (uint16_t)(a < b ? b : a);
    run->curved = false;
    run->no_arc = false;
    run->no_break = false;
    run->no_curve = false;
    run->settled = false;
    run->fit = *fit;
}

static void reverse_runs(ale_run_list_t *r, int32_t from)
{
    for (int32_t a = from, b = r->count - 1; a < b; a++, b--) {
        const ale_run_t run = r->run[a];
        r->run[a] = r->run[b];
        r->run[b] = run;
    }
}

static void search_segment(ale_run_list_t *r, int32_t first, int32_t last)
{
    if (last - first + 1 < ALE_MIN_RUN) {
        r->refused[ALE_REFUSED_FEW_POINTS]++;
        return;
    }
    const int32_t direction = ale_points_reading_direction(&r->scan.points, first, last);
    const int32_t stop = direction > 0 ? last : first;
    const int32_t first_run = r->count;
    int32_t from = direction > 0 ? first : last;
    while ((stop - from) * direction + 1 >= ALE_MIN_RUN) {
        ale_run_fit_t fit;
        const int32_t to = ale_break_search(r, from, stop, &fit);
        const int32_t beyond_no_line = ale_costly(r) ? COSTLY_STEP : 1;
        if (to != from) {
            add_run(r, from, to, &fit);
        }
        from = to != from ? to + direction : from + direction * beyond_no_line;
    }
    if (direction < 0) {
        reverse_runs(r, first_run);
    }
}

/* How many points a run may lose at one end, so that both ends may be moved at the same time. */
static int32_t spare_points(const ale_run_t *run)
{
    const int32_t spare = run->last + 1 - run->first - ALE_MIN_RUN;
    return spare > 0 ? spare / 2 : 0;
}

static int32_t break_between(ale_run_list_t *r, ale_run_t *a, ale_run_t *b, int32_t widest_step)
{
    const int32_t direction = ale_points_reading_direction(&r->scan.points, a->first, b->last);
    const ale_break_range_t range = {
        .lowest = a->last - spare_points(a),
        .highest = b->first - 1 + spare_points(b),
        .start = direction > 0 ? a->last : b->first - 1,
        .direction = direction,
        .widest_step = widest_step,
    };
    return ale_break_place(r, (ale_segment_t){a->first, b->last}, ale_fit_of_run(&r->scan, a),
                           ale_fit_of_run(&r->scan, b), &range);
}

static void move_break(ale_run_t *a, ale_run_t *b, int32_t split)
{
    if (a->last != split) {
        a->last = (uint16_t)split;
        ale_run_changed(a);
    }
    if (b->first != split + 1) {
        b->first = (uint16_t)(split + 1);
        ale_run_changed(b);
    }
}

/* A run whose ends hardly move keeps its line, and so its neighbours their breaks. */
static void move_ends(ale_run_t *run, int32_t first, int32_t last)
{
    const int64_t moved = ale_abs64(first - run->first) + ale_abs64(last - run->last);
    if (moved > 0) {
        run->first = (uint16_t)first;
        run->last = (uint16_t)last;
        ale_run_changed(run);
    }
    run->settled = moved * SETTLED_PART <= last + 1 - first;
}

static bool may_move(const ale_run_list_t *r, const ale_run_t *a, const ale_run_t *b)
{
    return !(a->settled && b->settled) && !a->curved && !b->curved && b->first - a->last <= MAX_GAP_POINTS &&
           ale_segment_joins(&r->scan.segments, a->last, b->first);
}

void ale_runs_place(ale_run_list_t *r, int32_t widest_step)
{
    int32_t split_before[ALE_MAX_RUNS + 1]; /* each run; and at last, after them all */
    split_before[0] = -1;
    split_before[r->count] = -1;
    for (int32_t k = 1; k < r->count; k++) {
        ale_run_t *a = &r->run[k - 1];
        ale_run_t *b = &r->run[k];
        split_before[k] = may_move(r, a, b) ? break_between(r, a, b, widest_step) : -1;
    }
    for (int32_t k = 0; k < r->count; k++) {
        ale_run_t *run = &r->run[k];
        const int32_t begin = split_before[k];
        const int32_t end = split_before[k + 1];
        move_ends(run, begin >= 0 ? begin + 1 : run->first, end >= 0 ? end : run->last);
    }
}

static int32_t breaks_to_place(const ale_run_list_t *r)
{
    int32_t breaks = 0;
    for (int32_t k = 1; k < r->count; k++) {
        breaks += may_move(r, &r->run[k - 1], &r->run[k]);
    }
    return breaks;
}

bool ale_runs_place_again(ale_run_list_t *r, int32_t widest_step)
{
    const int32_t breaks = breaks_to_place(r);
    if (ale_effort_is_spent(r) || r->effort + breaks * FINE_EFFORT > MOST_EFFORT_PLACED) {
        return false;
    }
    const bool fine = r->effort + breaks * WIDE_EFFORT > MOST_EFFORT_PLACED;
    ale_runs_place(r, fine ? ALE_BREAK_FINE_STEP : widest_step);
    return true;
}

static void insert_run(ale_run_list_t *r, int32_t k, int32_t split)
{
    for (int32_t i = r->count; i > k; i--) {
        r->run[i] = r->run[i - 1];
    }
    move_break(&r->run[k], &r->run[k + 1], split);
    r->count++;
}

static int32_t suspicious_runs(ale_run_list_t *r, int32_t fewest)
{
    int32_t count = 0;
    for (int32_t k = 0; k < r->count; k++) {
        const ale_run_t *run = &r->run[k];
        count += !run->curved && !run->no_break && run->last + 1 - run->first >= fewest &&
                 ale_break_suspicious(ale_fit_of_run(&r->scan, &r->run[k]));
    }
    return count;
}

/* Fewest points of the runs that are tried for a break: of many only the longest. */
static int32_t fewest_to_split(ale_run_list_t *r)
{
    const int32_t most = ale_costly(r) ? MOST_TRIED / 3 : MOST_TRIED;
    const int32_t room = (int32_t)ale_min64(most, ALE_MANY_RUNS - r->count);
    int32_t fewest = MIN_SPLIT_POINTS;
    while (r->count > room && fewest <= r->scan.points.count && suspicious_runs(r, fewest) > room) {
        fewest += fewest / 4;
    }
    return fewest;
}

/* Squared residuals that k points at an end of a run may add to it. */
static int64_t most_of_end_q8(const ale_run_fit_t *fit, int32_t k)
{
    return (TRIM_FIRST + TRIM_NEXT * (k - 1)) * fit->var_q8 + (int64_t)TRIM_SHARED * k * fit->shared_q8;
}

/* Points of the surface beyond an end of a run, when they are too few for a run of their own and none has
 * them.
 */
static int32_t points_beyond(const ale_run_list_t *r, int32_t k, bool at_first)
{
    int32_t i = at_first ? r->run[k].first : r->run[k].last;
    int32_t points = 0;
    while (points < ALE_MIN_RUN &&
           (at_first ? i > 0 && !r->scan.segments.jump_after[i - 1] : !r->scan.segments.jump_after[i])) {
        i += at_first ? -1 : 1;
        points++;
    }
    const bool taken =
        at_first ? k > 0 && r->run[k - 1].last >= i : k + 1 < r->count && r->run[k + 1].first <= i;
    return points < ALE_MIN_RUN && !taken ? points : 0;
}

/* Takes in all of them, or the half: what would not be given up again. */
static void take_points_beyond(ale_run_list_t *r, int32_t k, bool at_first)
{
    ale_run_t *run = &r->run[k];
    for (int32_t points = points_beyond(r, k, at_first); points > 0; points /= 2) {
        const int32_t first = run->first - (at_first ? points : 0);
        const int32_t last = run->last + (at_first ? 0 : points);
        const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, run);
        r->effort++;
        if (ale_moments_sse_q8(&r->scan, first, last) - fit->sse_q8 <= most_of_end_q8(fit, points)) {
            run->first = (uint16_t)first;
            run->last = (uint16_t)last;
            ale_run_changed(run);
            return;
        }
    }
}

/* Where the surface ends behind a break that was missed, the search has often left out the last points: they
 * did not lie on the line of both parts. Where neighbours share an error they are waves as well. */
static void split_run(ale_run_list_t *r, int32_t k, int32_t split)
{
    insert_run(r, k, split);
    if (r->scan.noise.shared_scale_q8 <= 256) {
        take_points_beyond(r, k, true);
        take_points_beyond(r, k + 1, false);
    }
}

bool ale_runs_split(ale_run_list_t *r)
{
    const int32_t fewest = fewest_to_split(r);
    const int32_t before = r->count;
    int32_t k = 0;
    while (k < r->count && r->count < ALE_MAX_RUNS) {
        ale_run_t *run = &r->run[k];
        if (!run->curved && !run->no_break && run->last + 1 - run->first >= fewest) {
            const int32_t split =
                ale_break_find(r, run, ale_points_reading_direction(&r->scan.points, run->first, run->last));
            run->no_break = true;
            if (split >= 0) {
                split_run(r, k, split);
                k++;
            }
        }
        k++;
    }
    return r->count > before;
}

/* How far the means of the points before and after a split are apart along a direction, over a window each;
 * in units of the direction's length, Q4 and the points of a window. */
static int64_t step_after(const ale_run_list_t *r, const ale_normal_line_t *line, int32_t window,
                          int32_t split)
{
    const ale_moments_t *before = &r->scan.sum[split + 1 - window];
    const ale_moments_t *here = &r->scan.sum[split + 1];
    const ale_moments_t *after = &r->scan.sum[split + 1 + window];
    return ale_abs64(line->nx * (before->x - 2 * here->x + after->x) +
                     line->ny * (before->y - 2 * here->y + after->y));
}

/* The point after which the run has its sharpest step, if it is more than noise makes; or -1. A window is as
 * long as the shared error holds on: its waves are longer than a step. */
static int32_t find_step(const ale_run_list_t *r, ale_run_t *run)
{
    const int32_t window = r->scan.noise.shared_beams;
    if (run->curved || run->last + 1 - run->first < STEP_WINDOWS * window) {
        return -1;
    }
    const ale_normal_line_t line = ale_moments_normal_line(&r->scan, run->first, run->last);
    const int32_t direction = ale_points_reading_direction(&r->scan.points, run->first, run->last);
    int32_t best = -1;
    int64_t most = 0;
    for (int32_t k = window - 1; k + window <= run->last - run->first; k++) {
        const int32_t split = direction > 0 ? run->first + k : run->last - 1 - k;
        const int64_t step = step_after(r, &line, window, split);
        if (step > most) {
            most = step;
            best = split;
        }
    }
    const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, run);
    const int64_t length = (int64_t)ale_isqrt((uint64_t)(line.nx * line.nx + line.ny * line.ny));
    const int64_t step_q4 = most / ale_max64(length, 1);
    const int64_t var_q8 = 2 * fit->var_q8 / window + ((STEP_SHARED_Q8 * fit->shared_q8) >> 8);
    const int64_t limit_q8 =
        ((int64_t)STEP_DEVIATIONS_Q4 * STEP_DEVIATIONS_Q4 * var_q8 >> 8) * window * window;
    return step_q4 * step_q4 > limit_q8 ? best : -1;
}

bool ale_runs_split_at_steps(ale_run_list_t *r)
{
    const int32_t before = r->count;
    for (int32_t k = 0; k < r->count && r->count < ALE_MAX_RUNS; k++) {
        const int32_t split = find_step(r, &r->run[k]);
        if (split >= 0) {
            insert_run(r, k, split);
            k++;
        }
    }
    return r->count > before;
}

/* How many points to give up at one end: what they bring beyond what noise would is most. */
static int32_t points_to_trim(const ale_run_list_t *r, const ale_run_t *run, bool at_first)
{
    int32_t best = 0;
    int64_t most = 0;
    for (int32_t k = 1; k <= TRIM_MOST && 2 * k <= run->fit.n - r->min_points; k++) {
        const int32_t first = run->first + (at_first ? k : 0);
        const int32_t last = run->last - (at_first ? 0 : k);
        const int64_t gain =
            run->fit.sse_q8 - ale_moments_sse_q8(&r->scan, first, last) - most_of_end_q8(&run->fit, k);
        if (gain > most) {
            most = gain;
            best = k;
        }
    }
    return best;
}

void ale_run_trim(const ale_run_list_t *r, ale_run_t *run)
{
    if (ale_fit_chi_q8(ale_fit_of_run(&r->scan, run)) < (int64_t)(run->fit.n - 2) * TRIM_SUSPICIOUS_Q8) {
        return;
    }
    const int32_t at_first = points_to_trim(r, run, true);
    const int32_t at_last = points_to_trim(r, run, false);
    if (at_first + at_last > 0) {
        run->first = (uint16_t)(run->first + at_first);
        run->last = (uint16_t)(run->last - at_last);
        ale_run_changed(run);
    }
}

void ale_runs_search(ale_run_list_t *r)
{
    memset(r->refused, 0, sizeof r->refused); /* by a search that is done again nothing was */
    r->count = 0;
    r->search_fits = 0;
    for (int32_t k = 0; k < r->scan.segments.count; k++) {
        search_segment(r, r->scan.segments.segment[k].first, r->scan.segments.segment[k].last);
    }
}
