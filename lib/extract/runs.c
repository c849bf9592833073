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

static void add_run(ale_extractor_t *e, int32_t a, int32_t b, const ale_run_fit_t *fit)
{
    if (e->run_count >= ALE_MAX_RUNS) {
        e->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    ale_run_t *run = &e->run[e->run_count++];
    run->first = (uint16_t)(a < b ? a : b);
    run->last = (uint16_t)(a < b ? b : a);
    run->curved = false;
    run->no_arc = false;
    run->no_break = false;
    run->settled = false;
    run->fit = *fit;
}

static void reverse_runs(ale_extractor_t *e, int32_t from)
{
    for (int32_t a = from, b = e->run_count - 1; a < b; a++, b--) {
        const ale_run_t run = e->run[a];
        e->run[a] = e->run[b];
        e->run[b] = run;
    }
}

static void search_segment(ale_extractor_t *e, int32_t first, int32_t last)
{
    if (last - first + 1 < ALE_MIN_RUN) {
        e->refused[ALE_REFUSED_FEW_POINTS]++;
        return;
    }
    const int32_t direction = ale_reading_direction(e, first, last);
    const int32_t stop = direction > 0 ? last : first;
    const int32_t first_run = e->run_count;
    int32_t from = direction > 0 ? first : last;
    while ((stop - from) * direction + 1 >= ALE_MIN_RUN) {
        ale_run_fit_t fit;
        const int32_t to = ale_break_search(e, from, stop, &fit);
        const int32_t beyond_no_line = ale_costly(e) ? COSTLY_STEP : 1;
        if (to != from) {
            add_run(e, from, to, &fit);
        }
        from = to != from ? to + direction : from + direction * beyond_no_line;
    }
    if (direction < 0) {
        reverse_runs(e, first_run);
    }
}

/* How many points a run may lose at one end, so that both ends may be moved at the same time. */
static int32_t spare_points(const ale_run_t *run)
{
    const int32_t spare = run->last + 1 - run->first - ALE_MIN_RUN;
    return spare > 0 ? spare / 2 : 0;
}

static int32_t break_between(ale_extractor_t *e, ale_run_t *a, ale_run_t *b, int32_t widest_step)
{
    const int32_t direction = ale_reading_direction(e, a->first, b->last);
    const ale_break_range_t range = {
        .lowest = a->last - spare_points(a),
        .highest = b->first - 1 + spare_points(b),
        .start = direction > 0 ? a->last : b->first - 1,
        .direction = direction,
        .widest_step = widest_step,
    };
    return ale_break_place(e, (ale_segment_t){a->first, b->last}, ale_fit_of_run(e, a)->var_q8,
                           ale_fit_of_run(e, b)->var_q8, &range);
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

static bool may_move(const ale_extractor_t *e, const ale_run_t *a, const ale_run_t *b)
{
    return !(a->settled && b->settled) && !a->curved && !b->curved && b->first - a->last <= MAX_GAP_POINTS &&
           ale_segment_joins(e, a->last, b->first);
}

void ale_runs_place(ale_extractor_t *e, int32_t widest_step)
{
    int32_t split_before[ALE_MAX_RUNS + 1]; /* each run; and at last, after them all */
    split_before[0] = -1;
    split_before[e->run_count] = -1;
    for (int32_t k = 1; k < e->run_count; k++) {
        ale_run_t *a = &e->run[k - 1];
        ale_run_t *b = &e->run[k];
        split_before[k] = may_move(e, a, b) ? break_between(e, a, b, widest_step) : -1;
    }
    for (int32_t k = 0; k < e->run_count; k++) {
        ale_run_t *run = &e->run[k];
        const int32_t begin = split_before[k];
        const int32_t end = split_before[k + 1];
        move_ends(run, begin >= 0 ? begin + 1 : run->first, end >= 0 ? end : run->last);
    }
}

static int32_t breaks_to_place(const ale_extractor_t *e)
{
    int32_t breaks = 0;
    for (int32_t k = 1; k < e->run_count; k++) {
        breaks += may_move(e, &e->run[k - 1], &e->run[k]);
    }
    return breaks;
}

bool ale_runs_place_again(ale_extractor_t *e, int32_t widest_step)
{
    const int32_t breaks = breaks_to_place(e);
    if (ale_effort_is_spent(e) || e->effort + breaks * FINE_EFFORT > MOST_EFFORT_PLACED) {
        return false;
    }
    const bool fine = e->effort + breaks * WIDE_EFFORT > MOST_EFFORT_PLACED;
    ale_runs_place(e, fine ? ALE_BREAK_FINE_STEP : widest_step);
    return true;
}

static void insert_run(ale_extractor_t *e, int32_t k, int32_t split)
{
    for (int32_t i = e->run_count; i > k; i--) {
        e->run[i] = e->run[i - 1];
    }
    move_break(&e->run[k], &e->run[k + 1], split);
    e->run_count++;
}

static int32_t suspicious_runs(ale_extractor_t *e, int32_t fewest)
{
    int32_t count = 0;
    for (int32_t k = 0; k < e->run_count; k++) {
        const ale_run_t *run = &e->run[k];
        count += !run->curved && !run->no_break && run->last + 1 - run->first >= fewest &&
                 ale_break_suspicious(ale_fit_of_run(e, &e->run[k]));
    }
    return count;
}

/* Fewest points of the runs that are tried for a break: of many only the longest. */
static int32_t fewest_to_split(ale_extractor_t *e)
{
    const int32_t most = ale_costly(e) ? MOST_TRIED / 3 : MOST_TRIED;
    const int32_t room = (int32_t)ale_min64(most, ALE_MANY_RUNS - e->run_count);
    int32_t fewest = MIN_SPLIT_POINTS;
    while (fewest <= e->count && suspicious_runs(e, fewest) > room) {
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
static int32_t points_beyond(const ale_extractor_t *e, int32_t k, bool at_first)
{
    int32_t i = at_first ? e->run[k].first : e->run[k].last;
    int32_t points = 0;
    while (points < ALE_MIN_RUN && (at_first ? i > 0 && !e->jump_after[i - 1] : !e->jump_after[i])) {
        i += at_first ? -1 : 1;
        points++;
    }
    const bool taken =
        at_first ? k > 0 && e->run[k - 1].last >= i : k + 1 < e->run_count && e->run[k + 1].first <= i;
    return points < ALE_MIN_RUN && !taken ? points : 0;
}

/* Takes in all of them, or the half: what would not be given up again. */
static void take_points_beyond(ale_extractor_t *e, int32_t k, bool at_first)
{
    ale_run_t *run = &e->run[k];
    for (int32_t points = points_beyond(e, k, at_first); points > 0; points /= 2) {
        const int32_t first = run->first - (at_first ? points : 0);
        const int32_t last = run->last + (at_first ? 0 : points);
        const ale_run_fit_t *fit = ale_fit_of_run(e, run);
        e->effort++;
        if (ale_moments_sse_q8(e, first, last) - fit->sse_q8 <= most_of_end_q8(fit, points)) {
            run->first = (uint16_t)first;
            run->last = (uint16_t)last;
            ale_run_changed(run);
            return;
        }
    }
}

/* Where the surface ends behind a break that was missed, the search has often left out the last points: they
 * did not lie on the line of both parts. Where neighbours share an error they are waves as well. */
static void split_run(ale_extractor_t *e, int32_t k, int32_t split)
{
    insert_run(e, k, split);
    if (e->shared_scale_q8 <= 256) {
        take_points_beyond(e, k, true);
        take_points_beyond(e, k + 1, false);
    }
}

bool ale_runs_split(ale_extractor_t *e)
{
    const int32_t fewest = fewest_to_split(e);
    const int32_t before = e->run_count;
    int32_t k = 0;
    while (k < e->run_count && e->run_count < ALE_MAX_RUNS) {
        ale_run_t *run = &e->run[k];
        if (!run->curved && !run->no_break && run->last + 1 - run->first >= fewest) {
            const int32_t split = ale_break_find(e, run, ale_reading_direction(e, run->first, run->last));
            run->no_break = true;
            if (split >= 0) {
                split_run(e, k, split);
                k++;
            }
        }
        k++;
    }
    return e->run_count > before;
}

/* How far the means of the points before and after a split are apart along a direction, over a window each;
 * in units of the direction's length, Q4 and the points of a window. */
static int64_t step_after(const ale_extractor_t *e, const ale_normal_line_t *line, int32_t window,
                          int32_t split)
{
    const ale_moments_t *before = &e->sum[split + 1 - window];
    const ale_moments_t *here = &e->sum[split + 1];
    const ale_moments_t *after = &e->sum[split + 1 + window];
    return ale_abs64(line->nx * (before->x - 2 * here->x + after->x) +
                     line->ny * (before->y - 2 * here->y + after->y));
}

/* The point after which the run has its sharpest step, if it is more than noise makes; or -1. A window is as
 * long as the shared error holds on: its waves are longer than a step. */
static int32_t find_step(const ale_extractor_t *e, ale_run_t *run)
{
    const int32_t window = e->config.noise.shared_beams;
    if (run->curved || run->last + 1 - run->first < STEP_WINDOWS * window) {
        return -1;
    }
    const ale_normal_line_t line = ale_moments_normal_line(e, run->first, run->last);
    const int32_t direction = ale_reading_direction(e, run->first, run->last);
    int32_t best = -1;
    int64_t most = 0;
    for (int32_t k = window - 1; k + window <= run->last - run->first; k++) {
        const int32_t split = direction > 0 ? run->first + k : run->last - 1 - k;
        const int64_t step = step_after(e, &line, window, split);
        if (step > most) {
            most = step;
            best = split;
        }
    }
    const ale_run_fit_t *fit = ale_fit_of_run(e, run);
    const int64_t length = (int64_t)ale_isqrt((uint64_t)(line.nx * line.nx + line.ny * line.ny));
    const int64_t step_q4 = most / ale_max64(length, 1);
    const int64_t var_q8 = 2 * fit->var_q8 / window + ((STEP_SHARED_Q8 * fit->shared_q8) >> 8);
    const int64_t limit_q8 =
        ((int64_t)STEP_DEVIATIONS_Q4 * STEP_DEVIATIONS_Q4 * var_q8 >> 8) * window * window;
    return step_q4 * step_q4 > limit_q8 ? best : -1;
}

bool ale_runs_split_at_steps(ale_extractor_t *e)
{
    const int32_t before = e->run_count;
    for (int32_t k = 0; k < e->run_count && e->run_count < ALE_MAX_RUNS; k++) {
        const int32_t split = find_step(e, &e->run[k]);
        if (split >= 0) {
            insert_run(e, k, split);
            k++;
        }
    }
    return e->run_count > before;
}

/* How many points to give up at one end: what they bring beyond what noise would is most. */
static int32_t points_to_trim(const ale_extractor_t *e, const ale_run_t *run, bool at_first)
{
    int32_t best = 0;
    int64_t most = 0;
    for (int32_t k = 1; k <= TRIM_MOST && 2 * k <= run->fit.n - e->config.min_points; k++) {
        const int32_t first = run->first + (at_first ? k : 0);
        const int32_t last = run->last - (at_first ? 0 : k);
        const int64_t gain =
            run->fit.sse_q8 - ale_moments_sse_q8(e, first, last) - most_of_end_q8(&run->fit, k);
        if (gain > most) {
            most = gain;
            best = k;
        }
    }
    return best;
}

void ale_run_trim(const ale_extractor_t *e, ale_run_t *run)
{
    if (ale_fit_chi_q8(ale_fit_of_run(e, run)) < (int64_t)(run->fit.n - 2) * TRIM_SUSPICIOUS_Q8) {
        return;
    }
    const int32_t at_first = points_to_trim(e, run, true);
    const int32_t at_last = points_to_trim(e, run, false);
    if (at_first + at_last > 0) {
        run->first = (uint16_t)(run->first + at_first);
        run->last = (uint16_t)(run->last - at_last);
        ale_run_changed(run);
    }
}

void ale_runs_search(ale_extractor_t *e)
{
    memset(e->refused, 0, sizeof e->refused); /* by a search that is done again nothing was */
    e->run_count = 0;
    e->search_fits = 0;
    for (int32_t k = 0; k < e->segment_count; k++) {
        search_segment(e, e->segment[k].first, e->segment[k].last);
    }
}

void ale_runs_forget_fits(ale_extractor_t *e)
{
    for (int32_t k = 0; k < e->run_count; k++) {
        ale_run_changed(&e->run[k]);
    }
}

/* Longer runs first, of equally long ones those nearer to the middle of the points: the same from either
 * side, and no more than two are alike. */
static int32_t rank_of(const ale_extractor_t *e, const ale_run_t *run)
{
    const int32_t points = run->last + 1 - run->first;
    return points * ALE_MAX_BEAMS - (int32_t)ale_abs64(run->first + run->last + 1 - e->count);
}

void ale_runs_drop_short(ale_extractor_t *e, int32_t fewest, int32_t enough)
{
    int32_t rank[ALE_MAX_RUNS];
    for (int32_t k = 0; k < e->run_count; k++) {
        rank[k] = rank_of(e, &e->run[k]);
    }
    int32_t least = (fewest - 1) * ALE_MAX_BEAMS + 1;         /* of runs with enough points */
    int32_t too_high = e->count / enough * ALE_MAX_BEAMS + 1; /* for enough runs to reach it */
    while (too_high - least > 1) {
        const int32_t middle = (least + too_high) / 2;
        int32_t reach_it = 0;
        for (int32_t k = 0; k < e->run_count; k++) {
            reach_it += rank[k] >= middle;
        }
        if (reach_it >= enough) {
            least = middle;
        } else {
            too_high = middle;
        }
    }
    int32_t kept = 0;
    for (int32_t k = 0; k < e->run_count; k++) {
        if (rank[k] >= least) {
            e->run[kept++] = e->run[k];
        } else {
            const int32_t points = e->run[k].last + 1 - e->run[k].first;
            e->refused[points < e->config.min_points ? ALE_REFUSED_FEW_POINTS : ALE_REFUSED_CAPACITY]++;
        }
    }
    e->run_count = (uint16_t)kept;
}
