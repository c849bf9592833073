/* Working memory of the extractor, and the numbers its stages share. For lib/extract only.
 *
 * The stages work on points: the beams that have a value, in beam order, numbered from 0 without gaps.
 * A run is a range of points, both ends included. */
#ifndef ALE_EXTRACT_WORKSPACE_H
#define ALE_EXTRACT_WORKSPACE_H

#include "extract/extract.h"
#include "extract/histogram.h"
#include "extract/lowess.h"

/* Points are 1/16 mm: Q4. The largest product of the fits is 2 n^2 max^2 (see moments.h). */
#define ALE_POINT_SHIFT 4
#define ALE_POINT_MAX_Q4 ((int64_t)(ALE_MAX_RANGE_UM / 1000) << ALE_POINT_SHIFT)

/* Nearer than this no scanner measures, and 2^44 / range would not fit. */
#define ALE_MIN_RANGE_UM 16384

/* The least and the most own noise that is believed. */
#define ALE_SIGMA_FLOOR_UM 400
#define ALE_SIGMA_MOST_UM 100000

/* No variance is believed to exceed (9 % of the range)^2: Q36 of the squared range. */
#define ALE_MOST_RELATIVE_Q36 (1 << 29)

/* Fewest points that ALE fits a line to while it searches; shorter runs say nothing about a line. */
#define ALE_MIN_RUN 5
#define ALE_COSTLY_RUN 12 /* the same in a costly scan */
#define ALE_MAX_RUNS (ALE_MAX_BEAMS / ALE_MIN_RUN)

/* Rooms have up to 22 runs: more is clutter, of which only the most needed is made, for the time is bounded.
 * In a costly scan a third of them is. */
#define ALE_MANY_RUNS 24

/* The search of a room takes fewer fits. */
#define ALE_MANY_SEARCH_FITS 144

/* A room is searched and made good with less effort, in residual sums of runs; a suspect costs as much,
 * a fit of the search twice that. */
#define ALE_MOST_EFFORT 840

/* Beams without a value that one surface may have. */
#define ALE_MAX_GAP_BEAMS 8

/* Sums over the points before one: their difference is the sum over a run. */
typedef struct {
    int64_t x;
    int64_t y;
    int64_t xx;
    int64_t yy;
    int64_t xy;
    int64_t inverse2_q54; /* 1 / range^2, um */
} ale_moments_t;

/* A total-least-squares line through a run, as far as decisions need it. */
typedef struct {
    int32_t n;         /* 0: not known yet */
    int64_t sse_q8;    /* squared residuals along the normal, mm^2 Q8 */
    int64_t var_q8;    /* variance of one point along the normal that the own noise explains, mm^2 Q8; >= 1 */
    int64_t shared_q8; /* the same of the error that neighbours share */
} ale_run_fit_t;

typedef struct {
    uint16_t first;
    uint16_t last;
} ale_segment_t;

typedef struct {
    uint16_t first;
    uint16_t last;
    bool curved;
    bool no_arc;       /* looked at: lines explain it better than a circle */
    bool no_break;     /* looked at: one line explains it as well as two */
    bool settled;      /* its ends have hardly moved when they were placed */
    ale_run_fit_t fit; /* see ale_fit_of_run */
} ale_run_t;

/* Noise of this scan, part of it measured in the scan: variance of a range of r mm is
 * constant_mm2 + relative * r^2. All Q36. */
typedef struct {
    int64_t own_mm2_q36;
    int64_t own_relative_q36;
    int64_t own_um2_q8;    /* own_mm2, as the moments need it */
    int64_t own_scale_q16; /* correction of both, from residuals */
    int64_t shared_mm2_q36;
    int64_t shared_relative_q36;
    int64_t bearing_rad2_q36;
    int64_t sigma_um; /* the own deviation is at most sigma_um + sigma_per_range * r */
    int64_t sigma_per_range_q20;
} ale_scan_noise_t;

struct ale_extractor {
    ale_extract_config_t config;
    ale_stage_hook_t hook;

    /* Directions of the multiples of half a step, as many as were needed, kept as long as the scanner stays
     * the same. */
    int32_t directions;
    int32_t direction_step_bam;
    int32_t cos_q36[ALE_MAX_BEAMS]; /* points a micrometre of range, Q36 */
    int32_t sin_q36[ALE_MAX_BEAMS];

    /* The points. */
    int64_t step_nrad; /* from beam to beam, without sign */
    uint16_t count;
    uint16_t outliers;
    uint16_t beam[ALE_MAX_BEAMS];
    int32_t range_um[ALE_MAX_BEAMS];
    int32_t inverse_q44[ALE_MAX_BEAMS]; /* 2^44 / range_um */
    bool jump_after[ALE_MAX_BEAMS];     /* the surface does not go on to the next point */
    int32_t smooth_q44[ALE_MAX_BEAMS];  /* inverse_q44 smoothed, where that is asked for */
    ale_lowess_work_t lowess;
    int32_t x_q4[ALE_MAX_BEAMS];
    int32_t y_q4[ALE_MAX_BEAMS];
    ale_moments_t sum[ALE_MAX_BEAMS + 1];

    uint16_t gap_count;
    uint16_t
        gap_after[ALE_MAX_BEAMS / ALE_MAX_GAP_BEAMS + 1]; /* points before more missing beams than that */
    uint16_t suspect_count;
    uint16_t suspect[ALE_MAX_BEAMS]; /* points after which the range changes more than noise makes it */
    bool unruly; /* more of them than a scan of surfaces has: what is done for it is bounded more narrowly */
    uint16_t segment_count;
    ale_segment_t segment[ALE_MAX_BEAMS];

    ale_scan_noise_t noise;
    int64_t shared_scale_q8;
    int64_t shared_stated_q8; /* the same for the covariance of lines, where a shared error shows */
    bool shared_absent;       /* measured, and there is none */
    int64_t inverse_sum[ALE_MAX_BEAMS + 1];
    int64_t shared_prior_mm2_q36;
    int64_t shared_prior_relative_q36;
    uint16_t histogram[14][ALE_HISTOGRAM_BINS];

    /* Largest chi square that a true line of n points has, Q8: bounds of the floating threshold. */
    int32_t chi_low_q8[ALE_MAX_BEAMS + 1];
    int32_t chi_high_q8[ALE_MAX_BEAMS + 1];

    int32_t search_fits; /* of the last search */
    int32_t effort; /* so far, in residual sums of runs; looked at between passes over all runs, so that a
                     * mirrored scan is treated alike */
    uint16_t run_count;
    ale_run_t run[ALE_MAX_RUNS];
    uint16_t refused[ALE_REFUSALS];
};

/* Whether the scan costs more than one of surfaces does: the range changes everywhere, or lines are hard to
 * find. What is done for it is bounded more narrowly. */
static inline bool ale_costly(const ale_extractor_t *e)
{
    return e->unruly || e->search_fits > ALE_MANY_SEARCH_FITS || e->run_count > ALE_MANY_RUNS;
}

/* More than a room asks for: what was found so far has to do. */
static inline bool ale_effort_is_spent(const ale_extractor_t *e)
{
    return e->effort > ALE_MOST_EFFORT;
}

#endif
