#include "extract/merge.h"

#include "base/fixed.h"
#include "extract/moments.h"
#include "extract/segment.h"

enum { PENALTY = 20, SHARED_PEAK = 3, MAX_GAP_BEAMS = 8, MAX_GAP_POINTS = 4 };

int64_t ale_merge_ratio_q8(const ale_extractor_t *e, ale_run_t a, ale_run_t b)
{
    const ale_fit_t one = ale_moments_fit(e, a.first, b.last);
    const ale_fit_t fit_a = ale_moments_fit(e, a.first, a.last);
    const ale_fit_t fit_b = ale_moments_fit(e, b.first, b.last);
    const int64_t var =
        ale_max64(one.var_q8, (fit_a.var_q8 * fit_a.n + fit_b.var_q8 * fit_b.n) / (fit_a.n + fit_b.n));
    const int64_t shared = ale_max64(one.shared_q8, (fit_a.shared_q8 * fit_a.n + fit_b.shared_q8 * fit_b.n) /
                                                        (fit_a.n + fit_b.n));
    const bool one_surface = ale_segment_joins(e, a.last, b.first);
    const int64_t together =
        one_surface ? SHARED_PEAK * ale_min64(one.n, (int64_t)2 * e->config.noise.shared_beams) : 0;
    const int64_t gain = one.sse_q8 - fit_a.sse_q8 - fit_b.sse_q8;
    return gain * 256 / (PENALTY * var + shared * (one.n + together));
}

static bool may_join(const ale_extractor_t *e, ale_run_t a, ale_run_t b)
{
    return !a.curved && !b.curved && b.first - a.last <= MAX_GAP_POINTS &&
           e->beam[b.first] - e->beam[a.last] <= MAX_GAP_BEAMS;
}

static void remove_run(ale_extractor_t *e, int32_t k)
{
    for (int32_t i = k; i + 1 < e->run_count; i++) {
        e->run[i] = e->run[i + 1];
    }
    e->run_count--;
}

void ale_merge_runs(ale_extractor_t *e)
{
    int64_t ratio[ALE_MAX_RUNS];
    for (int32_t k = 0; k + 1 < e->run_count; k++) {
        ratio[k] = may_join(e, e->run[k], e->run[k + 1]) ? ale_merge_ratio_q8(e, e->run[k], e->run[k + 1])
                                                         : INT64_MAX;
    }
    while (e->run_count > 1) {
        int32_t best = 0;
        for (int32_t k = 1; k + 1 < e->run_count; k++) {
            best = ratio[k] < ratio[best] ? k : best;
        }
        if (ratio[best] >= 256) {
            return;
        }
        e->run[best].last = e->run[best + 1].last;
        remove_run(e, best + 1);
        for (int32_t k = best; k + 1 < e->run_count; k++) {
            ratio[k] = ratio[k + 1];
        }
        for (int32_t k = best > 0 ? best - 1 : 0; k <= best && k + 1 < e->run_count; k++) {
            ratio[k] = may_join(e, e->run[k], e->run[k + 1]) ? ale_merge_ratio_q8(e, e->run[k], e->run[k + 1])
                                                             : INT64_MAX;
        }
    }
}
