#include "extract/moments.h"

#include "base/fixed.h"

_Static_assert(ALE_POINT_MAX_Q4 *ALE_POINT_MAX_Q4 <= INT64_MAX / 2 / ALE_MAX_BEAMS / ALE_MAX_BEAMS,
               "twice the centred moments of the largest scan must fit int64");

enum {
    INVERSE2_SHIFT = 34,               /* from Q88 */
    MOST_INVERSE2_Q54 = (1 << 26) - 1, /* of ranges from 16 mm on, */
    OWN_BITS = 37,                     /* and of the own variance: their product fits int64 */
    MEAN_SHIFT = 2,                    /* of a mean's mm */
    DIRECTION_SHIFT = 8,               /* of the scatter, so that its product with two means fits int64 */
    NORMAL_SHIFT = 14, /* of the scatter, so that a normal times the mean times another normal fits int64 */
    SCATTER_BITS = 32, /* centred moments are scaled to this many bits: their products fit int64 */
    ROUND = 8,         /* a run is round when its width is more than this part of its length, squared */
    STEPS_OF_ROUND = 4,
    VAR_FLOOR_Q8 = 16 /* (0.25 mm)^2: no range is known better than its quantum of 1 mm */
};

void ale_moments_build(ale_prepared_scan_t *scan)
{
    ale_moments_t total = {0};
    int64_t inverse_total = 0;
    int64_t inverse2_total_q54 = 0;
    scan->noise.own_um2_q8 =
        ale_min64(((scan->noise.own_mm2_q36 >> 10) * 15625) >> 12, (int64_t)1 << OWN_BITS);
    for (int32_t i = 0; i < scan->points.count; i++) {
        scan->sum[i] = total;
        scan->inverse_sum[i] = inverse_total;
        scan->inverse2_sum_q54[i] = inverse2_total_q54;
        const int64_t x = scan->points.x_q4[i];
        const int64_t y = scan->points.y_q4[i];
        const int64_t inverse = scan->points.inverse_q44[i];
        total.x += x;
        total.y += y;
        total.xx += x * x;
        total.yy += y * y;
        total.xy += x * y;
        inverse_total += inverse;
        inverse2_total_q54 += inverse * inverse >> INVERSE2_SHIFT;
    }
    scan->sum[scan->points.count] = total;
    scan->inverse_sum[scan->points.count] = inverse_total;
    scan->inverse2_sum_q54[scan->points.count] = inverse2_total_q54;
}

typedef struct {
    int64_t a; /* scaled scatter matrix [a b; b c] */
    int64_t b;
    int64_t c;
    int64_t lambda; /* its small eigenvalue */
    unsigned shift;
} scatter_t;

/* Sums over the points first..last; the noise is left to who needs it. */
static inline ale_moments_t sums_of(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const ale_moments_t *p = &scan->sum[first];
    const ale_moments_t *q = &scan->sum[last + 1];
    const ale_moments_t s = {q->x - p->x, q->y - p->y, q->xx - p->xx, q->yy - p->yy, q->xy - p->xy};
    return s;
}

/* Newton's steps towards the smaller root of lambda^2 - trace lambda + det from below: one where the run is
 * long, which leaves less than (width / length)^8, and more where it is nearly as wide as long. */
static inline int64_t small_eigenvalue(int64_t a, int64_t b, int64_t c)
{
    const int64_t trace = ale_max64(a + c, 1);
    const int64_t det = ale_max64(a * c - b * b, 0);
    int64_t lambda = det / trace;
    if (lambda * ROUND <= trace) {
        return (det - lambda * lambda) / (trace - 2 * lambda);
    }
    for (int32_t k = 0; k < STEPS_OF_ROUND; k++) {
        lambda = (det - lambda * lambda) / ale_max64(trace - 2 * lambda, 1);
    }
    return lambda;
}

/* Inlined together with the sums: they are the innermost step of every decision. */
static inline __attribute__((always_inline)) scatter_t scatter_of(int64_t n, ale_moments_t s)
{
    const int64_t a = n * s.xx - s.x * s.x;
    const int64_t b = n * s.xy - s.x * s.y;
    const int64_t c = n * s.yy - s.y * s.y;
    const unsigned bits = ale_bit_length((uint64_t)(a + c) | ((uint64_t)1 << (SCATTER_BITS - 1)));
    const unsigned shift =
        (bits - SCATTER_BITS) & 63u; /* at least SCATTER_BITS: for those who cannot see it */
    const int64_t toward_zero = b < 0 ? ((int64_t)1 << shift) - 1 : 0;
    scatter_t m = {a >> shift, (b + toward_zero) >> shift, c >> shift, 0, shift};
    m.lambda = small_eigenvalue(m.a, m.b, m.c);
    return m;
}

