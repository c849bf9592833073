#include "extract/line_fit.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "extract/merge.h"

enum {
    SAMPLES = 4,  /* points of a line at which its noise is looked at, */
    EVEN = 32,    /* fewer points than these see it alike, */
    VAR_BITS = 16 /* and as how many bits: times a squared place along the line it fits int64 */
};

/* A Q8 variance in mm^2 as um^2. */
static int64_t um2_of_q8(int64_t v_q8)
{
    return ale_round_div(v_q8 * 15625, 4);
}

static int64_t dot_q30(int64_t x, int64_t y, int64_t ux_q30, int64_t uy_q30)
{
    return ale_round_shift(x * ux_q30 + y * uy_q30, 30);
}

/* Where the beam of a point meets the line; the point's own foot where beam and line are almost parallel. */
static inline ale_point_t end_on_line(const ale_prepared_scan_t *scan, int32_t i, const ale_line_t *line,
                                      int64_t c_q30, int64_t s_q30)
{
    const int64_t x_um = ale_round_shift((int64_t)scan->points.x_q4[i] * 1000, ALE_POINT_SHIFT);
    const int64_t y_um = ale_round_shift((int64_t)scan->points.y_q4[i] * 1000, ALE_POINT_SHIFT);
    const int64_t along_normal = dot_q30(x_um, y_um, c_q30, s_q30);
    if (ale_abs64(line->rho_um - along_normal) * 8 < along_normal) {
        const ale_point_t p = {(int32_t)ale_round_div(x_um * line->rho_um, along_normal),
                               (int32_t)ale_round_div(y_um * line->rho_um, along_normal)};
        return p;
    }
    const int64_t off = line->rho_um - along_normal;
    const ale_point_t foot = {(int32_t)(x_um + ale_round_shift(off * c_q30, 30)),
                              (int32_t)(y_um + ale_round_shift(off * s_q30, 30))};
    return foot;
}

/* 10^18 a / b for a > 0 and 0 < b < 2^48: to 14 bits and better. */
static int64_t nano_nano(int64_t a, int64_t b)
{
    const unsigned shift = 63 - ale_bit_length((uint64_t)a);
    return ale_mul_shift((a << shift) / b, 1000000000000000000, shift);
}

/* How many of n points err together in their mean, and in their slope, when the correlation of their errors
 * falls to 1/e over so many beams: the sums of the correlations over all pairs of points, within 6 %; Q8. */
static int64_t together_in_mean_q8(int64_t n, int64_t beams)
{
    const int64_t reach = n + beams;
    return 512 * beams * n * reach / (reach * reach + beams * beams);
}

static int64_t together_in_slope_q8(int64_t n, int64_t beams)
{
    return 512 * beams * n * n / (n * n + 3 * beams * n + 11 * beams * beams);
}

/* What of the mean own variance counts in the slope, Q16, from a few points that stand for all: far points
 * see their ranges from the side, and near ones their bearings. Along the normal a constant noise is as rho^2
 * / range^2, that of the bearing as range^2 - rho^2. */
