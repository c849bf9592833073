/* Running sums over the points, and what they say about a run in constant time: paper (11) to (19) in
 * normal form, with the expected error (26) along the normal. A run is a range of points, both ends
 * included. */
#ifndef ALE_EXTRACT_MOMENTS_H
#define ALE_EXTRACT_MOMENTS_H

#include <stdint.h>

#include "base/fixed.h"
#include "extract/points.h"
#include "extract/scan_noise.h"
#include "extract/segment.h"

/* Sums over the points before one: their difference is the sum over a run. Of five words, which one
 * instruction finds. */
typedef struct {
    int64_t x;
    int64_t y;
    int64_t xx;
    int64_t yy;
    int64_t xy;
} ale_moments_t;

/* A scan ready for fits: what every later step reads. */
typedef struct {
    ale_points_t points;
    ale_scan_noise_t noise;
    ale_segments_t segments;
    ale_moments_t sum[ALE_MAX_BEAMS + 1];
    int64_t inverse_sum[ALE_MAX_BEAMS + 1];      /* of points.inverse_q44, */
    int64_t inverse2_sum_q54[ALE_MAX_BEAMS + 1]; /* and of their squares */
} ale_prepared_scan_t;

/* Fills the sums from the points and their noise. O(points). */
void ale_moments_build(ale_prepared_scan_t *scan);

/* A total-least-squares line through a run, as far as decisions need it. */
typedef struct {
    int32_t n;         /* 0: not known yet */
    int64_t sse_q8;    /* squared residuals along the normal, mm^2 Q8 */
    int64_t var_q8;    /* variance of one point along the normal that the own noise explains, mm^2 Q8; >= 1 */
    int64_t shared_q8; /* the same of the error that neighbours share */
} ale_run_fit_t;

/* Fit over the points first..last, first <= last. Constant time. The squared residuals
 * are exact to 2^-28 of the squares along the line and to their own share of those, squared. */
/*@ assigns \nothing;
  @ ensures 1 <= \result.n <= ALE_MAX_BEAMS && 0 <= \result.sse_q8 <= 1 << 51;
  @ ensures 1 <= \result.var_q8 <= 1 << 35 && 0 <= \result.shared_q8 <= 1 << 35; */
ale_run_fit_t ale_moments_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

/* The same in line, for it is the innermost step of every decision, and half of what a search costs. */
enum {
    ALE_SCATTER_BITS = 32, /* centred moments are scaled to this many bits: their products fit int64 */
    ALE_ROUND = 8,         /* a run is round when its width is more than this part of its length, squared */
    ALE_MOST_INVERSE2_Q54 = (1 << 26) - 1, /* of ranges from 16 mm on */
    ALE_MEAN_SHIFT = 2,                    /* of a mean's mm */
    ALE_DIRECTION_SHIFT = 8,               /* of the scatter, so that its product with two means fits int64 */
    ALE_VAR_FLOOR_Q8 = 16 /* (0.25 mm)^2: no range is known better than its quantum of 1 mm */
};

/* The smaller root of lambda^2 - trace lambda + det, from a lambda below it, of a round run. */
int64_t ale_round_eigenvalue(int64_t lambda, int64_t trace, int64_t det);

typedef struct {
    int64_t a; /* scaled scatter matrix [a b; b c] */
    int64_t b;
    int64_t c;
    int64_t lambda; /* its small eigenvalue */
    unsigned shift;
} ale_scatter_t;

/* Sums over the points first..last; the noise is left to who needs it. */
static inline ale_moments_t ale_sums_of(const ale_prepared_scan_t *scan, int64_t first, int64_t last)
{
    const ale_moments_t *p = &scan->sum[first];
    const ale_moments_t *q = &scan->sum[last + 1];
    const ale_moments_t s = {q->x - p->x, q->y - p->y, q->xx - p->xx, q->yy - p->yy, q->xy - p->xy};
    return s;
}

/* Newton's steps towards the smaller root of lambda^2 - trace lambda + det from below: one where the run is
 * long, which leaves less than (width / length)^8, and more where it is nearly as wide as long. */
static inline int64_t ale_small_eigenvalue(int64_t a, int64_t b, int64_t c)
{
    const int64_t trace = a + c;
    const int64_t det = a * c - b * b;
    if (det <= 0) {
        return 0; /* else a and c are positive: nothing below divides by zero */
    }
    const int64_t lambda = det / trace;
    return lambda * ALE_ROUND <= trace ? (det - lambda * lambda) / (trace - 2 * lambda)
                                       : ale_round_eigenvalue(lambda, trace, det);
}

/* Inlined together with the sums: they are the innermost step of every decision. */
static inline __attribute__((always_inline)) ale_scatter_t ale_scatter_of(int64_t n, ale_moments_t s)
{
    const int64_t a = n * s.xx - s.x * s.x;
    const int64_t b = n * s.xy - s.x * s.y;
    const int64_t c = n * s.yy - s.y * s.y;
    const unsigned bits = ale_bit_length((uint64_t)(a + c) | ((uint64_t)1 << (ALE_SCATTER_BITS - 1)));
    const unsigned shift =
        (bits - ALE_SCATTER_BITS) & 63u; /* at least ALE_SCATTER_BITS: for those who cannot see it */
    const int64_t toward_zero = b < 0 ? ((int64_t)1 << shift) - 1 : 0;
    ale_scatter_t m = {a >> shift, (b + toward_zero) >> shift, c >> shift, 0, shift};
    m.lambda = ale_small_eigenvalue(m.a, m.b, m.c);
    return m;
}

