/* Trajectories as text: t x y z qx qy qz qw. */
#ifndef ALE_LAB_SIM_TUM_H
#define ALE_LAB_SIM_TUM_H

#include <cinttypes>
#include <cstdint>
#include <cstdio>

#include "lab/sim/geometry.h"

namespace sim
{

inline void write_tum(std::FILE *file, int64_t t_us, const Pose &pose)
{
    std::fprintf(file, "%" PRId64 ".%06" PRId64 " %.6f %.6f 0 0 0 %.9f %.9f\n", t_us / 1000000,
                 t_us % 1000000, pose.x, pose.y, std::sin(pose.theta / 2), std::cos(pose.theta / 2));
}

} // namespace sim

#endif
