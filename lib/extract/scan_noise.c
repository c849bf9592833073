#include "extract/scan_noise.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    OCTAVE_BASE = 14, /* 2^14 um is just below the shortest range */
    OCTAVES = ALE_NOISE_OCTAVES,
    DIFFERENCE_STRIDE = 3,
    MIN_SAMPLES = 20, /* fewer second differences of one octave are not used */
    PERCENT = 75,     /* a quantile of the Gauss curve that is known better than the median */
    QUARTILE_PER_MILLE = 2818,
    SIGMA_BITS = 4,
    MOST_MISFIT = 16,         /* variances that an octave's own one may be */
    CLUTTER_FACTOR = 2,       /* 3.4 deviations of what the quartile of MIN_SAMPLES is off by chance */
    MOST_STEPS_Q8 = 64 * 256, /* from one beam to one of the next 8: more is no mirror's */
    ROW_BITS = 20,            /* of the rows of the fit: variances of one scan differ a hundredfold */
    NORMAL_BITS = 19          /* of its normal equations: their products fit int64 */
};
/* The least and the most own noise that is believed, um. */
enum { SIGMA_FLOOR_UM = 400, SIGMA_MOST_UM = 100000 };
/* Of beams 2 rad apart: times 1 / range it fits int64. */
static const int64_t MOST_BEND_Q30 = (int64_t)4 << 30;
static const int64_t micro_q36 = 68719;    /* 2^36 / 10^6 */
static const int64_t micro2_q60 = 1152922; /* 2^60 / 10^12 */
static const int64_t most_square_q60 = (int64_t)1 << 29;
static const int64_t nrad2_per_rad2 = 1000000000000000000;

typedef struct {
    int32_t samples;
    int64_t range_um; /* mean */
    int64_t sigma_q4; /* um */
} octave_t;

/* Of the second differences in each octave. */
typedef struct {
    int32_t samples[OCTAVES];
    int64_t range_um[OCTAVES];
} octave_sums_t;

/* A second difference of 1/r about a point of this range, as a range, um Q4: it times the squared range, in
 * two steps. What is 64 times the range or more is held at that. */
static inline uint64_t as_range_q4(int64_t difference_q44, int64_t range_um)
{
    const int64_t relative_q30 = ale_min64((ale_abs64(difference_q44) * range_um) >> 14, (int64_t)64 << 30);
    return (uint64_t)((relative_q30 * range_um) >> (30 - SIGMA_BITS));
}

static inline void count_difference(ale_scan_noise_t *noise, int64_t difference_q44, int64_t range_um,
                                    octave_sums_t *sums)
{
    /* a range has the bit of the least one or a higher one: it is never 0, which a bit length asks for */
    const uint32_t k = ale_bit_length((uint32_t)range_um | ALE_MIN_RANGE_UM) - 1 - OCTAVE_BASE;
    noise->histogram[k][ale_histogram_bin(as_range_q4(difference_q44, range_um))]++;
    sums->samples[k]++;
    sums->range_um[k] += range_um;
}

/* The second difference about point i, where its neighbours are the next beams. */
static inline void count_next(ale_scan_noise_t *noise, const ale_points_t *p, int32_t i,
                              int64_t curvature_q30, octave_sums_t *sums)
{
    if (p->beam[i + 1] - p->beam[i - 1] == 2) {
        const int64_t twice_q30 = (int64_t)2 << 30;
        const int64_t neighbours = (int64_t)p->inverse_q44[i - 1] + p->inverse_q44[i + 1];
        const int64_t d = neighbours + (p->inverse_q44[i] * (curvature_q30 - twice_q30) >> 30);
        count_difference(noise, d, p->range_um[i], sums);
    }
}

/* The same over beams without an echo. Neighbours left and right beams away weigh by each other's distance;
 * the difference then has at most 7 / 6 of the deviation that it has among next beams. */
