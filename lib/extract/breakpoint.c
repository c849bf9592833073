#include "extract/breakpoint.h"
#include "extract/merge.h"

#include "base/fixed.h"
#include "extract/moments.h"

enum {
    COSTLY_REACH = 2, /* times the points accepted that a costly scan is tried for before the first refusal */
    SHARED_SHARE = 2, /* shared variances that a point may add in the mean, */
    SHARED_PEAK = 6,  /* and those that are in error together on top of it */
    SEARCH_FIT_EFFORT = 2,  /* in residual sums of runs: a fit has its variances, too, and is judged */
    JOINT_EFFORT = 2,       /* a place known to be no better counts, too */
    GRID = 9,               /* places at which a run is tried for a break */
    MEETING_UNIT = 1 << 20, /* so that the difference of two lines times a point fits int64 */
    MEETING_LOSS_Q8 =
        12 * 256,            /* own variances that a break where the lines meet may fit worse than the best */
    MOST_MEETINGS = 3,       /* times that lines which part where they met are asked where they meet */
    SUSPICIOUS_Q8 = 236,     /* chi square of a degree of freedom, */
    SUSPICIOUS_SUM_Q8 = 768, /* and in all, from which on a run is tried: less is no more than its noise */
    PROMISING_Q8 = 100       /* part of the gain wanted that a place of the grid must show */
};

/* A chi square beyond any bound of the model, three times which, times a bound, fits int64. */
static const int64_t MOST_CHI_Q8 = (int64_t)1 << 42;

/* Shared variances that n points of a true line may have, of which they have only one draw for every
 * 2 * shared_beams of them. */
static int64_t shared_times(const ale_run_list_t *r, int32_t n)
{
    const int64_t together = ale_min64(n, (int64_t)2 * r->scan.noise.shared_beams);
    return (int64_t)SHARED_SHARE * n + SHARED_PEAK * together;
}

/* Squared residuals that n points of a true line may have: chi square of the own noise and the shared error.
 */
static int64_t allowed_q8(const ale_run_list_t *r, const ale_run_fit_t *fit, int32_t n, int64_t chi_q8)
{
    return ((fit->var_q8 * chi_q8) >> 8) + fit->shared_q8 * shared_times(r, n);
}

/* Threshold of the search, as chi square of n points: it floats with the fit accepted last, between the
 * bounds that the noise model sets. */
static int64_t floating_chi_q8(const ale_run_list_t *r, const ale_run_fit_t *accepted, int32_t n)
{
    const int64_t expected_q8 = ale_max64((int64_t)2 * r->chi_high_q8[accepted->n], 1);
    const int64_t chi_q8 = ale_min64(ale_fit_chi_q8(accepted), MOST_CHI_Q8);
    const int64_t scaled_q8 = chi_q8 * 3 * r->chi_high_q8[n] / expected_q8;
    return ale_clamp64(scaled_q8, r->chi_low_q8[n], r->chi_high_q8[n]);
}

/* Step 5 of the paper's listing: the rate of increase of the error, which is the error per point added since
 * the fit accepted last, is no more than noise makes it, and its value is below its threshold, which is not
 * asked for where it is below the lower bound of that. */
static bool acceptable(const ale_run_list_t *r, const ale_run_fit_t *fit, const ale_run_fit_t *accepted)
{
    const int32_t added = fit->n - accepted->n + 2;
    return fit->sse_q8 - accepted->sse_q8 <= allowed_q8(r, fit, added, r->chi_high_q8[added]) &&
           (fit->sse_q8 <= allowed_q8(r, fit, fit->n, r->chi_low_q8[fit->n]) ||
            fit->sse_q8 <= allowed_q8(r, fit, fit->n, floating_chi_q8(r, accepted, fit->n)));
}

static void count_fits(ale_run_list_t *r, int32_t fits)
{
    r->search_fits += fits;
    r->effort += fits * SEARCH_FIT_EFFORT;
}

/* The fit of the line from a point on to the one so many points behind it. */
static inline ale_run_fit_t fit_towards(const ale_run_list_t *r, int32_t from, int32_t direction,
                                        int32_t points)
{
    return ale_run_fit(&r->scan, direction > 0 ? from : from - points, direction > 0 ? from + points : from);
}

