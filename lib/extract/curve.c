#include "extract/curve.h"

#include "base/fixed.h"
#include "extract/breakpoint.h"
#include "extract/circle.h"
#include "extract/moments.h"
#include "extract/segment.h"

enum {
    MIN_POINTS = 6,
    MAX_GAP_POINTS = 6,
    SINGLE_Q8 = 3 * 256, /* deviations of the bulge from which one run is suspect, */
    MOST_SUSPECTS = 12,  /* and of so many suspects the strongest are tried */
    CHAIN_STEP_Q8 = 128, /* deviations that every run of a chain must bring, */
    CHAIN_SUM_Q8 = 0,    /* and the chain beyond that */
    CHAIN_ALLOWANCE_Q8 =
        20 * 256,         /* chi square that a circle may lose for each line beyond two it replaces */
    CIRCLE_EFFORT_Q2 = 3, /* of a point laid on a circle, in residual sums of runs */
    SHARED_PART_Q8 = 154  /* share of the shared variance that a bulge contains */
};

typedef struct {
    int64_t x_q4; /* from first to last third */
    int64_t y_q4;
    int64_t bulge_q8; /* of the middle to the left of that direction, in deviations */
    int64_t chain_q8; /* strength of the chain that it has gone to, 0: of none */
} shape_t;

typedef struct {
    int64_t x_q8;
    int64_t y_q8;
} mean_t;

static inline mean_t mean_of(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const mean_t mean = {(scan->sum[last + 1].x - scan->sum[first].x) * 16 / n,
                         (scan->sum[last + 1].y - scan->sum[first].y) * 16 / n};
    return mean;
}

static shape_t shape_of(const ale_run_list_t *r, ale_run_t *run)
{
    const int32_t n = run->last + 1 - run->first;
    const int32_t third = n / 3;
    const mean_t a = mean_of(&r->scan, run->first, run->first + third - 1);
    const mean_t m = mean_of(&r->scan, run->first + third, run->last - third);
    const mean_t b = mean_of(&r->scan, run->last - third + 1, run->last);
    const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, run);
    const int64_t dx = (b.x_q8 - a.x_q8) / 16;
    const int64_t dy = (b.y_q8 - a.y_q8) / 16;
    /* about the mean of both ends: the same from either side */
    const int64_t twice_cross_q12 = dx * (2 * m.y_q8 - a.y_q8 - b.y_q8) - dy * (2 * m.x_q8 - a.x_q8 - b.x_q8);
    const int64_t var_q8 = fit->var_q8 / (n - (int64_t)2 * third) + fit->var_q8 / ((int64_t)2 * third) +
                           ((fit->shared_q8 * SHARED_PART_Q8) >> 8);
    const int64_t length2_mm2 = (dx * dx + dy * dy) >> (2 * ALE_POINT_SHIFT);
    /* metres of a shared error along 100 m are beyond int64: held at what fits, they are many deviations
     * still */
    const int64_t sigma2_length2_q8 = ale_mul_shift(ale_max64(var_q8, 1), length2_mm2, 0);
    const int64_t sigma_length_q4 = ale_max64(ale_isqrt((uint64_t)sigma2_length2_q8), 1);
    const shape_t shape = {dx, dy, twice_cross_q12 / (2 * sigma_length_q4), 0};
    return shape;
}

static bool adjoin(const ale_run_list_t *r, const ale_run_t *a, const ale_run_t *b)
{
    return b->first - a->last <= MAX_GAP_POINTS && ale_segment_joins(&r->scan.segments, a->last, b->first);
}

/* Sign of the turn from a to b when it is one of a chain of chords: 3 to 50 degrees; else 0. */
static int32_t turn_between(const shape_t *a, const shape_t *b)
{
    const int64_t cross = a->x_q4 * b->y_q4 - a->y_q4 * b->x_q4;
    const int64_t dot = a->x_q4 * b->x_q4 + a->y_q4 * b->y_q4;
    if (ale_abs64(cross) * 5 > dot * 6 || ale_abs64(cross) * 19 <= dot) {
        return 0;
    }
    return cross > 0 ? 1 : -1;
}

/* Chi square of the points of the runs first..last about a circle, minus that about their own lines, Q8; of
 * what is more than `most`, only that it is: of the runs to come, the circle can but explain all. */
