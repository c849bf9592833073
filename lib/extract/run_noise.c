#include "extract/run_noise.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

/* Blocks of beams whose second difference shows what neighbours share, for an error that is correlated
 * over 12 beams: the block means of pure own noise have 6 / BLOCK own variances, of the shared part
 * SHARED_GAIN_Q8 shared ones. */
enum {
    PERCENT = 75, /* see scan_noise.c */
    BLOCK = 8,
    TWO_BLOCKS = 16,
    THREE_BLOCKS = 24,
    STRIDE = 6, /* from one window of three blocks to the next */
    SHARED_GAIN_Q8 = 299,
    MIN_BLOCKS = 12,
    HELD_Q8 = 8 * 256,         /* what a ratio counts at most: a block across a step has any */
    PLAIN_Q8 = 480,            /* mean ratio that own noise exceeds in 6 scans of 1000; its own is 0.98 */
    SHARED_LEAST_Q8 = 3 * 256, /* once there is a shared error decisions take it for at least so large, */
    STATED_LEAST_Q8 = 2 * 256, /* the covariance of lines for at least this, without their margin, */
    SHARED_MOST_Q8 = 4 * 256,  /* and at most: one scan knows it no better */
    SHARED_NONE_Q8 = 64,       /* where there is none some of it is left, for what the blocks do not show */
    OWN_PRIOR_POINTS = 100,    /* weight of the second differences beside the residuals of the runs */
    OWN_RUN_POINTS = 20,
    CALMER_Q16 = 64000, /* change of the own variance from which on breaks may show that did not before */
    LEAST_OWN_SCALE_Q16 = 180 << 8, /* the second differences are not so far off */
    MOST_OWN_SCALE_Q16 = 360 << 8
};

/* What no surface has: its square fits int64 with what it is multiplied by; (1 m)^2 the same. */
enum { MOST_DIFFERENCE_UM = 1 << 25 };
static const int64_t MOST_OWN_Q20 = (int64_t)1 << 40;

/* Of a block of beams that turns by 41 degrees, which is wider than any scanner's: times the sum of a block's
 * 1 / range it fits int64. */
enum { MOST_CURVATURE_Q30 = 1 << 29, HALF_Q30 = 1 << 29 };

/* Range in the middle of three blocks of points, the same from either side. */
static inline uint32_t middle_range_um(const ale_prepared_scan_t *scan, int64_t start)
{
    const int32_t *middle = &scan->points.range_um[start + THREE_BLOCKS / 2];
    return ((uint32_t)middle[-1] + (uint32_t)middle[0]) / 2;
}

/* Squared second difference of three blocks of points from start on, whose middle is at a range, over what
 * own noise would give; Q8. */
static inline int64_t block_ratio_q8(const ale_prepared_scan_t *scan, int64_t start, int64_t range_um,
                                     int64_t range_mm, int64_t curvature_q30)
{
    const int64_t *p = &scan->inverse_sum[start];
    const int64_t middle = p[TWO_BLOCKS] - p[BLOCK];
    const int64_t bend = (middle * curvature_q30 + HALF_Q30) >> 30;
    const int64_t d = p[THREE_BLOCKS] - p[0] - 3 * middle + bend;
    const int64_t d_um = ale_min64(ale_abs64(d * range_um / middle), MOST_DIFFERENCE_UM);
    const int64_t own_q20 =
        ale_min64(ale_scan_noise_own_q20(&scan->noise, range_mm * range_mm), MOST_OWN_Q20);
    return d_um * d_um * (BLOCK << 8) / ale_max64((own_q20 * 6000000) >> 20, 1);
}

/* What the windows of a scan show, over what own noise would give. */
typedef struct {
    int32_t count;
    int64_t range_mm; /* sums */
    int64_t held_q8;
    uint16_t ratio_q8[ALE_MAX_BEAMS]; /* a run has fewer windows than points */
} blocks_t;

static inline void add_block(const ale_prepared_scan_t *scan, int64_t start, int64_t curvature_q30,
                             blocks_t *blocks)
{
    const uint32_t range_um = middle_range_um(scan, start);
    const uint32_t range_mm = range_um / 1000;
    const int64_t ratio_q8 = block_ratio_q8(scan, start, range_um, range_mm, curvature_q30);
    blocks->held_q8 += ale_min64(ratio_q8, HELD_Q8);
    blocks->range_mm += range_mm;
    blocks->ratio_q8[blocks->count++] = (uint16_t)ale_min64(ratio_q8, UINT16_MAX);
}

static inline bool follow(const ale_points_t *points, int32_t first, int32_t last)
{
    return points->beam[last] - points->beam[first] == last - first;
}

/* Windows of a run from either end to the middle, where no beam is missing. */
static void add_blocks(const ale_prepared_scan_t *scan, const ale_run_t *run, int64_t curvature_q30,
                       blocks_t *blocks)
{
    const bool none_missing = follow(&scan->points, run->first, run->last);
    const int32_t last_window = run->last + 1 - THREE_BLOCKS;
    for (int32_t side = 0; side < 2; side++) {
        const int32_t stride = side == 0 ? STRIDE : -STRIDE;
        int32_t start = side == 0 ? run->first : last_window;
        for (int32_t k = run->first + side; k <= last_window; k += 2 * STRIDE) {
            if (none_missing || follow(&scan->points, start, start + THREE_BLOCKS - 1)) {
                add_block(scan, start, curvature_q30, blocks);
            }
            start += stride;
        }
    }
}