/* How many points behind `from` the line that begins there goes on, by binary search between the least,
 * of which the fit is *accepted, and one beyond it; *accepted becomes that of the last one. */
static int32_t widen(ale_run_list_t *r, int32_t from, int32_t direction, int32_t least, int32_t beyond,
                     ale_run_fit_t *accepted)
{
    ale_run_fit_t best = *accepted;
    int32_t low = least;
    int32_t high = beyond;
    bool bracketed = !ale_costly(r);
    int32_t fits = 0;
    while (high - low > 1) {
        const int32_t half = (low + high) / 2;
        const int32_t p = bracketed ? half : (int32_t)ale_min64(half, (int64_t)COSTLY_REACH * low);
        const ale_run_fit_t fit = fit_towards(r, from, direction, p);
        fits++;
        if (acceptable(r, &fit, &best)) {
            low = p;
            best = fit;
        } else {
            bracketed = true;
            high = p;
        }
    }
    count_fits(r, fits);
    *accepted = best;
    return low;
}

int32_t ale_break_search(ale_run_list_t *r, int32_t from, int32_t to, ale_run_fit_t *accepted)
{
    const int32_t direction = to >= from ? 1 : -1;
    const int32_t high = (to - from) * direction + 1;
    const int32_t low = (ale_costly(r) ? ALE_COSTLY_RUN : ALE_MIN_RUN) - 1;
    if (low >= high) {
        return from;
    }
    *accepted = fit_towards(r, from, direction, low);
    count_fits(r, 1);
    if (accepted->sse_q8 > allowed_q8(r, accepted, accepted->n, r->chi_high_q8[accepted->n])) {
        return from;
    }
    return from + direction * widen(r, from, direction, low, high, accepted);
}

/* Two runs, which are the points of both, each with its own variance. */
typedef struct {
    ale_segment_t both;
    int64_t var_a_q8;
    int64_t var_b_q8;
} pair_t;

/* Squared residuals of the line before a break, and of that behind it, in its own variance; Q8. */
static inline int64_t chi_before_q8(const ale_run_list_t *r, const pair_t *pair, int32_t split)
{
    return (ale_moments_sse_q8(&r->scan, pair->both.first, split) << 8) / pair->var_a_q8;
}

static inline int64_t chi_behind_q8(const ale_run_list_t *r, const pair_t *pair, int32_t split)
{
    return (ale_moments_sse_q8(&r->scan, split + 1, pair->both.last) << 8) / pair->var_b_q8;
}

/* Both together, unless one alone has `enough`: the line comes first that has taken points of the other since
 * the break was at `centre`. */
static inline int64_t joint_chi_q8(const ale_run_list_t *r, const pair_t *pair, int32_t split, int32_t centre,
                                   int64_t enough_q8)
{
    if (split > centre) {
        const int64_t before_q8 = chi_before_q8(r, pair, split);
        return before_q8 >= enough_q8 ? before_q8 : before_q8 + chi_behind_q8(r, pair, split);
    }
    const int64_t behind_q8 = chi_behind_q8(r, pair, split);
    return behind_q8 >= enough_q8 ? behind_q8 : behind_q8 + chi_before_q8(r, pair, split);
}

/* The break where the lines through both runs meet: the one is nearer before it, the other beyond it. -1 when
 * they do not meet within the range. */
