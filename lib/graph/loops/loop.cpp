#include "graph/loops/loop.h"

#include <cmath>

#include <Eigen/LU>

namespace ale
{

namespace
{

constexpr double gap_m = 0.15; // of a cycle
constexpr double gap_rad = 0.035;
constexpr double near_m = 0.05; // of a recognised place
constexpr double near_rad = 0.015;
// Accuracy of a match, however many points it has.
constexpr double least_variance_m2 = 0.01 * 0.01;
constexpr double least_variance_rad2 = 0.003 * 0.003;

} // namespace

Loop loop_from_match(const LoopMatch &match, int from, int to)
{
    const Eigen::Vector3d floor(least_variance_m2, least_variance_m2, least_variance_rad2);
    const Eigen::Matrix3d regular = match.information + Eigen::Matrix3d::Identity() * 1e-3;
    return {from, to, match.pose, (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse(),
            match.overlap};
}

GraphEdge edge_of(const Loop &loop)
{
    return {loop.from, loop.to, loop.measured, loop.information, true};
}

GraphEdge joining_edge_of(const Loop &loop)
{
    GraphEdge edge = edge_of(loop);
    edge.joins = true;
    return edge;
}

bool is_near(const Pose &tracked, const Pose &matched)
{
    const Pose off = between(tracked, matched);
    return length(off.x, off.y) < near_m && std::abs(off.theta) < near_rad;
}

bool is_acceptable(const LoopMatch &match, double in_view)
{
    return match.found && match.overlap >= least_overlap * in_view && match.ambiguity <= most_ambiguity;
}

bool are_consistent(const Loop &a, const Loop &b, const std::vector<Pose> &poses)
{
    if (a.to == b.to) {
        return false;
    }
    const Pose gap = between(compose(a.measured, between(poses, a.to, b.to)),
                             compose(between(poses, a.from, b.from), b.measured));
    return length(gap.x, gap.y) < gap_m && std::abs(gap.theta) < gap_rad;
}

} // namespace ale
