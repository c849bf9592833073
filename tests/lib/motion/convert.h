// Between the core's integers and metres and radians, for tests.
#pragma once

#include <cmath>
#include <cstdint>

#include "reference/planar_motion.h"

extern "C" {
#include "base/pose.h"
#include "base/trig.h"
}

namespace convert
{
inline uint32_t bam(double radians)
{
    return static_cast<uint32_t>(static_cast<int64_t>(std::llround(radians / reference::pi * 2147483648.0)));
}

inline double radians(uint32_t angle_bam)
{
    return static_cast<int32_t>(angle_bam) / 2147483648.0 * reference::pi;
}

inline int32_t um(double metres)
{
    return static_cast<int32_t>(std::lround(metres * 1e6));
}

inline ale_pose_t pose(const reference::Pose &p)
{
    return {um(p[0]), um(p[1]), bam(p[2])};
}

inline reference::Pose pose(const ale_pose_t &p)
{
    return {p.x_um * 1e-6, p.y_um * 1e-6, radians(p.theta_bam)};
}
} // namespace convert