/* The ratio whose squares have the upper quartile of the measured ones. */
static int64_t quartile_ratio_q8(ale_scan_noise_t *noise, const blocks_t *blocks)
{
    uint16_t *bins = noise->histogram[0];
    memset(bins, 0, sizeof noise->histogram[0]);
    for (int32_t k = 0; k < blocks->count; k++) {
        bins[ale_histogram_bin(blocks->ratio_q8[k])]++;
    }
    /* three quarters of chi square of one degree are below 1.323 */
    return ale_histogram_quantile(bins, blocks->count, PERCENT) * 1000 / 1323;
}

/* The shared variance in units of the configured one, Q8: up to 256 where blocks show no more than own noise,
 * beyond it otherwise, and then what the covariance of lines states, too. */
static int64_t shared_scale_q8(ale_scan_noise_t *noise, const blocks_t *blocks)
{
    const int64_t mean_q8 = blocks->held_q8 / blocks->count;
    if (mean_q8 <= PLAIN_Q8) {
        return ale_clamp64(256 - 2 * (PLAIN_Q8 - mean_q8), SHARED_NONE_Q8, 256);
    }
    const int64_t range_mm = blocks->range_mm / blocks->count;
    const int64_t range_mm2 = range_mm * range_mm;
    const int64_t own_q20 = ale_scan_noise_own_q20(noise, range_mm2);
    const int64_t model_q20 =
        (noise->shared_prior_mm2_q36 + noise->shared_prior_relative_q36 * range_mm2) >> 16;
    const int64_t excess_q8 =
        (quartile_ratio_q8(noise, blocks) - 256) * 6 * 256 / ((int64_t)BLOCK * SHARED_GAIN_Q8);
    const int64_t measured_q8 = excess_q8 * own_q20 / ale_max64(model_q20, 1);
    noise->shared_stated_q8 = ale_clamp64(measured_q8, STATED_LEAST_Q8, SHARED_MOST_Q8);
    return ale_clamp64(measured_q8, SHARED_LEAST_Q8, SHARED_MOST_Q8);
}

static void scale_shared_of_runs(ale_run_list_t *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        r->run[k].fit.shared_q8 = (r->run[k].fit.shared_q8 * r->scan.noise.shared_scale_q8) >> 8;
    }
}

bool ale_run_noise_measure_shared(ale_run_list_t *r, int32_t step_bam)
{
    const int64_t turn_q30 = 2 * (((int64_t)1 << 30) - ale_cos_q30((uint32_t)step_bam * BLOCK));
    const int64_t curvature_q30 = ale_min64(turn_q30, MOST_CURVATURE_Q30);
    blocks_t blocks;
    blocks.count = 0;
    blocks.range_mm = 0;
    blocks.held_q8 = 0;
    for (int32_t k = 0; k < r->count; k++) {
        add_blocks(&r->scan, &r->run[k], curvature_q30, &blocks);
    }
    r->scan.noise.shared_stated_q8 = 256;
    r->scan.noise.shared_scale_q8 =
        blocks.count < MIN_BLOCKS ? 256 : shared_scale_q8(&r->scan.noise, &blocks);
    r->scan.noise.shared_absent = blocks.count >= MIN_BLOCKS && r->scan.noise.shared_scale_q8 <= 256;
    r->scan.noise.shared_mm2_q36 = (r->scan.noise.shared_prior_mm2_q36 * r->scan.noise.shared_scale_q8) >> 8;
    r->scan.noise.shared_relative_q36 =
        (r->scan.noise.shared_prior_relative_q36 * r->scan.noise.shared_scale_q8) >> 8;
    if (r->scan.noise.shared_absent) {
        scale_shared_of_runs(r);
    }
    return r->scan.noise.shared_scale_q8 > 256;
}

/* The own variance in units of the one that the second differences show, by the residuals of the runs; Q16.
 */
static int64_t own_scale_q16(ale_run_list_t *r)
{
    int64_t chi_q8 = 0;
    int64_t freedom = OWN_PRIOR_POINTS;
    for (int32_t k = 0; k < r->count; k++) {
        const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, &r->run[k]);
        const int64_t fit_chi_q8 = ale_fit_chi_q8(fit);
        if (fit->n >= OWN_RUN_POINTS && fit_chi_q8 < r->chi_high_q8[fit->n]) {
            chi_q8 += fit_chi_q8;
            freedom += fit->n - 2;
        }
    }
    const int64_t sum_q8 = ((chi_q8 * r->scan.noise.own_scale_q16) >> 16) + (int64_t)OWN_PRIOR_POINTS * 256;
    return ale_clamp64((sum_q8 << 8) / freedom, LEAST_OWN_SCALE_Q16, MOST_OWN_SCALE_Q16);
}

void ale_run_noise_refine_own(ale_run_list_t *r)
{
    if (r->scan.noise.shared_scale_q8 > 256) {
        return;
    }
    const int64_t scale_q16 = own_scale_q16(r);
    const int64_t change_q16 = (scale_q16 << 16) / r->scan.noise.own_scale_q16;
    r->scan.noise.own_scale_q16 = scale_q16;
    for (int32_t k = 0; k < r->count; k++) {
        ale_run_t *run = &r->run[k];
        run->fit.var_q8 = ale_max64((run->fit.var_q8 * change_q16) >> 16, 1);
        run->no_break = run->no_break && change_q16 >= CALMER_Q16;
    }
}
