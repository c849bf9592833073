#include "base/noise.h"

#include "base/fixed.h"
#include "base/trig.h"

static int64_t square(int64_t v)
{
    return v * v;
}

/* Variance of an error with a constant part and a part proportional to the range, um^2. */
static int64_t ranged_var_um2(int64_t constant_um, int64_t ppm, int64_t range_um)
{
    return square(constant_um) + square(ale_round_div(ppm * range_um, 1000000));
}

/* Variance of the displacement across the beam that the bearing error makes, um^2. */
static int64_t bearing_var_um2(const ale_noise_t *noise, int64_t range_um)
{
    return square(ale_round_div(noise->bearing_nrad * range_um, 1000000000));
}

ale_noise_t ale_noise_default(void)
{
    const ale_noise_t noise = {
        .own_um = 1500,
        .own_ppm = 800,
        .shared_um = 2000,
        .shared_ppm = 1000,
        .shared_beams = 12,
        .surface_um = 6000,
        .bearing_nrad = 872665,
    };
    return noise;
}

int64_t ale_noise_own_var_um2(const ale_noise_t *noise, int32_t range_um)
{
    const int64_t squared_ppm = ale_round_div((int64_t)noise->own_ppm_per_m * range_um, 1000000);
    return ranged_var_um2(noise->own_um, noise->own_ppm, range_um) + ranged_var_um2(0, squared_ppm, range_um);
}

int64_t ale_noise_shared_var_um2(const ale_noise_t *noise, int32_t range_um)
{
    return ranged_var_um2(noise->shared_um, noise->shared_ppm, range_um);
}

void ale_noise_point_cov(const ale_noise_t *noise, int32_t range_um, uint32_t bearing_bam, int64_t cov_um2[3])
{
    const int64_t along = ale_noise_own_var_um2(noise, range_um);
    const int64_t across = bearing_var_um2(noise, range_um);
    const int64_t c = ale_cos_q30(bearing_bam);
    const int64_t s = ale_sin_q30(bearing_bam);
    cov_um2[0] = ale_mul_shift(along, c * c, 60) + ale_mul_shift(across, s * s, 60);
    cov_um2[1] = ale_mul_shift(along - across, c * s, 60);
    cov_um2[2] = ale_mul_shift(along, s * s, 60) + ale_mul_shift(across, c * c, 60);
}

int64_t ale_noise_normal_var_um2(const ale_noise_t *noise, int32_t range_um, uint32_t bearing_bam,
                                 uint32_t alpha_bam)
{
    const uint32_t incidence_bam = bearing_bam - alpha_bam;
    const int64_t c = ale_cos_q30(incidence_bam);
    const int64_t s = ale_sin_q30(incidence_bam);
    return ale_mul_shift(ale_noise_own_var_um2(noise, range_um), c * c, 60) +
           ale_mul_shift(bearing_var_um2(noise, range_um), s * s, 60);
}
