#include "extract/run_list.h"

#include "base/fixed.h"

enum { LOW_Z = 3, HIGH_Z = 4 };

/* Chi square that n points about a fitted line exceed as seldom as a Gauss curve z deviations, by Wilson and
 * Hilferty: k (1 - h + z sqrt(h))^3 with h = 2 / 9 k and k = n - 2 degrees of freedom. */
static int32_t chi_limit_q8(int32_t n, int32_t z)
{
    const int64_t freedom = n > 2 ? n - 2 : 1;
    const int64_t h_q20 = ((int64_t)2 << 20) / (9 * freedom);
    const int64_t root_q20 = ((int64_t)1 << 20) - h_q20 + z * (int64_t)ale_isqrt((uint64_t)h_q20 << 20);
    return (int32_t)(freedom * ((((root_q20 * root_q20) >> 20) * root_q20) >> 20) >> 12);
}

void ale_run_list_init(ale_run_list_t *r, uint16_t min_points)
{
    r->min_points = min_points;
    for (int32_t n = 0; n <= ALE_MAX_BEAMS; n++) {
        r->chi_low_q8[n] = chi_limit_q8(n, LOW_Z);
        r->chi_high_q8[n] = chi_limit_q8(n, HIGH_Z);
    }
}

void ale_run_list_forget_fits(ale_run_list_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        ale_run_changed(&r->run[k]);
    }
}

/* Longer runs first, of equally long ones those nearer to the middle of the points: the same from either
 * side, and no more than two are alike. */
static int32_t rank_of(const ale_run_list_t *r, const ale_run_t *run)
{
    const int32_t points = run->last + 1 - run->first;
    return points * ALE_MAX_BEAMS - (int32_t)ale_abs64(run->first + run->last + 1 - r->scan.points.count);
}

void ale_run_list_drop_short(ale_run_list_t *r, int32_t fewest, int32_t enough)
{
    int32_t rank[ALE_MAX_RUNS] = {0};
    for (int32_t k = 0; k < r->count; k++) {
        rank[k] = rank_of(r, &r->run[k]);
    }
    int32_t least = (fewest - 1) * ALE_MAX_BEAMS + 1;                     /* of runs with enough points */
    int32_t too_high = r->scan.points.count / enough * ALE_MAX_BEAMS + 1; /* for enough runs to reach it */
    while (too_high - least > 1) {
        const int32_t middle = (least + too_high) / 2;
        int32_t reach_it = 0;
        for (int32_t k = 0; k < r->count; k++) {
            reach_it += rank[k] >= middle;
        }
        if (reach_it >= enough) {
            least = middle;
        } else {
            too_high = middle;
        }
    }
    const int32_t runs = r->count;
    int32_t kept = 0;
    for (int32_t k = 0; k < runs; k++) {
        const ale_run_t run = r->run[k];
        if (rank[k] >= least) {
            r->run[kept++] = run;
        } else {
            const int32_t points = run.last + 1 - run.first;
            r->refused[points < r->min_points ? ALE_REFUSED_FEW_POINTS : ALE_REFUSED_CAPACITY]++;
        }
    }
    r->count = (uint16_t)kept;
}
