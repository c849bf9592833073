#include "graph/loops/tight_match.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "graph/loops/loop_match.h"

namespace ale
{

namespace
{

// What a match must find, and how far from where the graph has it; farther is a loop's business.
constexpr double least_overlap = 0.25;
constexpr double least_pairs = 25;
constexpr double farthest_m = 0.25;
constexpr double farthest_rad = 0.1;
// Neighbouring points err together: so many count as one. What all share is a floor.
constexpr double points_a_witness = 4;
constexpr double floor_m = 0.005;
constexpr double floor_rad = 0.004;

Eigen::Matrix3d information_of(const LoopMatch &match)
{
    const double doubt = std::max(1.0, match.rms_m / match_sigma_m);
    const Eigen::Matrix3d seen = match.information / (doubt * doubt * points_a_witness);
    const Eigen::Matrix3d regular = seen + Eigen::Matrix3d::Identity() * 1e-3;
    const Eigen::Vector3d floor(floor_m * floor_m, floor_m * floor_m, floor_rad * floor_rad);
    return (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse();
}

bool is_tie(const LoopMatch &match, const Pose &guess, size_t points)
{
    const Pose off = between(guess, match.pose);
    return match.overlap >= least_overlap && match.overlap * static_cast<double>(points) >= least_pairs &&
           length(off.x, off.y) < farthest_m && std::abs(off.theta) < farthest_rad;
}

} // namespace

std::optional<TightMatch> match_to(const SurfaceField &field, const std::vector<SurfacePoint> &points,
                                   const Pose &guess)
{
    const LoopMatch match = match_tightly(points, field, guess);
    if (!is_tie(match, guess, points.size())) {
        return std::nullopt;
    }
    return TightMatch{match.pose, information_of(match)};
}

} // namespace ale
