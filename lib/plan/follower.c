#include "plan/follower.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "plan/safe_speed.h"

/* Turn rate per error of heading, 1/s: with a quarter of a second of delay it does not swing. */
enum { TURN_GAIN = 2 };
/* Full speed when the goal lies within the first, none beyond the second. */
#define AHEAD_BAM (INT64_C(8) * ALE_BAM_PER_DEGREE)
#define ASIDE_BAM (INT64_C(35) * ALE_BAM_PER_DEGREE)

int32_t ale_turn_towards(const ale_follower_t *follower, uint32_t heading_bam, uint32_t theta_bam)
{
    const int64_t error_urad = ale_round_div(ale_bam_to_nrad(ale_bam_diff(theta_bam, heading_bam)), 1000);
    return (int32_t)ale_clamp64(TURN_GAIN * error_urad, -follower->turn_urad_s, follower->turn_urad_s);
}

static int64_t speed_for(const ale_follower_t *follower, int64_t aside_bam, int64_t path_um)
{
    const int64_t ahead_bam = ale_clamp64(ASIDE_BAM - aside_bam, 0, ASIDE_BAM - AHEAD_BAM);
    const int64_t straight_um_s = ale_round_div(follower->speed_um_s * ahead_bam, ASIDE_BAM - AHEAD_BAM);
    return ale_min64(straight_um_s, ale_stopping_speed_um_s(path_um, &follower->shape));
}

ale_velocity_t ale_follow(const ale_follower_t *follower, ale_pose_t pose, ale_point_t to, int64_t path_um,
                          const ale_scan_t *scan)
{
    const int64_t dx_um = (int64_t)to.x_um - pose.x_um;
    const int64_t dy_um = (int64_t)to.y_um - pose.y_um;
    const uint32_t heading_bam = ale_atan2_bam(dy_um, dx_um);
    const int64_t aside_bam = ale_abs64(ale_bam_diff(heading_bam, pose.theta_bam));
    const int32_t turn_urad_s = ale_turn_towards(follower, pose.theta_bam, heading_bam);
    const int32_t wanted_um_s = (int32_t)speed_for(follower, aside_bam, path_um);
    /* Slower at the same turn rate is a tighter arc, which may touch what the wide one passed. */
    const int32_t wide_um_s =
        ale_safe_speed_um_s(scan, &follower->sensor, &follower->shape, wanted_um_s, turn_urad_s);
    const int32_t tight_um_s =
        ale_safe_speed_um_s(scan, &follower->sensor, &follower->shape, wide_um_s, turn_urad_s);
    return (ale_velocity_t){tight_um_s, turn_urad_s};
}
