#include "extract/scan_noise.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "extract/histogram.h"
#include "extract/moments.h"

enum {
    OCTAVE_BASE = 14, /* 2^14 um is just below the shortest range */
    OCTAVES = 14,
    DIFFERENCE_STRIDE = 3,
    MIN_SAMPLES = 20, /* fewer second differences of one octave are not used */
    PERCENT = 75,     /* a quantile of the Gauss curve that is known better than the median */
    QUARTILE_PER_MILLE = 2818,
    SIGMA_BITS = 4,
    MOST_MISFIT = 16,   /* variances that an octave's own one may be */
    CLUTTER_FACTOR = 2, /* 3.4 deviations of what the quartile of MIN_SAMPLES is off by chance */
    ROW_BITS = 20,      /* of the rows of the fit: variances of one scan differ a hundredfold */
    NORMAL_BITS = 19    /* of its normal equations: their products fit int64 */
};
static const int64_t micro_q36 = 68719; /* 2^36 / 10^6 */
static const int64_t nrad2_per_rad2 = 1000000000000000000;

typedef struct {
    int32_t samples;
    int64_t range_um; /* sum, later mean */
    int64_t sigma_q4; /* um */
} octave_t;

/* Second difference of 1/r about point i, as a range, um Q4: it times the squared range, in two steps. What
 * is 64 times the range or more is held at that. */
static inline uint64_t second_difference_q4(const ale_extractor_t *e, int32_t i, int64_t curvature_q30)
{
    const int64_t q = e->inverse_q44[i];
    const int64_t d =
        (int64_t)e->inverse_q44[i - 1] + e->inverse_q44[i + 1] - 2 * q + (q * curvature_q30 >> 30);
    const int64_t range_um = e->range_um[i];
    const int64_t relative_q30 = ale_min64((ale_abs64(d) * range_um) >> 14, (int64_t)64 << 30);
    return (uint64_t)((relative_q30 * range_um) >> (30 - SIGMA_BITS));
}

static inline void count_difference(ale_extractor_t *e, int32_t i, int64_t curvature_q30, octave_t *octave)
{
    if (e->beam[i + 1] - e->beam[i - 1] == 2) {
        const uint32_t k = 31 - OCTAVE_BASE - (uint32_t)__builtin_clz((uint32_t)e->range_um[i]);
        e->histogram[k][ale_histogram_bin(second_difference_q4(e, i, curvature_q30))]++;
        octave[k].samples++;
        octave[k].range_um += e->range_um[i];
    }
}

/* Every STRIDE-th difference, from both ends to the middle: neighbouring ones share two of three points. */
static int32_t collect(ale_extractor_t *e, int64_t curvature_q30, octave_t octave[OCTAVES])
{
    memset(e->histogram, 0, sizeof e->histogram);
    memset(octave, 0, OCTAVES * sizeof *octave);
    int32_t i = 1;
    int32_t j = e->count - 2;
    for (; i < j; i += DIFFERENCE_STRIDE, j -= DIFFERENCE_STRIDE) {
        count_difference(e, i, curvature_q30, octave);
        count_difference(e, j, curvature_q30, octave);
    }
    if (i == j) {
        count_difference(e, i, curvature_q30, octave);
    }
    int32_t used = 0;
    for (uint32_t k = 0; k < OCTAVES; k++) {
        if (octave[k].samples >= MIN_SAMPLES) {
            /* three quarters of |d| are below 1.1503 sqrt(6) sigma */
            const int64_t quartile_q4 = ale_histogram_quantile(e->histogram[k], octave[k].samples, PERCENT);
            octave[used].sigma_q4 =
                ale_clamp64(ale_round_div(quartile_q4 * 1000, QUARTILE_PER_MILLE),
                            ALE_SIGMA_FLOOR_UM << SIGMA_BITS, ALE_SIGMA_MOST_UM << SIGMA_BITS);
            octave[used].range_um = octave[k].range_um / octave[k].samples;
            octave[used].samples = octave[k].samples;
            used++;
        }
    }
    return used;
}

/* What the model sigma^2 = a + b r^2 is fitted to. */
typedef struct {
    const octave_t *octave;
    int32_t used;
    int64_t variance_q8[OCTAVES]; /* in units of which an octave's misfit counts */
    int64_t var_unit_q8;          /* the least of them */
    int64_t range_unit_um;        /* the largest range */
} octaves_t;

typedef struct {
    int64_t a_q15; /* in units of var_unit */
    int64_t b_q15; /* in units of var_unit / range_unit^2 */
} noise_model_t;

