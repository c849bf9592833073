/* Trajectories as TUM files: `t x y z qx qy qz qw`, one line a pose. */
#ifndef ALE_COMMON_EXPORT_TRAJECTORY_H
#define ALE_COMMON_EXPORT_TRAJECTORY_H

#include <cstdint>
#include <vector>

#include "common/export/text_file.h"

extern "C" {
#include "base/pose.h"
}

namespace ale
{

struct StampedPose {
    int64_t stamp_us;
    ale_pose_t pose;
};

using Trajectory = std::vector<StampedPose>;

void put_tum_line(TextFile &file, const StampedPose &stamped);

} // namespace ale

#endif
