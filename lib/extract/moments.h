/* Running sums over the points, and what they say about a run in constant time: paper (11) to (19) in
 * normal form, with the expected error (26) along the normal. A run is a range of points, both ends
 * included. */
#ifndef ALE_EXTRACT_MOMENTS_H
#define ALE_EXTRACT_MOMENTS_H

#include <stdint.h>

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

/* Fit over the points first..last, first <= last. Constant time. The squared residuals are exact to
 * 2^-28 of the squares along the line and to their own share of those, squared. */
/*@ assigns \nothing;
  @ ensures 1 <= \result.n <= ALE_MAX_BEAMS && 0 <= \result.sse_q8 <= 1 << 51;
  @ ensures 1 <= \result.var_q8 <= 1 << 35 && 0 <= \result.shared_q8 <= 1 << 35; */
ale_run_fit_t ale_moments_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

/* Its squared residuals alone, mm^2 Q8. Constant time. */
int64_t ale_moments_sse_q8(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

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
