/* The smooth pose: the map pose with a shift that keeps it from jumping.
 *
 * As long as the map pose goes as the robot does, the smooth pose is the map pose carried by the shift, to
 * the micrometre: nothing adds up. When the map pose is put elsewhere the shift takes the difference.
 * Constant time. */
#ifndef ALE_MOTION_SMOOTH_POSE_H
#define ALE_MOTION_SMOOTH_POSE_H

#include "base/pose.h"

typedef struct {
    ale_pose_t pose;
    ale_pose_t shift; /* pose = compose(shift, map pose) */
} ale_smooth_t;

/* Both poses are the same. */
void ale_smooth_init(ale_smooth_t *smooth, ale_pose_t map);

/* The robot has gone where the map pose says. */
void ale_smooth_follow(ale_smooth_t *smooth, ale_pose_t map);

/* The robot has gone a way in its own frame, and the map pose is now `map`, however it came there. */
void ale_smooth_step(ale_smooth_t *smooth, ale_pose_t way, ale_pose_t map);

/* The map pose was put elsewhere; the robot has not moved. */
void ale_smooth_hold(ale_smooth_t *smooth, ale_pose_t map);

#endif
