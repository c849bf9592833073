#include "graph/loops/place.h"

#include <algorithm>

#include "graph/loops/loop_match.h"
#include "graph/loops/submap.h"

extern "C" {
#include "map/atlas.h"
}

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

SeenNode seen_node(const Node &node, const Pose &pose)
{
    return {&node, pose, FreeSpace(node)};
}

// The anchor and those of its map near it, the nearest first.
std::vector<int> nearest_of_map(const SearchedMaps &maps, int anchor)
{
    const auto distance_to = [&](int k) { return distance(maps.pose_of(k), maps.pose_of(anchor)); };
    std::vector<int> near;
    for (int k = maps.first(); k < maps.end(); k++) {
        if (maps.map_of(k) == maps.map_of(anchor) && distance_to(k) <= Place::reach_m) {
            near.push_back(k);
        }
    }
    std::stable_sort(near.begin(), near.end(), [&](int a, int b) { return distance_to(a) < distance_to(b); });
    const bool has_views = std::any_of(near.begin(), near.end(), [](int k) { return k < 0; });
    near.resize(std::min(near.size(), has_views ? Place::most_views : Place::most_nodes));
    return near;
}

// Those of these that are views.
std::vector<Node> views_of(const SearchedMaps &maps, const std::vector<int> &near)
{
    std::vector<Node> views;
    for (const int k : near) {
        if (k < 0) {
            views.push_back(maps.prior->at(static_cast<size_t>(-1 - k)));
        }
    }
    return views;
}

// All of these, in the frame of the anchor. The views in their order.
std::vector<SeenNode> seen_from(const SearchedMaps &maps, int anchor, const std::vector<int> &near,
                                const std::vector<Node> &views)
{
    std::vector<SeenNode> seen;
    size_t view = 0;
    for (const int k : near) {
        const Node &node = k < 0 ? views[view++] : at(maps.nodes, k);
        seen.push_back(seen_node(node, between(maps.pose_of(anchor), maps.pose_of(k))));
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
        seen.push_back(seen_node(at(nodes, k), between(poses, of, k)));
    }
}

uint32_t SearchedMaps::map_of(int k) const
{
    return k < 0 ? static_cast<uint32_t>(ALE_FIRST_MAP) : at(nodes, k).map_id;
}

const Pose &SearchedMaps::pose_of(int k) const
{
    return k < 0 ? at(prior->poses(), -1 - k) : at(poses, k);
}

Place::Place(const SearchedMaps &maps, int anchor)
    : anchor_(anchor), near_(nearest_of_map(maps, anchor)), views_(views_of(maps, near_)),
      seen_(seen_from(maps, anchor, near_, views_)), points_(points_of(seen_)), field_(points_)
{
}

Explanation Place::explain(const View &view, const Pose &pose) const
{
    Explanation explanation{part_in_view(view, pose), 0, 0};
    compare_free_space(view, pose, &explanation);
    return explanation;
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
void Place::compare_free_space(const View &view, const Pose &pose, Explanation *out) const
{
    FreeSpaceCheck of_view;
    FreeSpaceCheck before_saved;
    FreeSpaceCheck of_place;
    for (size_t i = 0; i < seen_.size(); i += checked_stride) {
        FreeSpaceCheck *checked = near_[i] < 0 ? &before_saved : &of_view;
        for (size_t k = 0; k < view.seen.size(); k += checked_stride) {
            const SeenNode &there = seen_[i];
            const SeenNode &here = view.seen[k];
            const Pose seen = between(there.pose, compose(pose, here.pose));
            there.space.check(*here.node, seen, checked);
            here.space.check(*there.node, inverse(seen), &of_place);
        }
    }
    const auto part = [](int points, int violations) {
        return points > 0 ? 1 - static_cast<double>(violations) / points : 0;
    };
    const double of_nodes = part(of_view.points, of_view.violations);
    const double stands = part(of_place.points, of_place.violations);
    const bool is_saved = before_saved.points > 0 && of_view.points == 0;
    out->agreed = is_saved ? stands : std::min(of_nodes, stands);
    out->told = std::min(
        stands, part(of_view.points + before_saved.points, of_view.violations + before_saved.violations));
}

} // namespace ale
