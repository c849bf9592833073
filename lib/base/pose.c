#include "base/pose.h"

#include "base/fixed.h"
#include "base/trig.h"

ale_point_t ale_rotate(ale_point_t p, uint32_t angle_bam)
{
    return ale_turn(p, ale_direction(angle_bam));
}

ale_point_t ale_pose_apply(ale_pose_t pose, ale_point_t p)
{
    const ale_point_t r = ale_rotate(p, pose.theta_bam);
    const ale_point_t q = {pose.x_um + r.x_um, pose.y_um + r.y_um};
    return q;
}

ale_pose_t ale_pose_compose(ale_pose_t a, ale_pose_t b)
{
    const ale_point_t p = ale_pose_apply(a, (ale_point_t){b.x_um, b.y_um});
    return (ale_pose_t){p.x_um, p.y_um, a.theta_bam + b.theta_bam};
}

ale_pose_t ale_pose_between(ale_pose_t a, ale_pose_t b)
{
    const ale_point_t d = {(int32_t)ale_clamp64((int64_t)b.x_um - a.x_um, INT32_MIN, INT32_MAX),
                           (int32_t)ale_clamp64((int64_t)b.y_um - a.y_um, INT32_MIN, INT32_MAX)};
    const ale_point_t p = ale_rotate(d, 0u - a.theta_bam);
    return (ale_pose_t){p.x_um, p.y_um, b.theta_bam - a.theta_bam};
}

ale_pose_t ale_pose_shift(ale_pose_t from, ale_pose_t to)
{
    const uint32_t turn_bam = to.theta_bam - from.theta_bam;
    const ale_point_t turned = ale_rotate((ale_point_t){from.x_um, from.y_um}, turn_bam);
    return (ale_pose_t){to.x_um - turned.x_um, to.y_um - turned.y_um, turn_bam};
}