/* Squared distance of the line from the sensor, mm^2: (mean' N mean), N = n n' from the scatter. The mean is
 * in quarters of a millimetre: a wall seen along itself is near the sensor, and its distance must be known.
 */
static inline int64_t squared_rho_mm2(const scatter_t *m, int64_t x_q2, int64_t y_q2)
{
    const int64_t spread = (m->a + m->c - 2 * m->lambda) >> DIRECTION_SHIFT;
    if (spread <= 0) {
        return (x_q2 * x_q2 + y_q2 * y_q2) >> (2 * MEAN_SHIFT);
    }
    const int64_t nxx = (m->c - m->lambda) >> DIRECTION_SHIFT;
    const int64_t nyy = (m->a - m->lambda) >> DIRECTION_SHIFT;
    const int64_t nxy = m->b / (1 << (DIRECTION_SHIFT - 1));
    const int64_t sum = (nxx * x_q2 - nxy * y_q2) * x_q2 + nyy * y_q2 * y_q2;
    return (ale_max64(sum, 0) / spread) >> (2 * MEAN_SHIFT);
}

/* What the noise makes of points at a mean squared range: own variance over the square of the range, and that
 * square, mm^2. */
typedef struct {
    int64_t own_q36;
    int64_t range2;
} noise_at_t;

static inline noise_at_t noise_of(const ale_prepared_scan_t *scan, int32_t first, int32_t last,
                                  const ale_moments_t *s)
{
    const int64_t n = last + 1 - first;
    const int64_t inverse2_q54 = (scan->inverse2_sum_q54[last + 1] - scan->inverse2_sum_q54[first]) / n;
    const int64_t range2 = (s->xx + s->yy) / (n << (2 * ALE_POINT_SHIFT));
    const int64_t own_q36 = (ale_min64(inverse2_q54, MOST_INVERSE2_Q54) * scan->noise.own_um2_q8 >> 26) +
                            ale_scan_noise_relative_q36(&scan->noise, range2);
    const noise_at_t at = {ale_min64(own_q36, ALE_MOST_RELATIVE_Q36), range2};
    return at;
}

/* Rounded; of what has no sign, in half as many steps as ale_round_shift. */
static inline int64_t round_variance(int64_t v, unsigned shift)
{
    return (v + ((int64_t)1 << (shift - 1))) >> shift;
}

static inline int64_t scaled_var_q8(const ale_scan_noise_t *noise, int64_t own_mm2_q36)
{
    return ale_max64(round_variance((own_mm2_q36 >> 20) * noise->own_scale_q16, 24), VAR_FLOOR_Q8);
}

static inline __attribute__((always_inline)) ale_run_fit_t
fit_of(const ale_scan_noise_t *noise, int64_t n, ale_moments_t s, const scatter_t *m, noise_at_t at)
{
    const int64_t q2_points = n << (ALE_POINT_SHIFT - MEAN_SHIFT);
    const int64_t rho2 = squared_rho_mm2(m, s.x / q2_points, s.y / q2_points);
    const int64_t own = rho2 * at.own_q36 + ale_max64(at.range2 - rho2, 0) * noise->bearing_rad2_q36;
    const int64_t shared_q36 = ale_min64(
        noise->shared_mm2_q36 / ale_max64(at.range2, 1) + noise->shared_relative_q36, ALE_MOST_RELATIVE_Q36);
    const ale_run_fit_t fit = {
        .n = (int32_t)n,
        .sse_q8 = (m->lambda << m->shift) / n,
        .var_q8 = scaled_var_q8(noise, own),
        .shared_q8 = round_variance(rho2 * shared_q36, 28),
    };
    return fit;
}

int64_t ale_moments_sse_q8(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const scatter_t m = scatter_of(n, sums_of(scan, first, last));
    return (m.lambda << m.shift) / n;
}

ale_run_fit_t ale_moments_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = sums_of(scan, first, last);
    const scatter_t m = scatter_of(n, s);
    return fit_of(&scan->noise, n, s, &m, noise_of(scan, first, last, &s));
}

ale_spread_t ale_moments_spread(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = sums_of(scan, first, last);
    const scatter_t m = scatter_of(n, s);
    const ale_spread_t spread = {
        .fit = fit_of(&scan->noise, n, s, &m, noise_of(scan, first, last, &s)),
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
    const ale_moments_t s = sums_of(scan, first, last);
    const scatter_t m = scatter_of(n, s);
    const int64_t unit = (int64_t)1 << NORMAL_SHIFT;
    const int64_t nx = (m.a >= m.c ? -m.b : m.lambda - m.c) / unit;
    const int64_t ny = (m.a >= m.c ? m.a - m.lambda : m.b) / unit;
    const int64_t rho = (nx * s.x + ny * s.y) / n;
    const ale_normal_line_t line = {rho < 0 ? -nx : nx, rho < 0 ? -ny : ny, ale_abs64(rho)};
    return line;
}