static void count_over_gaps(ale_scan_noise_t *noise, const ale_points_t *p, int32_t i, int64_t curvature_q30,
                            octave_sums_t *sums)
{
    const int64_t left = p->beam[i] - p->beam[i - 1];
    const int64_t right = p->beam[i + 1] - p->beam[i];
    if (left <= ALE_MAX_GAP_BEAMS && right <= ALE_MAX_GAP_BEAMS) {
        const int64_t q = p->inverse_q44[i];
        const int64_t neighbours = right * p->inverse_q44[i - 1] + left * p->inverse_q44[i + 1];
        const int64_t bend_q30 = ale_min64(left * right * curvature_q30, MOST_BEND_Q30);
        const int64_t d = 2 * neighbours / (left + right) - 2 * q + (q * bend_q30 >> 30);
        count_difference(noise, d, p->range_um[i], sums);
    }
}

/* From point i to the next one, in steps from beam to beam; Q8. */
static int64_t steps_q8(const ale_scan_t *scan, const ale_points_t *p, int32_t i)
{
    const int64_t ahead_bam = ale_bam_diff(ale_scan_bearing(scan, ale_points_beam(p, i + 1)),
                                           ale_scan_bearing(scan, ale_points_beam(p, i)));
    return ale_clamp64(ahead_bam * 256 / scan->step_bam, 0, MOST_STEPS_Q8);
}

/* The same where beams have bearings of their own: each neighbour weighs by the other's distance. */
static void count_between(ale_scan_noise_t *noise, const ale_scan_t *scan, const ale_points_t *p, int32_t i,
                          int64_t curvature_q30, octave_sums_t *sums)
{
    const int32_t most = p->sparse ? ALE_MAX_GAP_BEAMS : 1;
    const int64_t left = steps_q8(scan, p, i - 1);
    const int64_t right = steps_q8(scan, p, i);
    if (left + right > 0 && p->beam[i] - p->beam[i - 1] <= most && p->beam[i + 1] - p->beam[i] <= most) {
        const int64_t q = p->inverse_q44[i];
        const int64_t neighbours = right * p->inverse_q44[i - 1] + left * p->inverse_q44[i + 1];
        const int64_t bend_q30 = ale_min64(left * right * curvature_q30 >> 16, MOST_BEND_Q30);
        const int64_t d = 2 * neighbours / (left + right) - 2 * q + (q * bend_q30 >> 30);
        count_difference(noise, d, p->range_um[i], sums);
    }
}

/* Every STRIDE-th difference, from both ends to the middle: neighbouring ones share two of three points. */
static void collect_between(ale_scan_noise_t *noise, const ale_scan_t *scan, const ale_points_t *p,
                            int64_t curvature_q30, octave_sums_t *sums)
{
    const int32_t stride = p->sparse ? 1 : DIFFERENCE_STRIDE;
    int32_t i = 1;
    int32_t j = p->count - 2;
    for (; i < j; i += stride, j -= stride) {
        count_between(noise, scan, p, i, curvature_q30, sums);
        count_between(noise, scan, p, j, curvature_q30, sums);
    }
    if (i == j) {
        count_between(noise, scan, p, i, curvature_q30, sums);
    }
}

static void collect_next(ale_scan_noise_t *noise, const ale_points_t *p, int64_t curvature_q30,
                         octave_sums_t *sums)
{
    int32_t i = 1;
    int32_t j = p->count - 2;
    for (; i < j; i += DIFFERENCE_STRIDE, j -= DIFFERENCE_STRIDE) {
        count_next(noise, p, i, curvature_q30, sums);
        count_next(noise, p, j, curvature_q30, sums);
    }
    if (i == j) {
        count_next(noise, p, i, curvature_q30, sums);
    }
}

static void collect_over_gaps(ale_scan_noise_t *noise, const ale_points_t *p, int64_t curvature_q30,
                              octave_sums_t *sums)
{
    for (int32_t i = 1; i + 1 < p->count; i++) {
        count_over_gaps(noise, p, i, curvature_q30, sums);
    }
}

