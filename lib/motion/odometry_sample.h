/* Wheel odometry as it arrives: the pose of the robot's centre in a frame of its own that drifts. */
#ifndef ALE_MOTION_ODOMETRY_SAMPLE_H
#define ALE_MOTION_ODOMETRY_SAMPLE_H

#include <stdint.h>

#include "base/pose.h"

typedef struct {
    int64_t stamp_us;
    ale_pose_t pose;
} ale_odometry_t;

#endif
