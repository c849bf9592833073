/* Noise of every model that a configuration may hold; poses and points within what the numbers hold.
 *
 * proves: lib/base/noise.c lib/base/pose.c
 * with: lib/base/trig.c lib/base/fixed.c
 * options: -eva-slevel 30 */
#include "unknown.h"

#include "base/limits.h"
#include "base/noise.h"
#include "base/pose.h"

static ale_point_t unknown_point(int32_t most_um)
{
    return (ale_point_t){(int32_t)unknown(-most_um, most_um), (int32_t)unknown(-most_um, most_um)};
}

static ale_pose_t unknown_pose(int32_t most_um)
{
    const ale_point_t p = unknown_point(most_um);
    return (ale_pose_t){p.x_um, p.y_um, (uint32_t)unknown(0, UINT32_MAX)};
}

static void noise(void)
{
    const ale_noise_t model = {
        .own_um = (int32_t)unknown(0, 100000),
        .own_ppm = (int32_t)unknown(0, 100000),
        .shared_um = (int32_t)unknown(0, 100000),
        .shared_ppm = (int32_t)unknown(0, 100000),
        .shared_beams = (int32_t)unknown(1, ALE_MAX_BEAMS),
        .surface_um = (int32_t)unknown(0, 100000),
        .bearing_nrad = (int32_t)unknown(0, 100000000),
        .own_ppm_per_m = (int32_t)unknown(0, 10000),
    };
    const int32_t range_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM);
    const uint32_t bearing_bam = (uint32_t)unknown(0, UINT32_MAX);
    int64_t cov_um2[3];
    ale_noise_own_var_um2(&model, range_um);
    ale_noise_shared_var_um2(&model, range_um);
    ale_noise_point_cov(&model, range_um, bearing_bam, cov_um2);
    ale_noise_normal_var_um2(&model, range_um, bearing_bam, (uint32_t)unknown(0, UINT32_MAX));
}

void main(void)
{
    ale_noise_default();
    noise();
    const int32_t half_um = INT32_MAX / 4; /* turned and added, it stays within what a pose holds */
    ale_rotate(unknown_point(half_um), (uint32_t)unknown(0, UINT32_MAX));
    ale_pose_apply(unknown_pose(half_um), unknown_point(half_um));
    ale_pose_compose(unknown_pose(half_um), unknown_pose(half_um));
    ale_pose_shift(unknown_pose(half_um), unknown_pose(half_um));
    ale_pose_between(unknown_pose(INT32_MAX), unknown_pose(INT32_MAX));
}
