/* The smooth pose: the map pose with a shift that absorbs its corrections, so that it never jumps.
 *
 * While the map pose moves as the robot does, the smooth pose is the map pose moved by the shift, to the
 * micrometre: no error accumulates. When the map pose is corrected, the shift takes the difference. Constant
 * time. */
#ifndef ALE_MOTION_SMOOTH_POSE_H
#define ALE_MOTION_SMOOTH_POSE_H

#include "base/pose.h"

typedef struct {
    ale_pose_t pose;
    ale_pose_t shift; /* pose = compose(shift, map pose) */
} ale_smooth_t;

/* Both poses are the same. */
void ale_smooth_init(ale_smooth_t *smooth, ale_pose_t map);

/* The map pose moved with the robot. */
void ale_smooth_follow(ale_smooth_t *smooth, ale_pose_t map);

/* The robot moved by a displacement in its own frame; the map pose is now `map`, with a correction in it. */
void ale_smooth_step(ale_smooth_t *smooth, ale_pose_t displacement, ale_pose_t map);

/* The map pose was corrected; the robot has not moved. */
void ale_smooth_hold(ale_smooth_t *smooth, ale_pose_t map);

#endif
