#include "graph/loops/patch.h"

#include <algorithm>

namespace ale
{

namespace
{

constexpr double reach_m = 4.0;

struct Span {
    int first;
    int last;
};

Span span_of(size_t nodes, int k, const PatchExtent &extent)
{
    return {std::max(0, k - extent.before), std::min(static_cast<int>(nodes) - 1, k + extent.after)};
}

} // namespace

std::vector<int> viewers_of(const std::vector<Pose> &poses, int k, const PatchExtent &extent)
{
    const Span span = span_of(poses.size(), k, extent);
    std::vector<int> viewers;
    for (int i = span.first; i <= span.last; i++) {
        const Pose seen = between(poses[static_cast<size_t>(k)], poses[static_cast<size_t>(i)]);
        if (length(seen.x, seen.y) <= reach_m) {
            viewers.push_back(i);
        }
    }
    return viewers;
}

std::vector<SurfacePoint> patch_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                       const PatchExtent &extent)
{
    const Pose &middle = poses[static_cast<size_t>(k)];
    std::vector<SurfacePoint> patch;
    for (const int i : viewers_of(poses, k, extent)) {
        const Pose seen = between(middle, poses[static_cast<size_t>(i)]);
        const Eigen::Matrix2d r = rotation(seen.theta);
        const Eigen::Vector2d t(seen.x, seen.y);
        const Node &node = nodes[static_cast<size_t>(i)];
        for (size_t at = 0; at < node.points.size(); at++) {
            const bool told = at >= node.vague.size() || !node.vague[at];
            const Eigen::Vector2d normal = told ? node.points[at].normal : Eigen::Vector2d(0, 0);
            patch.push_back({r * node.points[at].p + t, r * normal});
        }
    }
    return patch;
}

std::vector<CornerMark> corners_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                       const PatchExtent &extent)
{
    const Pose &middle = poses[static_cast<size_t>(k)];
    const Span span = span_of(nodes.size(), k, extent);
    std::vector<CornerMark> corners;
    for (int i = span.first; i <= span.last; i++) {
        const Pose seen = between(middle, poses[static_cast<size_t>(i)]);
        for (CornerMark corner : nodes[static_cast<size_t>(i)].corners) {
            corner.p = apply(seen, corner.p);
            corner.bisector = wrapped(corner.bisector + seen.theta);
            corners.push_back(corner);
        }
    }
    return corners;
}

} // namespace ale
