#include "motion/smooth_pose.h"

void ale_smooth_init(ale_smooth_t *smooth, ale_pose_t map)
{
    *smooth = (ale_smooth_t){.pose = map};
}

void ale_smooth_follow(ale_smooth_t *smooth, ale_pose_t map)
{
    smooth->pose = ale_pose_compose(smooth->shift, map);
}

void ale_smooth_step(ale_smooth_t *smooth, ale_pose_t displacement, ale_pose_t map)
{
    smooth->pose = ale_pose_compose(smooth->pose, displacement);
    ale_smooth_hold(smooth, map);
}

void ale_smooth_hold(ale_smooth_t *smooth, ale_pose_t map)
{
    smooth->shift = ale_pose_shift(map, smooth->pose);
}