/* The squared residuals of a fit alone, mm^2 Q8: most decisions ask for nothing else. */
static inline int64_t ale_moments_sse_q8(const ale_prepared_scan_t *scan, int64_t first, int64_t last)
{
    const int64_t n = last + 1 - first;
    const ale_scatter_t m = ale_scatter_of(n, ale_sums_of(scan, first, last));
    return (m.lambda << m.shift) / n;
}

/* Squared distance of the line from the sensor, mm^2: (mean' N mean), N = n n' from the scatter. The mean is
 * in quarters of a millimetre: a wall seen along itself is near the sensor, and its distance must be known.
 */
static inline int64_t ale_squared_rho_mm2(const ale_scatter_t *m, int64_t x_q2, int64_t y_q2)
{
    const int64_t spread = (m->a + m->c - 2 * m->lambda) >> ALE_DIRECTION_SHIFT;
    if (spread <= 0) {
        return (x_q2 * x_q2 + y_q2 * y_q2) >> (2 * ALE_MEAN_SHIFT);
    }
    const int64_t nxx = (m->c - m->lambda) >> ALE_DIRECTION_SHIFT;
    const int64_t nyy = (m->a - m->lambda) >> ALE_DIRECTION_SHIFT;
    const int64_t nxy = m->b / (1 << (ALE_DIRECTION_SHIFT - 1));
    const int64_t sum = (nxx * x_q2 - nxy * y_q2) * x_q2 + nyy * y_q2 * y_q2;
    return (ale_max64(sum, 0) / spread) >> (2 * ALE_MEAN_SHIFT);
}

/* What the noise makes of points at a mean squared range: own variance over the square of the range, and that
 * square, mm^2. */
typedef struct {
    int64_t own_q36;
    int64_t range2;
} ale_noise_at_t;

static inline ale_noise_at_t ale_noise_of(const ale_prepared_scan_t *scan, int64_t first, int64_t last,
                                          const ale_moments_t *s)
{
    const int64_t n = last + 1 - first;
    const int64_t inverse2_q54 = (scan->inverse2_sum_q54[last + 1] - scan->inverse2_sum_q54[first]) / n;
    const int64_t range2 = (s->xx + s->yy) / (n << (2 * ALE_POINT_SHIFT));
    const int64_t own_q36 = (ale_min64(inverse2_q54, ALE_MOST_INVERSE2_Q54) * scan->noise.own_um2_q8 >> 26) +
                            ale_scan_noise_relative_q36(&scan->noise, range2);
    const ale_noise_at_t at = {ale_min64(own_q36, ALE_MOST_RELATIVE_Q36), range2};
    return at;
}

/* Rounded; of what has no sign, in half as many steps as ale_round_shift. */
static inline int64_t ale_round_variance(int64_t v, unsigned shift)
{
    return (v + ((int64_t)1 << (shift - 1))) >> shift;
}

static inline int64_t ale_scaled_var_q8(const ale_scan_noise_t *noise, int64_t own_mm2_q36)
{
    return ale_max64(ale_round_variance((own_mm2_q36 >> 20) * noise->own_scale_q16, 24), ALE_VAR_FLOOR_Q8);
}

static inline __attribute__((always_inline)) ale_run_fit_t ale_fit_of(const ale_scan_noise_t *noise,
                                                                      int64_t n, ale_moments_t s,
                                                                      const ale_scatter_t *m,
                                                                      ale_noise_at_t at)
{
    const int64_t q2_points = n << (ALE_POINT_SHIFT - ALE_MEAN_SHIFT);
    const int64_t rho2 = ale_squared_rho_mm2(m, s.x / q2_points, s.y / q2_points);
    const int64_t own = rho2 * at.own_q36 + ale_max64(at.range2 - rho2, 0) * noise->bearing_rad2_q36;
    const int64_t shared_q36 = ale_min64(
        noise->shared_mm2_q36 / ale_max64(at.range2, 1) + noise->shared_relative_q36, ALE_MOST_RELATIVE_Q36);
    ale_run_fit_t fit;
    fit.n = (int32_t)n;
    fit.sse_q8 = (m->lambda << m->shift) / n;
    fit.var_q8 = ale_scaled_var_q8(noise, own);
    fit.shared_q8 = ale_round_variance(rho2 * shared_q36, 28);
    return fit;
}

/* See ale_moments_fit. */
static inline __attribute__((always_inline)) ale_run_fit_t ale_run_fit(const ale_prepared_scan_t *scan,
                                                                       int64_t first, int64_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = ale_sums_of(scan, first, last);
    const ale_scatter_t m = ale_scatter_of(n, s);
    return ale_fit_of(&scan->noise, n, s, &m, ale_noise_of(scan, first, last, &s));
}

/* Squared residuals in units of the own variance, Q8. */
static inline int64_t ale_fit_chi_q8(const ale_run_fit_t *fit)
{
    return (fit->sse_q8 << 8) / fit->var_q8;
}

/* The same with what the final line needs. */
typedef struct {
    ale_run_fit_t fit;
    int64_t a; /* scatter matrix [a b; b c] in any unit */
    int64_t b;
    int64_t c;
    int64_t along2_q8; /* squared distances from the mean along the line, mm^2 Q8 */
    int64_t mean_x_um;
    int64_t mean_y_um;
} ale_spread_t;

ale_spread_t ale_moments_spread(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

/* The line alone, nx x + ny y = rho >= 0 in any unit, for where it meets another. */
typedef struct {
    int64_t nx; /* below 2^18 */
    int64_t ny;
    int64_t rho; /* below 2^39 */
} ale_normal_line_t;

ale_normal_line_t ale_moments_normal_line(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

#endif
