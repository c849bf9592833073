#include "graph/loops/odometry.h"

#include <cmath>

namespace ale
{

namespace
{

// Factors on the errors of an edge that was extrapolated, or is unknown.
constexpr double weak_factor = 3;
constexpr double broken_factor = 50;

Eigen::Matrix3d motion_information(const Pose &motion, const Node &to)
{
    const double distance = length(motion.x, motion.y);
    const double turn = std::abs(motion.theta);
    const double factor = to.broken ? broken_factor : (to.weak ? weak_factor : 1);
    const double sigma_m = factor * (0.004 + 0.008 * distance + 0.004 * turn);
    const double sigma_rad = factor * (0.0015 + 0.002 * distance + 0.004 * turn);
    return information_from_deviations(sigma_m, sigma_rad);
}

} // namespace

GraphEdge odometry_edge(int k, const Node &before, const Node &here, const Pose &motion)
{
    if (before.map_id != here.map_id) {
        return {k - 1, k, motion, guess_information(), false, false, here.guess};
    }
    return {k - 1, k, motion, motion_information(motion, here), false};
}

} // namespace ale