static int64_t circle_excess_q8(ale_run_list_t *r, int32_t first, int32_t last, int64_t most_q8)
{
    const ale_circle_t circle = ale_circle_fit(&r->scan, r->run[first].first, r->run[last].last);
    r->effort += (r->run[last].last + 1 - r->run[first].first) * CIRCLE_EFFORT_Q2 / 4;
    if (circle.radius_q4 == 0) {
        return INT64_MAX;
    }
    int64_t rest_q8 = 0; /* that their lines have at most, of the runs to come */
    for (int32_t k = first; k <= last; k++) {
        rest_q8 += ale_fit_chi_q8(ale_fit_of_run(&r->scan, &r->run[k])) + 1;
    }
    int64_t excess = 0;
    for (int32_t k = first; k <= last && excess - rest_q8 <= most_q8; k++) {
        const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, &r->run[k]);
        const int64_t sse = ale_circle_sse_q8(&r->scan, &circle, r->run[k].first, r->run[k].last);
        excess += (sse - fit->sse_q8) * 256 / fit->var_q8;
        rest_q8 -= ale_fit_chi_q8(fit) + 1;
    }
    return excess - rest_q8;
}

static bool chain_is_curve(ale_run_list_t *r, int32_t first, int32_t last)
{
    const int64_t most_q8 = (int64_t)CHAIN_ALLOWANCE_Q8 * (last - first - 1);
    return circle_excess_q8(r, first, last, most_q8) <= most_q8;
}

/* One run: curved when a circle explains it better than its two best lines. */
static bool run_is_curve(ale_run_list_t *r, int32_t k)
{
    const int64_t circle = circle_excess_q8(r, k, k, INT64_MAX);
    r->run[k].no_arc = circle >= 0 || circle >= ale_break_gain_q8(r, &r->run[k]);
    return !r->run[k].no_arc;
}

static bool is_suspect(const ale_run_t *run, const shape_t *shape, int64_t limit_q8)
{
    return !run->curved && !run->no_arc && ale_abs64(shape->bulge_q8) > limit_q8;
}

/* The bulge beyond which single runs are tried. */
static int64_t suspect_bulge_q8(const ale_run_list_t *r, const shape_t *shape, int32_t most)
{
    int64_t limit_q8 = SINGLE_Q8;
    int32_t suspects;
    do {
        suspects = 0;
        for (int32_t k = 0; k < r->count; k++) {
            suspects += is_suspect(&r->run[k], &shape[k], limit_q8);
        }
        limit_q8 *= suspects > most ? 2 : 1;
    } while (suspects > most);
    return limit_q8;
}

/* Part of a chain, and how much its bulges say together, in deviations. */
typedef struct {
    int32_t first;
    int32_t last; /* no farther than first: none */
    int64_t strength_q8;
} stretch_t;

/* The stretch of two runs or more of the chain first..last, turning by sign, whose bulges say most. */
static stretch_t strongest_stretch(const shape_t *shape, int32_t first, int32_t last, int32_t sign)
{
    stretch_t best = {first, first, CHAIN_SUM_Q8};
    for (int32_t from = first; from < last; from++) {
        int64_t sum = -sign * shape[from].bulge_q8 - CHAIN_STEP_Q8;
        for (int32_t to = from + 1; to <= last; to++) {
            sum += -sign * shape[to].bulge_q8 - CHAIN_STEP_Q8;
            if (sum > best.strength_q8) {
                best = (stretch_t){from, to, sum};
            }
        }
    }
    return best;
}

/* The last chord of a curve is often too short to bulge: it belongs to the curve if the circle holds with it.
 */
static void widen_stretch(ale_run_list_t *r, int32_t first, int32_t last, stretch_t *stretch)
{
    if (stretch->last < last && chain_is_curve(r, stretch->first, stretch->last + 1)) {
        stretch->last++;
    }
    if (stretch->first > first && chain_is_curve(r, stretch->first - 1, stretch->last)) {
        stretch->first--;
    }
}

static int32_t chain_end(const ale_run_list_t *r, const shape_t *shape, int32_t first, int32_t *sign)
{
    int32_t last = first;
    *sign = 0;
    while (last + 1 < r->count && !r->run[last].curved && !r->run[last + 1].curved &&
           adjoin(r, &r->run[last], &r->run[last + 1])) {
        const int32_t turn = turn_between(&shape[last], &shape[last + 1]);
        if (turn == 0 || (*sign != 0 && turn != *sign)) {
            break;
        }
        *sign = turn;
        last++;
    }
    return last;
}

