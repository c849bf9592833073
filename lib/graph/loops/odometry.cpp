#include "graph/loops/odometry.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

// Factors on the errors of an edge that was extrapolated, or is unknown.
constexpr double weak_factor = 3;
constexpr double broken_factor = 50;
// What is faster than the fastest seen from node to node, and how far matches and drift may be off.
constexpr double faster = 1.25;
constexpr double drift_m = 1.0;

double seconds_between(const Node &before, const Node &here)
{
    return static_cast<double>(here.stamp_us - before.stamp_us) * 1e-6;
}

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

void Pace::add(const Node &before, const Node &here, const Pose &motion)
{
    const double seconds = seconds_between(before, here);
    if (seconds > 0 && !here.broken && before.map_id == here.map_id) {
        fastest_m_s_ = std::max(fastest_m_s_, length(motion.x, motion.y) / seconds);
    }
}

double Pace::reach_m(const Node &before, const Node &here) const
{
    const double way_m = faster * fastest_m_s_ * seconds_between(before, here);
    return way_m > 0 ? drift_m + way_m : endless_m;
}

} // namespace ale
