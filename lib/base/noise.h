/* Sensor noise model, paper section II, (1) to (7), with what the real URG-04LX adds to it.
 *
 * A range d at bearing phi has an own error of each beam, independent from beam to beam,
 *     s_own^2 = own_um^2 + (own_ppm * d)^2 + (own_ppm_per_m * d * d)^2,
 *
 * the last part where the scanner triangulates, 0 where it times the light;
 * an error that neighbouring beams share (most of the data sheet's 1 %; the paper names bias in section II
 * and then models none), correlated over about shared_beams beams,
 *     s_shared^2 = shared_um^2 + (shared_ppm * d)^2,
 * and a bias from surface to surface (colour, gloss), surface_um. The bearing errs by bearing_nrad.
 *
 * Pure functions of constant time, no error. Ranges 0..ALE_MAX_RANGE_UM, in micrometres; bearings and normals
 * in BAM, in one frame; the values of a model at most 100,000 um or ppm and 100,000,000 nrad. */
#ifndef ALE_BASE_NOISE_H
#define ALE_BASE_NOISE_H

#include <stdint.h>

/* Standard deviations. */
typedef struct {
    int32_t own_um; /* of each beam: a constant part, and one proportional to the range */
    int32_t own_ppm;
    int32_t shared_um; /* of neighbouring beams together */
    int32_t shared_ppm;
    int32_t shared_beams; /* after so many the correlation has fallen to 1/e; at least 1 */
    int32_t surface_um;   /* of a whole surface */
    int32_t bearing_nrad;
    int32_t own_ppm_per_m; /* of each beam's own part, to the square of the range: at most 10,000 */
} ale_noise_t;

/* The URG-04LX as measured on recordings, by `ale-calibrate noise`. */
ale_noise_t ale_noise_default(void);

/* Variance of a range's own error, um^2. */
int64_t ale_noise_own_var_um2(const ale_noise_t *noise, int32_t range_um);

/* Variance of a range's error that its neighbours share, um^2. */
int64_t ale_noise_shared_var_um2(const ale_noise_t *noise, int32_t range_um);

/* Covariance (7) of a measured point, own error and bearing error: xx, xy, yy in um^2, written whole. */
void ale_noise_point_cov(const ale_noise_t *noise, int32_t range_um, uint32_t bearing_bam,
                         int64_t cov_um2[3]);

/* Expected variance along the normal of a wall with normal direction alpha: (26) in normal form,
 * s_own^2 cos^2(phi - alpha) + d^2 s_phi^2 sin^2(phi - alpha)   (the paper's cross term is twice too big). */
int64_t ale_noise_normal_var_um2(const ale_noise_t *noise, int32_t range_um, uint32_t bearing_bam,
                                 uint32_t alpha_bam);

#endif
