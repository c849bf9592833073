#include "extract/line_fit.h"

#include "base/fixed.h"
#include "base/trig.h"

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
static ale_point_t end_on_line(const ale_extractor_t *e, int32_t i, const ale_line_t *line, int64_t c_q30,
                               int64_t s_q30)
{
    const int64_t x_um = ale_round_shift((int64_t)e->x_q4[i] * 1000, ALE_POINT_SHIFT);
    const int64_t y_um = ale_round_shift((int64_t)e->y_q4[i] * 1000, ALE_POINT_SHIFT);
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

/* The shared error counts as far as the scan shows it, or as configured where the scan is too small to tell.
 */
static void set_covariance(const ale_extractor_t *e, const ale_spread_t *m, ale_line_t *line,
                           int64_t mean_along_um)
{
    const int64_t n = line->points;
    const int64_t beams = e->config.noise.shared_beams;
    const int64_t shared_q8 = e->shared_absent ? 0 : m->fit.shared_q8;
    const int64_t mean_q8 = m->fit.var_q8 + ((shared_q8 * together_in_mean_q8(n, beams)) >> 8);
    const int64_t slope_q8 = m->fit.var_q8 + ((shared_q8 * together_in_slope_q8(n, beams)) >> 8);
    const int64_t along2_q8 = ale_max64(m->along2_q8, 1);
    line->var_alpha_nrad2 = nano_nano(slope_q8, along2_q8);
    line->cov_alpha_rho = ale_mul_nano(line->var_alpha_nrad2, mean_along_um);
    line->var_rho_um2 = um2_of_q8(mean_q8) / n + ale_mul_nano(line->cov_alpha_rho, mean_along_um);
}

/* Variance of an end along the line. The wall ends anywhere between its last beam and the next one, which
 * would meet it range^2 step / rho farther: a third of that squared. Where the surface goes on, the break may
 * be a beam off, and what both lines err by along their normals moves the place where they meet. */
static int64_t end_var_um2(const ale_extractor_t *e, int32_t i, bool at_break, int64_t var_um2,
                           int32_t rho_um)
{
    const int64_t range_um = e->range_um[i];
    const int64_t across_um = ale_mul_nano(range_um, e->step_nrad);
    const int64_t along_um = ale_round_div(across_um * range_um, ale_max64(rho_um, 1));
    const int64_t spacing_um = ale_min64(along_um, range_um);
    const int64_t spacing2_um2 = spacing_um * spacing_um;
    return at_break ? spacing2_um2 * 2 / 5 + var_um2 : spacing2_um2 / 3;
}

ale_run_fit_t ale_line_fit(const ale_extractor_t *e, ale_segment_t run, ale_line_t *line)
{
    const ale_spread_t m = ale_moments_spread(e, run.first, run.last);
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
    line->first = e->beam[run.first];
    line->last = e->beam[run.last];
    line->points = (uint16_t)m.fit.n;
    line->alpha_bam = alpha;
    line->rho_um = (int32_t)rho;
    line->start = end_on_line(e, run.first, line, c, s);
    line->end = end_on_line(e, run.last, line, c, s);
    const int64_t mse_q8 = m.fit.sse_q8 / ale_max64(m.fit.n - 2, 1);
    line->rmse_um = (int32_t)ale_isqrt((uint64_t)um2_of_q8(mse_q8));
    set_covariance(e, &m, line, dot_q30(m.mean_x_um, m.mean_y_um, -s, c));
    const int64_t shared_q8 = e->shared_absent ? 0 : m.fit.shared_q8;
    const int64_t var_um2 = um2_of_q8(m.fit.var_q8 / 8 + shared_q8);
    const bool from_break = run.first > 0 && !e->jump_after[run.first - 1];
    const bool to_break = run.last + 1 < e->count && !e->jump_after[run.last];
    line->var_start_um2 = end_var_um2(e, run.first, from_break, var_um2, line->rho_um);
    line->var_end_um2 = end_var_um2(e, run.last, to_break, var_um2, line->rho_um);
    return m.fit;
}
