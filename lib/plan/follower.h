/* Heads for a point: turns towards it first, then goes, the faster the straighter it lies ahead, and never
 * faster than lets it stop before what the scanner sees. Pure functions, no error. */
#ifndef ALE_PLAN_FOLLOWER_H
#define ALE_PLAN_FOLLOWER_H

#include "base/pose.h"
#include "base/scan.h"
#include "plan/robot_shape.h"

typedef struct {
    int32_t speed_um_s;  /* forward */
    int32_t turn_urad_s; /* counter-clockwise */
} ale_velocity_t;

typedef struct {
    ale_robot_shape_t shape;
    ale_pose_t sensor;   /* the scanner in the robot's frame */
    int32_t speed_um_s;  /* most speed, positive */
    int32_t turn_urad_s; /* most turn rate, positive */
} ale_follower_t;

/* The turn rate that brings the robot's heading to theta_bam. Constant time. */
int32_t ale_turn_towards(const ale_follower_t *follower, uint32_t heading_bam, uint32_t theta_bam);

/* What to drive towards `to` (map frame) from `pose`, where the robot is now, with `path_um` left to the
 * end of the path, where it is to stand. scan: the newest one. O(beams). */
ale_velocity_t ale_follow(const ale_follower_t *follower, ale_pose_t pose, ale_point_t to, int64_t path_um,
                          const ale_scan_t *scan);

#endif