/* Second differences about every third point; in a sparse scan about all, over the gaps. */
static int32_t collect(ale_scan_noise_t *noise, const ale_scan_t *scan, const ale_points_t *p,
                       octave_t octave[OCTAVES])
{
    const int64_t curvature_q30 = 2 * (((int64_t)1 << 30) - ale_cos_q30((uint32_t)scan->step_bam));
    memset(noise->histogram, 0, sizeof noise->histogram);
    octave_sums_t all = {0};
    octave_sums_t *sums = &all;
    if (scan->own_bearings && scan->step_bam != 0) {
        collect_between(noise, scan, p, curvature_q30, sums);
    } else if (p->sparse) {
        collect_over_gaps(noise, p, curvature_q30, sums);
    } else {
        collect_next(noise, p, curvature_q30, sums);
    }
    int32_t used = 0;
    for (uint32_t k = 0; k < OCTAVES; k++) {
        if (all.samples[k] >= MIN_SAMPLES) {
            /* three quarters of |d| are below 1.1503 sqrt(6) sigma */
            const int64_t quartile_q4 = ale_histogram_quantile(noise->histogram[k], all.samples[k], PERCENT);
            octave[used].sigma_q4 = ale_clamp64(ale_round_div(quartile_q4 * 1000, QUARTILE_PER_MILLE),
                                                SIGMA_FLOOR_UM << SIGMA_BITS, SIGMA_MOST_UM << SIGMA_BITS);
            octave[used].range_um = all.range_um[k] / all.samples[k];
            octave[used].samples = all.samples[k];
            used++;
        }
    }
    return used;
}

/* What the model sigma^2 = a + b r^2, or a + b r^4 where the scanner triangulates, is fitted to. */
typedef struct {
    const octave_t *octave;
    int32_t used;
    bool squared;
    int64_t variance_q8[OCTAVES]; /* in units of which an octave's misfit counts */
    int64_t var_unit_q8;          /* the least of them */
    int64_t range_unit_um;        /* the largest range */
} octaves_t;

typedef struct {
    int64_t a_q15; /* in units of var_unit */
    int64_t b_q15; /* in units of var_unit / range_unit^2, or range_unit^4 */
} noise_model_t;

/* What b is multiplied by, at a range of an octave. */
static int64_t growth(const octaves_t *o, int32_t k, int32_t bits)
{
    const int64_t r = (o->octave[k].range_um << bits) / o->range_unit_um;
    const int64_t r2 = (r * r) >> bits;
    return o->squared ? (r2 * r2) >> bits : r2;
}

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
        const int64_t t = (p * growth(o, k, ROW_BITS)) >> ROW_BITS;
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

/* Noise does not fall with the range, and rises no faster than it, or where the scanner triangulates than its
 * square. An octave that says more than this allows beside a better known one has changes of the range for
 * noise: clutter. */
static bool shows_clutter(const octave_t *octave, const octave_t *other, bool squared)
{
    const int64_t farther_um = ale_max64(octave->range_um, other->range_um);
    const int64_t allowed_q4 =
        squared ? ale_mul_div(other->sigma_q4, farther_um, other->range_um) : other->sigma_q4;
    return octave->samples < other->samples &&
           octave->sigma_q4 * other->range_um > CLUTTER_FACTOR * allowed_q4 * farther_um;
}

