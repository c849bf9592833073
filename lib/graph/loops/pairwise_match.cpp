#include "graph/loops/pairwise_match.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "graph/loops/loop_match.h"

namespace ale
{

namespace
{

// Least fit of a match, and its largest distance from the guess; farther is left to loops.
constexpr double least_overlap = 0.25;
constexpr double least_pairs = 25;
constexpr double largest_m = 0.25;
constexpr double largest_rad = 0.1;
// Neighbouring points are correlated: this many count as one. The common error is a floor.
constexpr double correlated_points = 4;
constexpr double floor_m = 0.005;
constexpr double floor_rad = 0.004;

Eigen::Matrix3d information_of(const LoopMatch &match)
{
    const double excess = std::max(1.0, match.rms_m / match_sigma_m);
    const Eigen::Matrix3d seen = match.information / (excess * excess * correlated_points);
    const Eigen::Matrix3d regular = seen + Eigen::Matrix3d::Identity() * 1e-3;
    const Eigen::Vector3d floor(floor_m * floor_m, floor_m * floor_m, floor_rad * floor_rad);
    return (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse();
}

bool is_acceptable(const LoopMatch &match, const Pose &guess, size_t points)
{
    const Pose off = between(guess, match.pose);
    return match.overlap >= least_overlap && match.overlap * static_cast<double>(points) >= least_pairs &&
           length(off.x, off.y) < largest_m && std::abs(off.theta) < largest_rad;
}

} // namespace

std::optional<PairwiseMatch> match_pair(const LikelihoodField &field, const std::vector<SurfacePoint> &points,
                                        const Pose &guess)
{
    const LoopMatch match = match_closely(points, field, guess);
    if (!is_acceptable(match, guess, points.size())) {
        return std::nullopt;
    }
    return PairwiseMatch{match.pose, information_of(match)};
}

} // namespace ale
