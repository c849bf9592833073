/* From the simulated world's metres and radians to the core's integers and back. */
#ifndef ALE_LAB_SIM_UNITS_H
#define ALE_LAB_SIM_UNITS_H

#include <cstdint>

#include "lab/sim/geometry.h"

extern "C" {
#include "base/pose.h"
}

namespace sim
{

constexpr double bam_per_turn = 4294967296.0;

inline double metres(int32_t um)
{
    return um * 1e-6;
}

inline int32_t micrometres(double metres)
{
    return static_cast<int32_t>(std::lround(metres * 1e6));
}

inline double radians(uint32_t bam)
{
    return static_cast<int32_t>(bam) * (2 * pi / bam_per_turn);
}

inline ale_pose_t core_pose(const Pose &pose)
{
    const double bam = wrapped(pose.theta) * (bam_per_turn / (2 * pi));
    return {static_cast<int32_t>(std::lround(pose.x * 1e6)), static_cast<int32_t>(std::lround(pose.y * 1e6)),
            static_cast<uint32_t>(std::llround(bam))};
}

} // namespace sim

#endif
