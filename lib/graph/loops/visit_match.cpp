#include "graph/loops/visit_match.h"

#include <algorithm>
#include <cmath>

#include "graph/fields/likelihood_field.h"
#include "graph/loops/place_candidates.h"

namespace ale
{

namespace
{

constexpr double loop_reach_m = 2.5; // of places, beside drift
constexpr double drift_rad_per_metre = 0.002;
constexpr double max_window_m = 2.0;
constexpr double max_window_rad = 0.35;
constexpr SubmapExtent corners_there{2, 2};
// Accuracy of the tracker there.
constexpr double recognised_m = 0.015;
constexpr double recognised_rad = 0.004;

bool is_recognised(const Pose &guess, const LoopMatch &match, double overlap)
{
    return match.found && match.overlap >= overlap && is_near(guess, match.pose);
}

} // namespace

std::vector<int> earlier_visits(const std::vector<Node> &nodes, const std::vector<Pose> &poses)
{
    const Pose &here = poses.back();
    std::vector<PlaceCandidate> places;
    for (size_t k = 0; k < nodes.size(); k++) {
        const double driven_m = nodes.back().path_m - nodes[k].path_m;
        if (driven_m < loop_min_path_m) {
            break;
        }
        if (nodes[k].map_id != nodes.back().map_id) {
            continue;
        }
        const Pose &there = poses[k];
        const double distance = length(there.x - here.x, there.y - here.y);
        if (distance < loop_reach_m + std::min(max_window_m, drift_per_metre * driven_m)) {
            places.push_back({static_cast<int>(k), distance});
        }
    }
    return nearest_of_each_visit(std::move(places), 2 * visit_nodes, most_visits);
}

std::optional<Visit> visit_near(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                const Pose &here, uint32_t map_id)
{
    const int count = static_cast<int>(nodes.size());
    int nearest = -1;
    double least_m = 0;
    for (int k = 0; k < count; k++) {
        const Pose &there = at(poses, k);
        const double distance = length(there.x - here.x, there.y - here.y);
        if (at(nodes, k).map_id == map_id && (nearest < 0 || distance < least_m)) {
            nearest = k;
            least_m = distance;
        }
    }
    if (nearest < 0) {
        return std::nullopt;
    }
    Visit visit{nearest, {0, 0}};
    const auto is_of_map = [&](int k) { return k >= 0 && k < count && at(nodes, k).map_id == map_id; };
    while (visit.extent.before < visit_nodes && is_of_map(nearest - visit.extent.before - 1)) {
        visit.extent.before++;
    }
    while (visit.extent.after < visit_nodes && is_of_map(nearest + visit.extent.after + 1)) {
        visit.extent.after++;
    }
    return visit;
}

VisitMatch match_visit(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int there,
                       const SubmapExtent &extent)
{
    const int here = static_cast<int>(nodes.size()) - 1;
    const double driven_m = nodes.back().path_m - at(nodes, there).path_m;
    const SearchWindow window{std::min(max_window_m, 0.3 + drift_per_metre * driven_m),
                              std::min(max_window_rad, 0.07 + drift_rad_per_metre * driven_m)};
    const LikelihoodField field(submap_around(nodes, poses, there, extent));
    const Pose guess = between(poses, there, here);
    const std::vector<SurfacePoint> seen = submap_around(nodes, poses, here, visit_here);
    const Loop as_tracked{there, here, guess, information_from_deviations(recognised_m, recognised_rad), 1};
    if (is_recognised(guess, match_locally(seen, field, guess), clear_overlap)) {
        return {VisitMatch::recognised, as_tracked};
    }
    const LoopMatch match = match_submap(seen, nodes.back().corners, field,
                                         corners_around(nodes, poses, there, corners_there), guess, window);
    if (!is_acceptable(match)) {
        return {VisitMatch::unclear, as_tracked};
    }
    if (is_recognised(guess, match, least_overlap)) {
        return {VisitMatch::recognised, as_tracked};
    }
    return {VisitMatch::displaced, loop_from_match(match, there, here)};
}

} // namespace ale