/* Puts the octaves that are no clutter beside the best known one first, and says how many they are. */
static int32_t leave_clutter_out(octave_t *octave, int32_t used, bool squared)
{
    int32_t best_known = 0;
    for (int32_t k = 1; k < used; k++) {
        best_known = octave[k].samples > octave[best_known].samples ? k : best_known;
    }
    const octave_t best = octave[best_known];
    int32_t kept = 0;
    for (int32_t k = 0; k < used; k++) {
        if (!shows_clutter(&octave[k], &best, squared)) {
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
static void measure_own(ale_scan_noise_t *noise, const octave_t *octave, int32_t used)
{
    octaves_t o = {.octave = octave, .used = used, .squared = noise->own_square_q60 > 0, .range_unit_um = 1};
    for (int32_t k = 0; k < used; k++) {
        o.variance_q8[k] = octave[k].sigma_q4 * octave[k].sigma_q4;
        o.range_unit_um = ale_max64(o.range_unit_um, octave[k].range_um);
    }
    set_variance_unit(&o);
    const noise_model_t first = fit_model(&o);
    for (int32_t k = 0; k < used; k++) {
        const int64_t times_q15 = first.a_q15 + ((first.b_q15 * growth(&o, k, 15)) >> 15);
        o.variance_q8[k] = ale_max64((o.var_unit_q8 * times_q15) >> 15, 1);
    }
    set_variance_unit(&o);
    const noise_model_t m = fit_model(&o);
    noise->own_mm2_q36 = ((m.a_q15 * o.var_unit_q8) >> 15) * micro_q36 >> (2 * SIGMA_BITS);
    noise->own_relative_q36 =
        ale_mul_div((m.b_q15 * o.var_unit_q8) >> 15, (int64_t)1 << (36 - 2 * SIGMA_BITS),
                    o.range_unit_um * o.range_unit_um);
    if (o.squared) {
        const int64_t range_mm = ale_max64(o.range_unit_um / 1000, 1);
        noise->own_square_q60 = ale_clamp64(
            ale_mul_div(noise->own_relative_q36, 1 << 24, range_mm * range_mm), 1, most_square_q60);
        noise->own_relative_q36 = 0;
    }
}

static int64_t farthest_um(const ale_points_t *p)
{
    int32_t most_um = 0;
    for (int32_t i = 0; i < p->count; i++) {
        most_um = p->range_um[i] > most_um ? p->range_um[i] : most_um;
    }
    return most_um;
}

void ale_scan_noise_measure(ale_scan_noise_t *noise, const ale_noise_t *prior, const ale_points_t *points,
                            const ale_scan_t *scan)
{
    noise->own_mm2_q36 = (int64_t)prior->own_um * prior->own_um * micro_q36;
    noise->own_scale_q16 = 1 << 16;
    noise->own_relative_q36 = (int64_t)prior->own_ppm * prior->own_ppm * micro_q36 / 1000000;
    noise->own_square_q60 = (int64_t)prior->own_ppm_per_m * prior->own_ppm_per_m * micro2_q60 / 1000000;
    noise->shared_mm2_q36 = (int64_t)prior->shared_um * prior->shared_um * micro_q36;
    noise->shared_relative_q36 = (int64_t)prior->shared_ppm * prior->shared_ppm * micro_q36 / 1000000;
    noise->shared_prior_mm2_q36 = noise->shared_mm2_q36;
    noise->shared_prior_relative_q36 = noise->shared_relative_q36;
    noise->bearing_rad2_q36 =
        ale_mul_div((int64_t)prior->bearing_nrad * prior->bearing_nrad, (int64_t)1 << 36, nrad2_per_rad2);
    noise->shared_beams = prior->shared_beams;
    noise->bearing_nrad = prior->bearing_nrad;
    octave_t octave[OCTAVES];
    const int32_t used = collect(noise, scan, points, octave);
    if (used > 0) {
        measure_own(noise, octave, leave_clutter_out(octave, used, noise->own_square_q60 > 0));
    }
    noise->sigma_um = ((int64_t)ale_isqrt((uint64_t)noise->own_mm2_q36) * 1000) >> 18;
    noise->sigma_per_range_q20 = (int64_t)ale_isqrt((uint64_t)noise->own_relative_q36 << 24) >> 10;
    if (noise->own_square_q60 > 0) {
        const int64_t farthest_mm = farthest_um(points) / 1000;
        noise->sigma_per_range_q20 += (farthest_mm * ale_isqrt((uint64_t)noise->own_square_q60)) >> 10;
    }
}