static int64_t slope_share_q16(const ale_prepared_scan_t *scan, ale_segment_t run, const ale_spread_t *m,
                               int64_t rho_um, int64_t mean_along_um, ale_direction_t normal)
{
    const ale_scan_noise_t *noise = &scan->noise;
    const int64_t n = m->fit.n;
    if (n < EVEN) {
        return 1 << 16;
    }
    const int64_t rho2_mm2 = (rho_um / 1000) * (rho_um / 1000);
    const int64_t middle_mm = scan->points.range_um[(run.first + run.last) / 2] / 1000;
    const int64_t relative_q36 = ale_scan_noise_relative_q36(noise, middle_mm * middle_mm);
    const int64_t even_q36 = rho2_mm2 * ale_min64(relative_q36, ALE_MOST_RELATIVE_Q36);
    int64_t constant_q36[SAMPLES];
    int64_t bearing_q36[SAMPLES];
    int64_t along2_mm2[SAMPLES];
    int64_t most_q36 = ale_max64(even_q36, 1);
    for (int64_t k = 0; k < SAMPLES; k++) {
        const int64_t i = run.first + (2 * k + 1) * n / SAMPLES / 2;
        const int64_t range_mm = scan->points.range_um[i] / 1000;
        const int64_t range2_mm2 = ale_max64(range_mm * range_mm, rho2_mm2 + 1);
        constant_q36[k] = rho2_mm2 * ale_min64(noise->own_mm2_q36 / range2_mm2, ALE_MOST_RELATIVE_Q36);
        bearing_q36[k] = (range2_mm2 - rho2_mm2) * noise->bearing_rad2_q36;
        most_q36 = ale_max64(most_q36, ale_max64(constant_q36[k], bearing_q36[k]));
        const int64_t along_q4 =
            dot_q30(scan->points.x_q4[i], scan->points.y_q4[i], -normal.sin_q30, normal.cos_q30);
        const int64_t off_mm = ale_round_div(((along_q4 * 1000) >> ALE_POINT_SHIFT) - mean_along_um, 1000);
        along2_mm2[k] = off_mm * off_mm;
    }
    const unsigned bits = ale_bit_length((uint64_t)most_q36);
    const unsigned shift = bits > VAR_BITS ? bits - VAR_BITS : 0;
    int64_t all = SAMPLES * ((even_q36 >> shift) + 1);
    int64_t in_slope = all;
    int64_t along2 = 1;
    int64_t along2_constant = 0;
    int64_t along2_bearing = 0;
    for (int64_t k = 0; k < SAMPLES; k++) {
        all += (constant_q36[k] + bearing_q36[k]) >> shift;
        along2 += along2_mm2[k];
        along2_constant += along2_mm2[k] * (constant_q36[k] >> shift);
        along2_bearing += along2_mm2[k] * (bearing_q36[k] >> shift);
    }
    in_slope += (along2_constant << 8) / ale_max64(m->along2_q8 / n, 1) + along2_bearing / along2 * SAMPLES;
    return (in_slope << 16) / all;
}

/* An end of a line. */
typedef struct {
    ale_beyond_t beyond;
    int64_t range_um;
    int64_t across_um; /* from its beam to the next one, across it */
} end_t;

static inline end_t end_of(const ale_prepared_scan_t *scan, int32_t i, int32_t side)
{
    const int64_t range_um = scan->points.range_um[i];
    return (end_t){ale_segment_beyond(&scan->points, &scan->segments, i, side), range_um,
                   ale_mul_nano(range_um, scan->points.step_nrad)};
}

/* Points at an end where another wall adjoins that may be of either: they lie within a deviation of both, if
 * the walls are at right angles. To which of them each is given depends on its error, so they tell nothing.
 */
static int64_t doubtful_points_q8(const end_t *end, int64_t sigma_um, int64_t along_um)
{
    if (end->beyond.point < 0 || end->beyond.jump) {
        return 0;
    }
    return 2 * ((sigma_um * ale_abs64(along_um)) << 8) / (ale_max64(end->across_um, 1) * end->range_um);
}

/* The shared error of a run as far as the scan shows it, without the margin that decisions have, or as
 * configured where the scan is too small to tell. */
static int64_t stated_shared_q8(const ale_prepared_scan_t *scan, const ale_run_fit_t *fit)
{
    if (scan->noise.shared_scale_q8 > 256) {
        return fit->shared_q8 * scan->noise.shared_stated_q8 / scan->noise.shared_scale_q8;
    }
    return scan->noise.shared_absent ? 0 : fit->shared_q8;
}

static void set_covariance(const ale_prepared_scan_t *scan, const ale_spread_t *m, int64_t doubtful_q8,
                           int64_t slope_q16, int64_t mean_along_um, ale_line_t *line)
{
    const int64_t n = line->points;
    const int64_t beams = scan->noise.shared_beams;
    const int64_t shared_q8 = stated_shared_q8(scan, &m->fit);
    const ale_merge_doubt_t doubt = ale_merge_doubt(&scan->noise, m);
    const int64_t mean_q8 = doubt.var_q8 + doubt.mean_q8 + ((shared_q8 * together_in_mean_q8(n, beams)) >> 8);
    /* a point at an end has 3 / n of what is known of the slope */
    const int64_t told_q8 = (n << 8) + 3 * ale_min64(doubtful_q8, (n << 8) / 4);
    const int64_t own_q8 = (((doubt.var_q8 * slope_q16) >> 16) * told_q8 / n) >> 8;
    const int64_t slope_q8 = own_q8 + doubt.slope_q8 + ((shared_q8 * together_in_slope_q8(n, beams)) >> 8);
    const int64_t along2_q8 = ale_max64(m->along2_q8, 1);
    line->var_alpha_nrad2 = nano_nano(ale_max64(slope_q8, 1), along2_q8);
    line->cov_alpha_rho = ale_mul_nano(line->var_alpha_nrad2, mean_along_um);
    line->var_rho_um2 = um2_of_q8(mean_q8) / n + ale_mul_nano(line->cov_alpha_rho, mean_along_um);
}

