#include "extract/curve.h"

#include "base/fixed.h"
#include "extract/moments.h"

enum {
    MIN_POINTS = 6,
    SINGLE_Q8 = 3 * 256 + 128, /* deviations of the bulge by which one run is curved */
    CHAIN_STEP_Q8 = 256,       /* what every run of a chain must bring, and the chain together */
    CHAIN_SUM_Q8 = 384,
    MAX_GAP_POINTS = 6,
    SHARED_PART_Q8 = 154 /* share of the shared variance that a bulge contains */
};

typedef struct {
    int64_t x_q4; /* from first to last third */
    int64_t y_q4;
    int64_t bulge_q8; /* of the middle to the left of that direction, in deviations */
} shape_t;

typedef struct {
    int64_t x_q8;
    int64_t y_q8;
} mean_t;

static mean_t mean_of(const ale_extractor_t *e, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const mean_t mean = {ale_round_div((e->sum[last + 1].x - e->sum[first].x) * 16, n),
                         ale_round_div((e->sum[last + 1].y - e->sum[first].y) * 16, n)};
    return mean;
}

static shape_t shape_of(const ale_extractor_t *e, ale_run_t run)
{
    const int32_t n = run.last + 1 - run.first;
    const int32_t third = n / 3;
    const mean_t a = mean_of(e, run.first, run.first + third - 1);
    const mean_t m = mean_of(e, run.first + third, run.last - third);
    const mean_t b = mean_of(e, run.last - third + 1, run.last);
    const ale_fit_t fit = ale_moments_fit(e, run.first, run.last);
    const int64_t dx = (b.x_q8 - a.x_q8) / 16;
    const int64_t dy = (b.y_q8 - a.y_q8) / 16;
    const int64_t length_q4 = ale_max64(ale_isqrt((uint64_t)(dx * dx + dy * dy)), 1);
    const int64_t bulge_q8 = (dx * (m.y_q8 - a.y_q8) - dy * (m.x_q8 - a.x_q8)) / length_q4; /* mm Q8 */
    const int64_t var_q8 =
        fit.var_q8 / (n - 2 * third) + fit.var_q8 / (2 * third) + ((fit.shared_q8 * SHARED_PART_Q8) >> 8);
    const int64_t sigma_q8 = ale_max64(ale_isqrt((uint64_t)var_q8 << 8), 1);
    const shape_t shape = {dx, dy, (bulge_q8 << 8) / sigma_q8};
    return shape;
}

/* Sign of the turn from a to b when it is one of a chain of chords: 3 to 50 degrees; else 0. */
static int32_t turn_between(const ale_extractor_t *e, const shape_t *a, const shape_t *b, ale_run_t run_a,
                            ale_run_t run_b)
{
    if (run_b.first - run_a.last > MAX_GAP_POINTS ||
        e->segment_of[run_a.last] != e->segment_of[run_b.first]) {
        return 0;
    }
    const int64_t cross = a->x_q4 * b->y_q4 - a->y_q4 * b->x_q4;
    const int64_t dot = a->x_q4 * b->x_q4 + a->y_q4 * b->y_q4;
    if (ale_abs64(cross) * 5 > dot * 6 || ale_abs64(cross) * 19 < dot) {
        return 0;
    }
    return cross > 0 ? 1 : -1;
}

/* Marks the stretch of the chain first..last (turning by sign) whose bulges together say most. */
static void mark_chain(const shape_t *shape, int32_t first, int32_t last, int32_t sign, bool *curved)
{
    int64_t sum = 0;
    int64_t best = 0;
    int32_t from = first;
    int32_t best_from = 0;
    int32_t best_to = -1;
    for (int32_t k = first; k <= last; k++) {
        sum += -sign * shape[k].bulge_q8 - CHAIN_STEP_Q8;
        if (sum > best && k > from) {
            best = sum;
            best_from = from;
            best_to = k;
        }
        if (sum < 0) {
            sum = 0;
            from = k + 1;
        }
    }
    for (int32_t k = best_from; best > CHAIN_SUM_Q8 && k <= best_to; k++) {
        curved[k] = true;
    }
}

void ale_curve_mark(const ale_extractor_t *e, bool curved[ALE_MAX_RUNS])
{
    shape_t shape[ALE_MAX_RUNS];
    for (int32_t k = 0; k < e->run_count; k++) {
        const bool enough = e->run[k].last - e->run[k].first + 1 >= MIN_POINTS;
        shape[k] = enough ? shape_of(e, e->run[k]) : (shape_t){0};
        curved[k] = ale_abs64(shape[k].bulge_q8) > SINGLE_Q8;
    }
    int32_t first = 0;
    int32_t sign = 0;
    for (int32_t k = 0; k < e->run_count; k++) {
        const int32_t turn =
            k + 1 < e->run_count ? turn_between(e, &shape[k], &shape[k + 1], e->run[k], e->run[k + 1]) : 0;
        if (sign != 0 && turn != sign) {
            mark_chain(shape, first, k, sign, curved);
        }
        if (turn != sign) {
            first = k;
        }
        sign = turn;
    }
}