/* Least squares of the misfits, weighted by the samples; a, b >= 0. */
static noise_model_t fit_model(const octaves_t *o)
{
    int64_t pp = 0;
    int64_t pt = 0;
    int64_t tt = 0;
    int64_t py = 0;
    int64_t ty = 0;
    for (int32_t k = 0; k < o->used; k++) {
        const octave_t *octave = &o->octave[k];
        const int64_t p = (o->var_unit_q8 << ROW_BITS) / o->variance_q8[k];
        const int64_t r = (octave->range_um << ROW_BITS) / o->range_unit_um;
        const int64_t t = (p * ((r * r) >> ROW_BITS)) >> ROW_BITS;
        const int64_t y = ale_min64((octave->sigma_q4 * octave->sigma_q4 << ROW_BITS) / o->variance_q8[k],
                                    (int64_t)MOST_MISFIT << ROW_BITS);
        const int64_t n = octave->samples;
        pp += n * p * p;
        pt += n * p * t;
        tt += n * t * t;
        py += n * p * y;
        ty += n * t * y;
    }
    pp >>= 2 * ROW_BITS - NORMAL_BITS;
    pt >>= 2 * ROW_BITS - NORMAL_BITS;
    tt >>= 2 * ROW_BITS - NORMAL_BITS;
    py >>= 2 * ROW_BITS - NORMAL_BITS;
    ty >>= 2 * ROW_BITS - NORMAL_BITS;
    const int64_t det = pp * tt - pt * pt;
    if (det > pp * tt / 64) {
        const int64_t det_q15 = ale_max64(det >> 15, 1);
        const noise_model_t both = {(py * tt - ty * pt) / det_q15, (ty * pp - py * pt) / det_q15};
        if (both.a_q15 < 0) {
            return (noise_model_t){0, ty * (1 << 15) / ale_max64(tt, 1)};
        }
        if (both.b_q15 >= 0) {
            return both;
        }
    }
    return (noise_model_t){py * (1 << 15) / ale_max64(pp, 1), 0};
}

/* Noise does not fall with the range, and rises no faster than it. An octave that says more than this allows
 * beside a better known one has changes of the range for noise: clutter. */
static bool shows_clutter(const octave_t *octave, const octave_t *other)
{
    return octave->samples < other->samples &&
           octave->sigma_q4 * other->range_um >
               CLUTTER_FACTOR * other->sigma_q4 * ale_max64(octave->range_um, other->range_um);
}

/* Puts the octaves that are no clutter beside the best known one first, and says how many they are. */
static int32_t leave_clutter_out(octave_t *octave, int32_t used)
{
    int32_t best_known = 0;
    for (int32_t k = 1; k < used; k++) {
        best_known = octave[k].samples > octave[best_known].samples ? k : best_known;
    }
    const octave_t best = octave[best_known];
    int32_t kept = 0;
    for (int32_t k = 0; k < used; k++) {
        if (!shows_clutter(&octave[k], &best)) {
            octave[kept++] = octave[k];
        }
    }
    return kept;
}

static void set_variance_unit(octaves_t *o)
{
    o->var_unit_q8 = INT64_MAX;
    for (int32_t k = 0; k < o->used; k++) {
        o->var_unit_q8 = ale_min64(o->var_unit_q8, o->variance_q8[k]);
    }
}

/* The model through the octaves, and once more with each misfit in units of what the first model says: in
 * units of its own variance an octave of few points that are near each other by chance would count most. */
static void measure_own(ale_extractor_t *e, const octave_t *octave, int32_t used)
{
    octaves_t o = {.octave = octave, .used = used, .range_unit_um = 1};
    for (int32_t k = 0; k < used; k++) {
        o.variance_q8[k] = octave[k].sigma_q4 * octave[k].sigma_q4;
        o.range_unit_um = ale_max64(o.range_unit_um, octave[k].range_um);
    }
    set_variance_unit(&o);
    const noise_model_t first = fit_model(&o);
    for (int32_t k = 0; k < used; k++) {
        const int64_t r_q15 = (octave[k].range_um << 15) / o.range_unit_um;
        const int64_t times_q15 = first.a_q15 + ((first.b_q15 * ((r_q15 * r_q15) >> 15)) >> 15);
        o.variance_q8[k] = ale_max64((o.var_unit_q8 * times_q15) >> 15, 1);
    }
    set_variance_unit(&o);
    const noise_model_t m = fit_model(&o);
    e->noise.own_mm2_q36 = ((m.a_q15 * o.var_unit_q8) >> 15) * micro_q36 >> (2 * SIGMA_BITS);
    e->noise.own_relative_q36 =
        ale_mul_div((m.b_q15 * o.var_unit_q8) >> 15, (int64_t)1 << (36 - 2 * SIGMA_BITS),
                    o.range_unit_um * o.range_unit_um);
}