/* Variance of an end along the line. The wall ends anywhere between its last
 * beam and that of the next point, where the following beam would meet it range^2 step / rho farther: a third
 * of that squared, for each of them. Where the surface goes on, but not as a line, the end may be a beam and
 * more off. */
static int64_t end_var_um2(const end_t *end, int32_t rho_um)
{
    const int64_t along_um = ale_round_div(end->across_um * end->range_um, ale_max64(rho_um, 1));
    const int64_t spacing_um = ale_min64(along_um, end->range_um);
    const int64_t spacing2_um2 = spacing_um * spacing_um;
    if (end->beyond.point < 0) {
        return spacing2_um2 / 3;
    }
    const int64_t gap = end->beyond.gap;
    const int64_t unseen = gap <= ALE_MAX_GAP_BEAMS ? gap * gap : 1;
    return spacing2_um2 * unseen / (end->beyond.jump ? 3 : 1);
}

static int64_t along_line_um(ale_point_t p, int64_t c_q30, int64_t s_q30)
{
    return dot_q30(p.x_um, p.y_um, -s_q30, c_q30);
}

ale_run_fit_t ale_line_fit(const ale_prepared_scan_t *scan, ale_segment_t run, ale_line_t *line)
{
    const ale_spread_t m = ale_moments_spread(scan, run.first, run.last);
    const int32_t double_angle = (int32_t)ale_atan2_bam(2 * m.b, m.a - m.c);
    uint32_t alpha = (uint32_t)(double_angle / 2) + ALE_BAM_QUARTER_TURN;
    const ale_direction_t normal = ale_direction(alpha);
    int64_t c = normal.cos_q30;
    int64_t s = normal.sin_q30;
    int64_t rho = dot_q30(m.mean_x_um, m.mean_y_um, c, s);
    if (rho < 0) {
        rho = -rho;
        c = -c;
        s = -s;
        alpha += ALE_BAM_HALF_TURN;
    }
    line->first = ale_points_beam(&scan->points, run.first);
    line->last = ale_points_beam(&scan->points, run.last);
    line->points = (uint16_t)m.fit.n;
    line->alpha_bam = alpha;
    line->rho_um = (int32_t)rho;
    line->start = end_on_line(scan, run.first, line, c, s);
    line->end = end_on_line(scan, run.last, line, c, s);
    const int64_t mse_q8 = m.fit.sse_q8 / ale_max64(m.fit.n - 2, 1);
    line->rmse_um = (int32_t)ale_isqrt((uint64_t)um2_of_q8(mse_q8));
    const int64_t mean_along_um =
        along_line_um((ale_point_t){(int32_t)m.mean_x_um, (int32_t)m.mean_y_um}, c, s);
    const int64_t sigma_um = ale_isqrt((uint64_t)um2_of_q8(m.fit.var_q8));
    const end_t start = end_of(scan, run.first, -1);
    const end_t end = end_of(scan, run.last, 1);
    const int64_t doubtful_q8 = doubtful_points_q8(&start, sigma_um, along_line_um(line->start, c, s)) +
                                doubtful_points_q8(&end, sigma_um, along_line_um(line->end, c, s));
    const int64_t slope_q16 =
        slope_share_q16(scan, run, &m, rho, mean_along_um, (ale_direction_t){(int32_t)c, (int32_t)s});
    set_covariance(scan, &m, doubtful_q8, slope_q16, mean_along_um, line);
    line->var_start_um2 = end_var_um2(&start, line->rho_um);
    line->var_end_um2 = end_var_um2(&end, line->rho_um);
    return m.fit;
}
