/* Where the robot was when a scan was taken, and how it moved then (its own frame): its beams are laid out at
 * the pose of their own time. */
#ifndef ALE_COMMON_OFFLINE_SCAN_POSE_H
#define ALE_COMMON_OFFLINE_SCAN_POSE_H

#include <cstdint>

extern "C" {
#include "base/pose.h"
}

namespace ale
{

struct ScanPose {
    int64_t stamp_us;
    ale_pose_t robot;
    int32_t velocity_x_um_s;
    int32_t velocity_y_um_s;
    int32_t velocity_theta_urad_s;
    bool measured; /* false: predicted; what the scan saw is then left out */
};

} // namespace ale

#endif