void ale_scan_noise_measure(ale_extractor_t *e, const ale_scan_t *scan)
{
    const ale_noise_t *prior = &e->config.noise;
    e->noise.own_mm2_q36 = (int64_t)prior->own_um * prior->own_um * micro_q36;
    e->noise.own_scale_q16 = 1 << 16;
    e->noise.own_relative_q36 = (int64_t)prior->own_ppm * prior->own_ppm * micro_q36 / 1000000;
    e->noise.shared_mm2_q36 = (int64_t)prior->shared_um * prior->shared_um * micro_q36;
    e->noise.shared_relative_q36 = (int64_t)prior->shared_ppm * prior->shared_ppm * micro_q36 / 1000000;
    e->shared_prior_mm2_q36 = e->noise.shared_mm2_q36;
    e->shared_prior_relative_q36 = e->noise.shared_relative_q36;
    e->noise.bearing_rad2_q36 =
        ale_mul_div((int64_t)prior->bearing_nrad * prior->bearing_nrad, (int64_t)1 << 36, nrad2_per_rad2);
    octave_t octave[OCTAVES];
    const int64_t curvature_q30 = 2 * (((int64_t)1 << 30) - ale_cos_q30((uint32_t)scan->step_bam));
    const int32_t used = collect(e, curvature_q30, octave);
    if (used > 0) {
        measure_own(e, octave, leave_clutter_out(octave, used));
    }
    e->noise.sigma_um = ((int64_t)ale_isqrt((uint64_t)e->noise.own_mm2_q36) * 1000) >> 18;
    e->noise.sigma_per_range_q20 = (int64_t)ale_isqrt((uint64_t)e->noise.own_relative_q36 << 24) >> 10;
}

/* Blocks of beams whose second difference shows what neighbours share, for an error that is correlated
 * over 12 beams: the block means of pure own noise have 6 / BLOCK own variances, of the shared part
 * SHARED_GAIN_Q8 shared ones. */
