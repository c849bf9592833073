#include "extract/breakpoint.h"

#include "base/fixed.h"
#include "extract/moments.h"

enum { SHARED_SHARE = 2, SHARED_PEAK = 6 };

static ale_fit_t fit_between(const ale_extractor_t *e, int32_t a, int32_t b)
{
    return a <= b ? ale_moments_fit(e, a, b) : ale_moments_fit(e, b, a);
}

/* Squared residuals that n points of a true line may add: chi square of the own noise, and the shared
 * error, of which n points have only one draw for every 2 * shared_beams of them. */
static int64_t allowed_q8(const ale_extractor_t *e, const ale_fit_t *fit, int32_t n)
{
    const int64_t together = ale_min64(n, 2 * e->config.noise.shared_beams);
    const int64_t shared = fit->shared_q8 * (SHARED_SHARE * n + SHARED_PEAK * together);
    return ((fit->var_q8 * e->chi_high_q8[n]) >> 8) + shared;
}

static bool acceptable(const ale_extractor_t *e, const ale_fit_t *fit, const ale_fit_t *accepted)
{
    if (fit->sse_q8 > allowed_q8(e, fit, fit->n)) {
        return false;
    }
    const int32_t added = fit->n - accepted->n;
    return fit->sse_q8 - accepted->sse_q8 <= allowed_q8(e, fit, added + 2);
}

int32_t ale_break_search(const ale_extractor_t *e, int32_t from, int32_t to)
{
    const int32_t direction = to >= from ? 1 : -1;
    int32_t low = ALE_MIN_RUN - 1;
    int32_t high = (to - from) * direction + 1;
    if (low >= high) {
        return from;
    }
    ale_fit_t accepted = fit_between(e, from, from + direction * low);
    if (accepted.sse_q8 > allowed_q8(e, &accepted, accepted.n)) {
        return from;
    }
    while (high - low > 1) {
        const int32_t p = (low + high) / 2;
        const ale_fit_t fit = fit_between(e, from, from + direction * p);
        if (acceptable(e, &fit, &accepted)) {
            low = p;
            accepted = fit;
        } else {
            high = p;
        }
    }
    return from + direction * low;
}

static int64_t joint_chi_q8(const ale_extractor_t *e, int32_t first, int32_t split, int32_t last)
{
    const ale_fit_t a = ale_moments_fit(e, first, split);
    const ale_fit_t b = ale_moments_fit(e, split + 1, last);
    return ale_fit_chi_q8(&a) + ale_fit_chi_q8(&b);
}

int32_t ale_break_place(const ale_extractor_t *e, ale_run_t a, ale_run_t b, int32_t direction)
{
    const int32_t lowest = a.first + ALE_MIN_RUN - 2;
    const int32_t highest = b.last - ALE_MIN_RUN + 1;
    int32_t best = a.last;
    if (lowest > highest) {
        return best;
    }
    best = (int32_t)ale_clamp64(best, lowest, highest);
    int64_t best_chi = joint_chi_q8(e, a.first, best, b.last);
    for (int32_t step = 8; step > 0; step /= 2) {
        for (int32_t tries = 0; tries < 4; tries++) {
            const int32_t centre = best;
            for (int32_t side = -1; side <= 1; side += 2) {
                const int32_t k = centre + side * direction * step;
                if (k < lowest || k > highest) {
                    continue;
                }
                const int64_t chi = joint_chi_q8(e, a.first, k, b.last);
                if (chi < best_chi) {
                    best_chi = chi;
                    best = k;
                }
            }
            if (best == centre) {
                break;
            }
        }
    }
    return best;
}
