#include "graph/loops/place.h"

#include <algorithm>

#include "graph/loops/loop_match.h"
#include "graph/loops/submap.h"

namespace ale
{

namespace
{

constexpr SubmapExtent view_extent{2, 2};
constexpr size_t checked_stride = 2; // of the nodes
constexpr size_t view_points = 300;  // thinned() keeps up to twice as many

double distance(const Pose &a, const Pose &b)
{
    return length(a.x - b.x, a.y - b.y);
}

SeenNode seen_node(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int from, int k)
{
    return {&at(nodes, k), between(poses, from, k), FreeSpace(at(nodes, k))};
}

// The anchor and the nodes of its map near it, the nearest first.
std::vector<SeenNode> nodes_near(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int anchor)
{
    std::vector<int> near;
    for (int k = 0; k < static_cast<int>(nodes.size()); k++) {
        if (at(nodes, k).map_id == at(nodes, anchor).map_id &&
            distance(at(poses, k), at(poses, anchor)) <= Place::reach_m) {
            near.push_back(k);
        }
    }
    std::stable_sort(near.begin(), near.end(), [&](int a, int b) {
        return distance(at(poses, a), at(poses, anchor)) < distance(at(poses, b), at(poses, anchor));
    });
    near.resize(std::min(near.size(), Place::most_nodes));
    std::vector<SeenNode> seen;
    for (const int k : near) {
        seen.push_back(seen_node(nodes, poses, anchor, k));
    }
    return seen;
}

// Coarse normals count as unknown.
std::vector<SurfacePoint> points_of(const std::vector<SeenNode> &seen)
{
    std::vector<SurfacePoint> points;
    for (const SeenNode &from : seen) {
        const Eigen::Matrix2d r = rotation(from.pose.theta);
        const Node &node = *from.node;
        for (size_t k = 0; k < node.points.size(); k++) {
            const bool is_coarse = k < node.coarse_normal.size() && node.coarse_normal[k];
            const Eigen::Vector2d normal = is_coarse ? Eigen::Vector2d(0, 0) : node.points[k].normal;
            points.push_back({apply(from.pose, node.points[k].p), r * normal});
        }
    }
    return points;
}

} // namespace

View::View(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int of)
    : node(of), points(thinned(submap_around(nodes, poses, of, view_extent), view_points))
{
    for (const int k : nodes_around(nodes, poses, of, view_extent)) {
        seen.push_back(seen_node(nodes, poses, of, k));
    }
}

Place::Place(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int anchor)
    : anchor_(anchor), seen_(nodes_near(nodes, poses, anchor)), points_(points_of(seen_)), field_(points_)
{
}

Explanation Place::explain(const View &view, const Pose &pose) const
{
    return {part_in_view(view, pose), part_agreed(view, pose)};
}

double Place::part_in_view(const View &view, const Pose &pose) const
{
    std::vector<Pose> to_nodes;
    for (const SeenNode &from : seen_) {
        to_nodes.push_back(between(from.pose, pose));
    }
    size_t in_view = 0;
    for (size_t k = 0; k < view.points.size(); k++) {
        bool seen = false;
        for (size_t i = 0; i < seen_.size() && !seen; i++) {
            seen = seen_[i].space.has_in_view(apply(to_nodes[i], view.points[k].p));
        }
        in_view += seen;
    }
    return view.points.empty() ? 0 : static_cast<double>(in_view) / static_cast<double>(view.points.size());
}

// The worse of both sides: where one looks through what the other saw there is no common place.
double Place::part_agreed(const View &view, const Pose &pose) const
{
    FreeSpaceCheck of_view;
    FreeSpaceCheck of_place;
    for (size_t i = 0; i < seen_.size(); i += checked_stride) {
        for (size_t k = 0; k < view.seen.size(); k += checked_stride) {
            const SeenNode &there = seen_[i];
            const SeenNode &here = view.seen[k];
            const Pose seen = between(there.pose, compose(pose, here.pose));
            there.space.check(*here.node, seen, &of_view);
            here.space.check(*there.node, inverse(seen), &of_place);
        }
    }
    const auto part = [](const FreeSpaceCheck &check) {
        return check.points > 0 ? 1 - static_cast<double>(check.violations) / check.points : 0;
    };
    return std::min(part(of_view), part(of_place));
}

std::vector<int> spread_nodes(const std::vector<Node> &nodes, const std::vector<Pose> &poses, uint32_t map_id,
                              double apart_m)
{
    std::vector<int> chosen;
    for (int k = 0; k < static_cast<int>(nodes.size()); k++) {
        const bool is_covered = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
            return distance(at(poses, k), at(poses, other)) < apart_m;
        });
        if (at(nodes, k).map_id == map_id && !is_covered) {
            chosen.push_back(k);
        }
    }
    return chosen;
}

} // namespace ale