enum {
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

/* Range in the middle of three blocks of points, the same from either side. */
static int64_t middle_range_um(const ale_extractor_t *e, int32_t start)
{
    const int32_t *middle = &e->range_um[start + THREE_BLOCKS / 2];
    return ((int64_t)middle[-1] + middle[0]) / 2;
}

/* Squared second difference of three blocks of points from start on, over what own noise would give; Q8. */
static int64_t block_ratio_q8(const ale_extractor_t *e, int32_t start, int64_t curvature_q30)
{
    const int64_t *p = &e->inverse_sum[start];
    const int64_t middle = p[TWO_BLOCKS] - p[BLOCK];
    const int64_t d = p[THREE_BLOCKS] - p[0] - 3 * middle + ale_round_shift(middle * curvature_q30, 30);
    const int64_t range_um = middle_range_um(e, start);
    const int64_t d_um = d * range_um / middle;
    const int64_t range_mm = range_um / 1000;
    const int64_t own_q20 = (e->noise.own_mm2_q36 + e->noise.own_relative_q36 * range_mm * range_mm) >> 16;
    return d_um * d_um * (BLOCK << 8) / ale_max64((own_q20 * 6000000) >> 20, 1);
}

/* What the windows of a scan show, over what own noise would give. */
typedef struct {
    int32_t count;
    int64_t range_mm; /* sums */
    int64_t held_q8;
    uint16_t ratio_q8[ALE_MAX_BEAMS]; /* a run has fewer windows than points */
} blocks_t;

static void look_at_block(const ale_extractor_t *e, int32_t start, int64_t curvature_q30, blocks_t *blocks)
{
    if (e->beam[start + THREE_BLOCKS - 1] - e->beam[start] == THREE_BLOCKS - 1) {
        const int64_t ratio_q8 = block_ratio_q8(e, start, curvature_q30);
        blocks->held_q8 += ale_min64(ratio_q8, HELD_Q8);
        blocks->range_mm += middle_range_um(e, start) / 1000;
        blocks->ratio_q8[blocks->count++] = (uint16_t)ale_min64(ratio_q8, UINT16_MAX);
    }
}

/* The ratio whose squares have the upper quartile of the measured ones. */
static int64_t quartile_ratio_q8(ale_extractor_t *e, const blocks_t *blocks)
{
    uint16_t *bins = e->histogram[0];
    memset(bins, 0, sizeof e->histogram[0]);
    for (int32_t k = 0; k < blocks->count; k++) {
        bins[ale_histogram_bin(blocks->ratio_q8[k])]++;
    }
    /* three quarters of chi square of one degree are below 1.323 */
    return ale_histogram_quantile(bins, blocks->count, PERCENT) * 1000 / 1323;
}

/* The shared variance in units of the configured one, Q8: up to 256 where blocks show no more than own noise,
 * beyond it otherwise, and then what the covariance of lines states, too. */
static int64_t shared_scale_q8(ale_extractor_t *e, const blocks_t *blocks)
{
    const int64_t mean_q8 = blocks->held_q8 / blocks->count;
    if (mean_q8 <= PLAIN_Q8) {
        return ale_clamp64(256 - 2 * (PLAIN_Q8 - mean_q8), SHARED_NONE_Q8, 256);
    }
    const int64_t range_mm = blocks->range_mm / blocks->count;
    const int64_t range_mm2 = range_mm * range_mm;
    const int64_t own_q20 = (e->noise.own_mm2_q36 + e->noise.own_relative_q36 * range_mm2) >> 16;
    const int64_t model_q20 = (e->shared_prior_mm2_q36 + e->shared_prior_relative_q36 * range_mm2) >> 16;
    const int64_t excess_q8 =
        (quartile_ratio_q8(e, blocks) - 256) * 6 * 256 / ((int64_t)BLOCK * SHARED_GAIN_Q8);
    const int64_t measured_q8 = excess_q8 * own_q20 / ale_max64(model_q20, 1);
    e->shared_stated_q8 = ale_clamp64(measured_q8, STATED_LEAST_Q8, SHARED_MOST_Q8);
    return ale_clamp64(measured_q8, SHARED_LEAST_Q8, SHARED_MOST_Q8);
}

static void scale_shared_of_runs(ale_extractor_t *e)
{
    for (int32_t k = 0; k < e->run_count; k++) {
        e->run[k].fit.shared_q8 = (e->run[k].fit.shared_q8 * e->shared_scale_q8) >> 8;
    }
}

bool ale_scan_noise_measure_shared(ale_extractor_t *e, const ale_scan_t *scan)
{
    const int64_t curvature_q30 = 2 * (((int64_t)1 << 30) - ale_cos_q30((uint32_t)scan->step_bam * BLOCK));
    blocks_t blocks;
    blocks.count = 0;
    blocks.range_mm = 0;
    blocks.held_q8 = 0;
    for (int32_t k = 0; k < e->run_count; k++) {
        const int32_t windows = e->run[k].last + 1 - e->run[k].first - 3 * BLOCK + 1;
        for (int32_t o = 0; 2 * o < windows; o += STRIDE) {
            look_at_block(e, e->run[k].first + o, curvature_q30, &blocks);
            if (2 * o + 1 < windows) {
                look_at_block(e, e->run[k].first + windows - 1 - o, curvature_q30, &blocks);
            }
        }
    }
    e->shared_stated_q8 = 256;
    e->shared_scale_q8 = blocks.count < MIN_BLOCKS ? 256 : shared_scale_q8(e, &blocks);
    e->shared_absent = blocks.count >= MIN_BLOCKS && e->shared_scale_q8 <= 256;
    e->noise.shared_mm2_q36 = (e->shared_prior_mm2_q36 * e->shared_scale_q8) >> 8;
    e->noise.shared_relative_q36 = (e->shared_prior_relative_q36 * e->shared_scale_q8) >> 8;
    if (e->shared_absent) {
        scale_shared_of_runs(e);
    }
    return e->shared_scale_q8 > 256;
}

/* The own variance in units of the one that the second differences show, by the residuals of the runs; Q16.
 */
static int64_t own_scale_q16(ale_extractor_t *e)
{
    int64_t chi_q8 = 0;
    int64_t freedom = OWN_PRIOR_POINTS;
    for (int32_t k = 0; k < e->run_count; k++) {
        const ale_run_fit_t *fit = ale_fit_of_run(e, &e->run[k]);
        const int64_t fit_chi_q8 = ale_fit_chi_q8(fit);
        if (fit->n >= OWN_RUN_POINTS && fit_chi_q8 < e->chi_high_q8[fit->n]) {
            chi_q8 += fit_chi_q8;
            freedom += fit->n - 2;
        }
    }
    const int64_t sum_q8 = ((chi_q8 * e->noise.own_scale_q16) >> 16) + (int64_t)OWN_PRIOR_POINTS * 256;
    return ale_clamp64((sum_q8 << 8) / freedom, LEAST_OWN_SCALE_Q16, MOST_OWN_SCALE_Q16);
}

void ale_scan_noise_refine_own(ale_extractor_t *e)
{
    if (e->shared_scale_q8 > 256) {
        return;
    }
    const int64_t scale_q16 = own_scale_q16(e);
    const int64_t change_q16 = (scale_q16 << 16) / e->noise.own_scale_q16;
    e->noise.own_scale_q16 = scale_q16;
    for (int32_t k = 0; k < e->run_count; k++) {
        ale_run_t *run = &e->run[k];
        run->fit.var_q8 = ale_max64((run->fit.var_q8 * change_q16) >> 16, 1);
        run->no_break = run->no_break && change_q16 >= CALMER_Q16;
    }
}
