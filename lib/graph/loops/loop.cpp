#include "graph/loops/loop.h"

#include <cmath>

#include <Eigen/LU>

namespace ale
{

namespace
{

constexpr double agreement_m = 0.15;
constexpr double agreement_rad = 0.035;
constexpr double least_variance_m2 = 0.01 * 0.01;
constexpr double least_variance_rad2 = 0.003 * 0.003;

} // namespace

Loop loop_by(const LoopMatch &match, int from, int to)
{
    const Eigen::Vector3d floor(least_variance_m2, least_variance_m2, least_variance_rad2);
    const Eigen::Matrix3d regular = match.information + Eigen::Matrix3d::Identity() * 1e-3;
    return {from, to, match.pose, (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse(),
            match.overlap};
}

bool is_sight(const LoopMatch &match, double in_view)
{
    return match.found && match.overlap >= least_overlap * in_view && match.ambiguity <= most_ambiguity;
}

bool agree(const Loop &a, const Loop &b, const std::vector<Pose> &poses)
{
    if (a.to == b.to) {
        return false;
    }
    const Pose along_there = between(poses[static_cast<size_t>(a.from)], poses[static_cast<size_t>(b.from)]);
    const Pose along_here = between(poses[static_cast<size_t>(a.to)], poses[static_cast<size_t>(b.to)]);
    const Pose gap = between(compose(a.measured, along_here), compose(along_there, b.measured));
    return length(gap.x, gap.y) < agreement_m && std::abs(gap.theta) < agreement_rad;
}

} // namespace ale
