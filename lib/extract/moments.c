#include "extract/moments.h"

#include "base/fixed.h"

_Static_assert(ALE_POINT_MAX_Q4 *ALE_POINT_MAX_Q4 <= INT64_MAX / 2 / ALE_MAX_BEAMS / ALE_MAX_BEAMS,
               "twice the centred moments of the largest scan must fit int64");

enum {
    INVERSE2_SHIFT = 34, /* from Q88 */
    OWN_BITS = 37,       /* of the own variance: times ALE_MOST_INVERSE2_Q54 it fits int64 */
    NORMAL_SHIFT = 14,   /* of the scatter, so that a normal times the mean times another normal fits int64 */
    STEPS_OF_ROUND = 4,
    BLOCK = 8 /* points summed without asking for the end of the loop, which costs as much as a product */
};

int64_t ale_round_eigenvalue(int64_t lambda, int64_t trace, int64_t det)
{
    int64_t root = lambda;
    for (int32_t k = 0; k < STEPS_OF_ROUND; k++) {
        root = (det - root * root) / ale_max64(trace - 2 * root, 1);
    }
    return root;
}

static inline void sum_point(ale_prepared_scan_t *scan, int32_t i, ale_moments_t *total)
{
    const int64_t x = scan->points.x_q4[i];
    const int64_t y = scan->points.y_q4[i];
    scan->sum[i] = *total;
    total->xy += x * y;
    total->x += x;
    total->y += y;
    total->xx += x * x;
    total->yy += y * y;
}

typedef struct {
    int64_t first;
    int64_t second_q54;
} inverse_sums_t;

static inline void sum_inverse(ale_prepared_scan_t *scan, int32_t i, inverse_sums_t *total)
{
    const int64_t inverse = scan->points.inverse_q44[i];
    scan->inverse_sum[i] = total->first;
    scan->inverse2_sum_q54[i] = total->second_q54;
    total->first += inverse;
    total->second_q54 += inverse * inverse >> INVERSE2_SHIFT;
}

void ale_moments_build(ale_prepared_scan_t *scan)
{
    const int32_t count = scan->points.count;
    ale_moments_t total = {0};
    inverse_sums_t inverse_total = {0};
    scan->noise.own_um2_q8 =
        ale_min64(((scan->noise.own_mm2_q36 >> 10) * 15625) >> 12, (int64_t)1 << OWN_BITS);
    int32_t i = 0;
    for (; i + BLOCK <= count; i += BLOCK) {
        for (int32_t j = 0; j < BLOCK; j++) {
            sum_point(scan, i + j, &total);
            sum_inverse(scan, i + j, &inverse_total);
        }
    }
    for (; i < count; i++) {
        sum_point(scan, i, &total);
        sum_inverse(scan, i, &inverse_total);
    }
    scan->sum[count] = total;
    scan->inverse_sum[count] = inverse_total.first;
    scan->inverse2_sum_q54[count] = inverse_total.second_q54;
}

ale_run_fit_t ale_moments_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    return ale_run_fit(scan, first, last);
}

ale_spread_t ale_moments_spread(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = ale_sums_of(scan, first, last);
    const ale_scatter_t m = ale_scatter_of(n, s);
    const ale_spread_t spread = {
        .fit = ale_fit_of(&scan->noise, n, s, &m, ale_noise_of(scan, first, last, &s)),
        .a = m.a,
        .b = m.b,
        .c = m.c,
        .along2_q8 = ((m.a + m.c - m.lambda) << m.shift) / n,
        .mean_x_um = ale_round_div(s.x * 1000, n << ALE_POINT_SHIFT),
        .mean_y_um = ale_round_div(s.y * 1000, n << ALE_POINT_SHIFT),
    };
    return spread;
}

ale_normal_line_t ale_moments_normal_line(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = ale_sums_of(scan, first, last);
    const ale_scatter_t m = ale_scatter_of(n, s);
    const int64_t unit = (int64_t)1 << NORMAL_SHIFT;
    const int64_t nx = (m.a >= m.c ? -m.b : m.lambda - m.c) / unit;
    const int64_t ny = (m.a >= m.c ? m.a - m.lambda : m.b) / unit;
    const int64_t rho = (nx * s.x + ny * s.y) / n;
    const ale_normal_line_t line = {rho < 0 ? -nx : nx, rho < 0 ? -ny : ny, ale_abs64(rho)};
    return line;
}