static int32_t meeting_point(const ale_run_list_t *r, const pair_t *pair, int32_t split,
                             const ale_break_range_t *range)
{
    const ale_normal_line_t a = ale_moments_normal_line(&r->scan, pair->both.first, split);
    const ale_normal_line_t b = ale_moments_normal_line(&r->scan, split + 1, pair->both.last);
    /* a is nearer where this times the point is negative */
    const int64_t wx = (a.rho * b.nx - b.rho * a.nx) / MEETING_UNIT;
    const int64_t wy = (a.rho * b.ny - b.rho * a.ny) / MEETING_UNIT;
    int32_t low = range->lowest;
    int32_t high = range->highest + 1;
    const bool a_first = r->scan.points.x_q4[low] * wx + r->scan.points.y_q4[low] * wy < 0;
    if (a_first == (r->scan.points.x_q4[high] * wx + r->scan.points.y_q4[high] * wy < 0)) {
        return -1;
    }
    while (high - low > 1) {
        const int32_t middle = (low + high) / 2;
        if (a_first == (r->scan.points.x_q4[middle] * wx + r->scan.points.y_q4[middle] * wy < 0)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* A place, how good it is, and the place last found to be no better on the side read before and after it. */
typedef struct {
    int32_t split;
    int64_t chi_q8;
    int32_t refused[2];
} placing_t;

/* The meeting point of the lines that part at a place is known better than the least joint chi square, which
 * is nearly the same over many points where a wall bends a little. It is taken unless it fits worse. Whether
 * the break has moved so far that the lines are others now. */
static bool move_to_meeting(ale_run_list_t *r, const pair_t *pair, const ale_break_range_t *range,
                            placing_t *best)
{
    const int32_t meeting = meeting_point(r, pair, best->split, range);
    const int64_t most_q8 = best->chi_q8 + MEETING_LOSS_Q8;
    if (meeting < 0 || meeting == best->split) {
        return false;
    }
    r->effort += JOINT_EFFORT;
    if (joint_chi_q8(r, pair, meeting, best->split, most_q8 + 1) > most_q8) {
        return false;
    }
    const bool moved_far = ale_abs64(meeting - best->split) > 1;
    best->split = meeting;
    return moved_far;
}

/* One step of the pattern search: the better of both sides, or false. */
static bool better_side(ale_run_list_t *r, const pair_t *pair, const ale_break_range_t *range, int32_t step,
                        int32_t came_from, placing_t *best)
{
    const int32_t centre = best->split;
    const int32_t ahead = step * range->direction;
    for (int32_t side = 0; side < 2; side++) {
        const int32_t k = side == 0 ? centre - ahead : centre + ahead;
        if (k < range->lowest || k > range->highest || k == came_from) {
            continue;
        }
        r->effort += JOINT_EFFORT;
        if (k == best->refused[side]) {
            continue;
        }
        const int64_t chi_q8 = joint_chi_q8(r, pair, k, centre, best->chi_q8);
        if (chi_q8 < best->chi_q8) {
            best->split = k;
            best->chi_q8 = chi_q8;
        } else {
            best->refused[side] = k;
        }
    }
    return best->split != centre;
}

int32_t ale_break_place(ale_run_list_t *r, ale_segment_t both, const ale_run_fit_t *a, const ale_run_fit_t *b,
                        const ale_break_range_t *range)
{
    if (range->lowest > range->highest) {
        return range->start;
    }
    const pair_t pair = {both, a->var_q8, b->var_q8};
    placing_t best = {(int32_t)ale_clamp64(range->start, range->lowest, range->highest), 0, {-1, -1}};
    r->effort += JOINT_EFFORT;
    if (a->n == best.split + 1 - both.first && b->n == both.last - best.split) {
        best.chi_q8 = ale_fit_chi_q8(a) + ale_fit_chi_q8(b); /* known: they part there */
    } else {
        best.chi_q8 = joint_chi_q8(r, &pair, best.split, best.split, INT64_MAX);
    }
    int32_t came_from = -1;
    for (int32_t step = range->widest_step; step > 0; step /= 2) {
        for (int32_t tries = 0; tries < 4; tries++) {
            const int32_t centre = best.split;
            if (!better_side(r, &pair, range, step, came_from, &best)) {
                break;
            }
            came_from = centre;
        }
    }
    bool moved = true;
    for (int32_t k = 0; moved && k < MOST_MEETINGS; k++) {
        moved = move_to_meeting(r, &pair, range, &best);
    }
    return best.split;
}

/* Squared residuals of the two lines that part after split, unless that of more points alone has `enough`. */
static inline int64_t joint_sse_q8(const ale_run_list_t *r, ale_segment_t run, int32_t split,
                                   bool before_is_longer, int64_t enough_q8)
{
    const ale_segment_t before = {run.first, (uint16_t)split};
    const ale_segment_t behind = {(uint16_t)(split + 1), run.last};
    const ale_segment_t longer = before_is_longer ? before : behind;
    const ale_segment_t shorter = before_is_longer ? behind : before;
    const int64_t sse_q8 = ale_moments_sse_q8(&r->scan, longer.first, longer.last);
    return sse_q8 >= enough_q8 ? sse_q8 : sse_q8 + ale_moments_sse_q8(&r->scan, shorter.first, shorter.last);
}

/* The break after which the joint fit is best, of the places of a grid that is the same in both directions.
 * *sse_q8: squared residuals of the two lines; before the call, what they must be less than. -1: at none they
 * are, or the run has no room for two. */
static inline int32_t coarse_break(ale_run_list_t *r, ale_segment_t run, int32_t direction, int64_t *sse_q8)
{
    const int32_t n = run.last + 1 - run.first;
    int32_t best = -1;
    for (int32_t j = 1; j < GRID; j++) {
        const bool near_is_shorter = 2 * j < GRID;
        const int32_t shorter = n * (near_is_shorter ? j : GRID - j) / GRID;
        if (shorter < ALE_MIN_RUN) {
            continue;
        }
        const bool before_is_longer = near_is_shorter != (direction > 0);
        const int32_t split = before_is_longer ? run.last - shorter : run.first + shorter - 1;
        r->effort += JOINT_EFFORT;
        const int64_t sse = joint_sse_q8(r, run, split, before_is_longer, *sse_q8);
        if (sse < *sse_q8) {
            *sse_q8 = sse;
            best = split;
        }
    }
    return best;
}

int64_t ale_break_gain_q8(ale_run_list_t *r, ale_run_t *run)
{
    const ale_run_fit_t *one = ale_fit_of_run(&r->scan, run);
    int64_t sse_q8 = INT64_MAX;
    const ale_segment_t both = {run->first, run->last};
    const int32_t split =
        coarse_break(r, both, ale_points_reading_direction(&r->scan.points, run->first, run->last), &sse_q8);
    return split < 0 ? 0 : (sse_q8 - one->sse_q8) * 256 / one->var_q8;
}

/* A run as two, split after a point. */
typedef struct {
    ale_run_fit_t a;
    ale_run_fit_t b;
    int64_t ratio_q8;
} parting_t;

static parting_t part_at(const ale_run_list_t *r, const ale_run_t *run, int32_t split)
{
    parting_t p = {ale_moments_fit(&r->scan, run->first, split),
                   ale_moments_fit(&r->scan, split + 1, run->last), 0};
    p.ratio_q8 =
        ale_merge_ratio_q8(&r->scan.noise, &run->fit, &p.a, &p.b, !r->scan.segments.jump_after[split]);
    return p;
}

bool ale_break_suspicious(const ale_run_fit_t *one)
{
    return ale_fit_chi_q8(one) >= (int64_t)(one->n - 2) * SUSPICIOUS_Q8 + SUSPICIOUS_SUM_Q8;
}

int32_t ale_break_find(ale_run_list_t *r, ale_run_t *run, int32_t direction)
{
    const ale_run_fit_t *one = ale_fit_of_run(&r->scan, run);
    if (!ale_break_suspicious(one)) {
        return -1;
    }
    const ale_segment_t both = {run->first, run->last};
    /* whatever their own noise is, two lines that gain no more show nothing */
    const int64_t less_q8 = (ale_merge_gain_q8(&r->scan.noise, one, false) * PROMISING_Q8 - 1) / 256;
    int64_t sse_q8 = one->sse_q8 - less_q8;
    const int32_t coarse = coarse_break(r, both, direction, &sse_q8);
    if (coarse < 0) {
        return -1;
    }
    const parting_t p = part_at(r, run, coarse);
    if (p.ratio_q8 < PROMISING_Q8) {
        return -1;
    }
    const ale_break_range_t range = {run->first + ALE_MIN_RUN - 1, run->last - ALE_MIN_RUN, coarse, direction,
                                     ALE_BREAK_WIDE_STEP};
    const int32_t split = ale_break_place(r, both, &p.a, &p.b, &range);
    const int64_t ratio_q8 = split == coarse ? p.ratio_q8 : part_at(r, run, split).ratio_q8;
    return ratio_q8 >= 256 ? split : -1;
}
