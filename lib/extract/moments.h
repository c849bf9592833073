/* Running sums over the points, and what they say about a run in constant time: paper (11) to (19) in
 * normal form, with the expected error (26) along the normal. */
#ifndef ALE_EXTRACT_MOMENTS_H
#define ALE_EXTRACT_MOMENTS_H

#include "extract/workspace.h"

/* Fills e->sum from e->x_q4, y_q4, range_um and e->noise. O(points). */
void ale_moments_build(ale_extractor_t *e);

/* Fit over the points first..last, first <= last. Constant time. The squared residuals are exact to
 * 2^-28 of the squares along the line and to their own share of those, squared. */
ale_run_fit_t ale_moments_fit(const ale_extractor_t *e, int32_t first, int32_t last);

/* An end of the run has moved, or the noise has changed: what is known of it holds no longer. */
static inline void ale_run_changed(ale_run_t *run)
{
    run->fit.n = 0;
    run->no_arc = false;
    run->no_break = false;
    run->settled = false;
}

/* The fit of a run, computed when it is asked for the first time. */
static inline const ale_run_fit_t *ale_fit_of_run(const ale_extractor_t *e, ale_run_t *run)
{
    if (run->fit.n == 0) {
        run->fit = ale_moments_fit(e, run->first, run->last);
    }
    return &run->fit;
}

/* Its squared residuals alone, mm^2 Q8. Constant time. */
int64_t ale_moments_sse_q8(const ale_extractor_t *e, int32_t first, int32_t last);

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

ale_spread_t ale_moments_spread(const ale_extractor_t *e, int32_t first, int32_t last);

/* The line alone, nx x + ny y = rho >= 0 in any unit, for where it meets another. */
typedef struct {
    int64_t nx; /* below 2^18 */
    int64_t ny;
    int64_t rho; /* below 2^39 */
} ale_normal_line_t;

ale_normal_line_t ale_moments_normal_line(const ale_extractor_t *e, int32_t first, int32_t last);

/* Squared residuals in units of the own variance, Q8. */
static inline int64_t ale_fit_chi_q8(const ale_run_fit_t *fit)
{
    return (fit->sse_q8 << 8) / fit->var_q8;
}

#endif