/* Where two chains share a run it goes to the stronger one, whichever is found first. */
static void mark_chain(const stretch_t *stretch, uint8_t curve, uint8_t *curve_of, shape_t *shape)
{
    for (int32_t k = stretch->first; k <= stretch->last; k++) {
        if (stretch->strength_q8 > shape[k].chain_q8) {
            shape[k].chain_q8 = stretch->strength_q8;
            curve_of[k] = curve;
        }
    }
}

static void join_marked(ale_run_list_t *r, uint8_t curves, const uint8_t *curve_of)
{
    if (curves == 0) {
        return;
    }
    int32_t kept = 0;
    for (int32_t k = 0; k < r->count; k++) {
        ale_run_t run = r->run[k];
        const uint8_t id = curve_of[k];
        while (id != 0 && k + 1 < r->count && curve_of[k + 1] == id) {
            run.last = r->run[++k].last;
            ale_run_changed(&run);
        }
        run.curved = run.curved || id != 0;
        r->run[kept++] = run;
    }
    r->count = (uint16_t)kept;
}

/* Whether the runs are those that were asked for curves before, and had none. */
static bool known_to_be_lines(const ale_run_list_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        if (!r->run[k].no_curve) {
            return false;
        }
    }
    return true;
}

/* Marks the suspects that are curves alone, and says how many they are. */
static uint8_t mark_arcs(ale_run_list_t *r, const shape_t *shape, int64_t limit_q8, uint8_t *curve_of)
{
    uint8_t curves = 0;
    for (int32_t k = 0; k < r->count; k++) {
        curve_of[k] = is_suspect(&r->run[k], &shape[k], limit_q8) && run_is_curve(r, k) ? ++curves : 0;
    }
    return curves;
}

/* The same of chains, given how many arcs there are. */
static uint8_t mark_chains(ale_run_list_t *r, shape_t *shape, uint8_t arcs, uint8_t *curve_of)
{
    uint8_t curves = arcs;
    for (int32_t first = 0; first < r->count;) {
        int32_t sign;
        const int32_t last = chain_end(r, shape, first, &sign);
        stretch_t stretch = strongest_stretch(shape, first, last, sign);
        if (stretch.first < stretch.last && chain_is_curve(r, stretch.first, stretch.last)) {
            widen_stretch(r, first, last, &stretch);
            mark_chain(&stretch, ++curves, curve_of, shape);
        }
        first = last > first ? last : first + 1;
    }
    return curves;
}

void ale_curve_find(ale_run_list_t *r, bool again)
{
    if (again && known_to_be_lines(r)) {
        return;
    }
    shape_t shape[ALE_MAX_RUNS];
    uint8_t curve_of[ALE_MAX_RUNS];
    for (int32_t k = 0; k < r->count; k++) {
        const bool enough = r->run[k].last - r->run[k].first + 1 >= MIN_POINTS;
        shape[k] = enough ? shape_of(r, &r->run[k]) : (shape_t){0};
    }
    const int32_t most = again || ale_costly(r) ? MOST_SUSPECTS / 3 : MOST_SUSPECTS;
    const int64_t limit_q8 = suspect_bulge_q8(r, shape, most);
    const uint8_t arcs = mark_arcs(r, shape, limit_q8, curve_of);
    const uint8_t curves = mark_chains(r, shape, arcs, curve_of);
    for (int32_t k = 0; k < r->count; k++) {
        r->run[k].no_curve = curves == 0 && limit_q8 == SINGLE_Q8; /* beyond it not all suspects were tried */
    }
    join_marked(r, curves, curve_of);
}

void ale_curve_fit(const ale_prepared_scan_t *scan, ale_segment_t run, ale_curve_t *curve)
{
    const ale_circle_t circle = ale_circle_fit(scan, run.first, run.last);
    curve->first = ale_points_beam(&scan->points, run.first);
    curve->last = ale_points_beam(&scan->points, run.last);
    curve->centre.x_um = (int32_t)ale_round_shift(circle.x_q4 * 1000, ALE_POINT_SHIFT);
    curve->centre.y_um = (int32_t)ale_round_shift(circle.y_q4 * 1000, ALE_POINT_SHIFT);
    curve->radius_um = (int32_t)ale_round_shift(circle.radius_q4 * 1000, ALE_POINT_SHIFT);
}
