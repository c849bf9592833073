#include "extract/merge.h"

#include "base/fixed.h"
#include "extract/moments.h"
#include "extract/segment.h"

enum { PENALTY = 19, SHARED_PEAK = 3, MAX_GAP_POINTS = 8 };

/* A step h amid n points: two lines gain n h^2 / 16 over one, which is turned by 3 h / (2 length), as by
 * three times that gain in a point. Its mean is taken to be off by h / 4: once that gain. */
enum {
    SHALLOW_MM = 50, /* less is no step: what surfaces have, or a door in its frame */
    DEEP_MM = 200,   /* deviation where none could show: cabinets and recesses are up to 0.45 m deep */
    GAIN_Q8 = 256 / 16,
    SLOPE_GAINS = 3
};

int64_t ale_merge_gain_q8(const ale_scan_noise_t *noise, const ale_run_fit_t *one, bool on_one_surface)
{
    const int64_t together =
        on_one_surface ? SHARED_PEAK * ale_min64(one->n, (int64_t)2 * noise->shared_beams) : 0;
    return PENALTY * one->var_q8 + one->shared_q8 * (one->n + together);
}

int64_t ale_merge_ratio_q8(const ale_scan_noise_t *noise, const ale_run_fit_t *one, const ale_run_fit_t *a,
                           const ale_run_fit_t *b, bool on_one_surface)
{
    const int64_t n = ale_max64(a->n + b->n, 1);
    ale_run_fit_t either = *one;
    either.var_q8 = ale_max64(one->var_q8, (a->var_q8 * a->n + b->var_q8 * b->n) / n);
    either.shared_q8 = ale_max64(one->shared_q8, (a->shared_q8 * a->n + b->shared_q8 * b->n) / n);
    const int64_t gain = one->sse_q8 - a->sse_q8 - b->sse_q8;
    return gain * 256 / ale_merge_gain_q8(noise, &either, on_one_surface);
}

/* The ratio of the runs k and k + 1; the largest number where they may not be joined. */
static inline int64_t ratio_at(ale_run_list_t *r, int32_t k)
{
    ale_run_t *a = &r->run[k];
    ale_run_t *b = &r->run[k + 1];
    if (a->curved || b->curved || b->first - a->last > MAX_GAP_POINTS ||
        r->scan.points.beam[b->first] - r->scan.points.beam[a->last] > ALE_MAX_GAP_BEAMS) {
        return INT64_MAX;
    }
    const ale_run_fit_t one = ale_moments_fit(&r->scan, a->first, b->last);
    return ale_merge_ratio_q8(&r->scan.noise, &one, ale_fit_of_run(&r->scan, a), ale_fit_of_run(&r->scan, b),
                              ale_segment_joins(&r->scan.segments, a->last, b->first));
}

static void join_with_next(ale_run_list_t *r, int32_t k)
{
    r->run[k].last = r->run[k + 1].last;
    ale_run_changed(&r->run[k]);
    for (int32_t i = k + 1; i + 1 < r->count; i++) {
        const ale_run_t next = r->run[i + 1];
        r->run[i] = next;
    }
    r->count--;
}

bool ale_merge_runs(ale_run_list_t *r)
{
    const int32_t before = r->count;
    for (int32_t k = 0; k + 1 < r->count; k++) {
        r->run[k].join_q8 = ratio_at(r, k);
    }
    while (r->count > 1) {
        int32_t best = 0;
        for (int32_t k = 1; k + 1 < r->count; k++) {
            best = r->run[k].join_q8 < r->run[best].join_q8 ? k : best;
        }
        if (r->run[best].join_q8 >= 256) {
            break;
        }
        join_with_next(r, best);
        for (int32_t k = best > 0 ? best - 1 : 0; k <= best && k + 1 < r->count; k++) {
            r->run[k].join_q8 = ratio_at(r, k);
        }
    }
    return r->count < before;
}

ale_merge_doubt_t ale_merge_doubt(const ale_scan_noise_t *noise, const ale_spread_t *m)
{
    const int64_t most_var_q8 = (int64_t)1 << 32; /* (4 m)^2 */
    const int64_t n = m->fit.n;
    ale_merge_doubt_t doubt = {.var_q8 = m->fit.var_q8};
    if (noise->own_square_q60 > 0) {
        const int64_t mse_q8 = m->fit.sse_q8 / ale_max64(n - 2, 1);
        doubt.var_q8 = ale_max64(doubt.var_q8, ale_min64(mse_q8, most_var_q8));
        const int64_t hidden_q8 = PENALTY * ale_min64(doubt.var_q8, most_var_q8);
        const int64_t shallow_q8 = n * SHALLOW_MM * SHALLOW_MM * GAIN_Q8;
        const int64_t deep_q8 = n * DEEP_MM * DEEP_MM * GAIN_Q8;
        doubt.mean_q8 = ale_min64(ale_clamp64(hidden_q8 - shallow_q8, 0, deep_q8), m->along2_q8 / 4);
        doubt.slope_q8 = SLOPE_GAINS * doubt.mean_q8;
    }
    return doubt;
}
