/* The noise of a scanner, measured in the scan itself: paper II, with what the real URG-04LX adds to it. */
#ifndef ALE_EXTRACT_SCAN_NOISE_H
#define ALE_EXTRACT_SCAN_NOISE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "base/histogram.h"
#include "base/noise.h"
#include "base/scan.h"
#include "extract/points.h"

/* No variance is believed to exceed (9 % of the range)^2: Q36 of the squared range. */
#define ALE_MOST_RELATIVE_Q36 (1 << 29)

enum { ALE_NOISE_OCTAVES = 14 };

/* Noise of this scan: variance of a range of r mm is constant_mm2 + relative * r^2, all Q36, and of the own
 * part of a scanner that triangulates square * r^4 (then relative is 0), square in 1 / mm^2 Q60. The own part
 * is independent from beam to beam, the shared part correlated over shared_beams. */
typedef struct {
    int64_t own_mm2_q36;
    int64_t own_relative_q36;
    int64_t own_square_q60;
    int64_t own_um2_q8;    /* own_mm2, as the moments need it */
    int64_t own_scale_q16; /* correction of both, from residuals (run_noise.h) */
    int64_t shared_mm2_q36;
    int64_t shared_relative_q36;
    int64_t bearing_rad2_q36;
    int64_t sigma_um; /* the own deviation is at most sigma_um + sigma_per_range * r */
    int64_t sigma_per_range_q20;

    /* As configured. */
    int64_t shared_prior_mm2_q36;
    int64_t shared_prior_relative_q36;
    int32_t shared_beams;
    int32_t bearing_nrad;

    /* What the runs show of the shared part, in units of the configured one (run_noise.h). */
    int64_t shared_scale_q8;  /* for decisions; beyond 256: the scan shows a shared error */
    int64_t shared_stated_q8; /* for the covariance of lines, where a shared error shows */
    bool shared_absent;       /* measured, and there is none */

    uint16_t histogram[ALE_NOISE_OCTAVES][ALE_HISTOGRAM_BINS]; /* scratch of the measurements */
} ale_scan_noise_t;

/* Own variance over the squared range, but for its constant part, at a squared range below 2^33 mm^2; Q36. */
static inline int64_t ale_scan_noise_relative_q36(const ale_scan_noise_t *noise, int64_t range2_mm2)
{
    return noise->own_relative_q36 + (noise->own_square_q60 * range2_mm2 >> 24);
}

/* Own variance at a squared range below 2^33 mm^2, mm^2 Q20: no more of the range than is believed. */
static inline int64_t ale_scan_noise_own_q20(const ale_scan_noise_t *noise, int64_t range2_mm2)
{
    const int64_t relative_q36 =
        ale_min64(ale_scan_noise_relative_q36(noise, range2_mm2), ALE_MOST_RELATIVE_Q36);
    return (noise->own_mm2_q36 + relative_q36 * range2_mm2) >> 16;
}

/* Takes over the configured model, and measures the own noise: from the second differences of 1/range (zero
 * on a straight wall but for noise), by a quantile in octaves of the range. Where the scan has too few points
 * the configured own noise serves. Of the scan its bearings are read. O(points). */
void ale_scan_noise_measure(ale_scan_noise_t *noise, const ale_noise_t *configured,
                            const ale_points_t *points, const ale_scan_t *scan);

#endif
