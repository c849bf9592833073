#include "graph/loops/submap.h"

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

Span span_of(size_t nodes, int k, const SubmapExtent &extent)
{
    return {std::max(0, k - extent.before), std::min(static_cast<int>(nodes) - 1, k + extent.after)};
}

} // namespace

std::vector<int> nodes_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                              const SubmapExtent &extent)
{
    const Span span = span_of(poses.size(), k, extent);
    std::vector<int> near;
    for (int i = span.first; i <= span.last; i++) {
        const Pose seen = between(poses, k, i);
        if (at(nodes, i).map_id == at(nodes, k).map_id && length(seen.x, seen.y) <= reach_m) {
            near.push_back(i);
        }
    }
    return near;
}

std::vector<SurfacePoint> submap_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                        const SubmapExtent &extent)
{
    std::vector<SurfacePoint> points;
    for (const int i : nodes_around(nodes, poses, k, extent)) {
        const Pose seen = between(poses, k, i);
        const Eigen::Matrix2d r = rotation(seen.theta);
        const Eigen::Vector2d t(seen.x, seen.y);
        const Node &node = at(nodes, i);
        for (size_t p = 0; p < node.points.size(); p++) {
            const bool is_coarse = p < node.coarse_normal.size() && node.coarse_normal[p];
            const Eigen::Vector2d normal = is_coarse ? Eigen::Vector2d(0, 0) : node.points[p].normal;
            points.push_back({r * node.points[p].p + t, r * normal});
        }
    }
    return points;
}

std::vector<CornerFeature> corners_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                          int k, const SubmapExtent &extent)
{
    const Span span = span_of(nodes.size(), k, extent);
    std::vector<CornerFeature> corners;
    for (int i = span.first; i <= span.last; i++) {
        if (at(nodes, i).map_id != at(nodes, k).map_id) {
            continue;
        }
        const Pose seen = between(poses, k, i);
        for (CornerFeature corner : at(nodes, i).corners) {
            corner.p = apply(seen, corner.p);
            corner.bisector_rad = wrapped(corner.bisector_rad + seen.theta);
            corners.push_back(corner);
        }
    }
    return corners;
}

} // namespace ale
