#include "graph/loops/loop_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/fields/likelihood_field.h"
#include "graph/loops/loop_match.h"
#include "graph/loops/place_candidates.h"
#include "graph/loops/submap.h"

namespace ale
{

namespace
{

constexpr int least_rounds = 2; // the second matches from where the first has put the nodes
constexpr int most_rounds = 4;
constexpr size_t searched_nodes = 700; // of more, every second, third..
constexpr size_t most_places = 3;
constexpr int same_visit_nodes = 12;
constexpr double reach_m = 2.0; // of places, beside the deviation of the graph
constexpr double metres_a_radian = 0.5;
constexpr SubmapExtent submap_there{6, 6};
constexpr SubmapExtent submap_here{2, 2};
constexpr SubmapExtent corners_there{2, 2};
constexpr SubmapExtent corners_here{2, 2};
// The window: three standard deviations and the error of a match.
constexpr double deviations = 3;
constexpr double window_m = 0.20;
constexpr double window_rad = 0.05;
constexpr double max_window_m = 10.0; // the field of a place has 12.8 m each way
constexpr double max_window_rad = 0.5;
// A clear match this near to its pose in the graph needs no further search.
constexpr double near_m = 0.15;
constexpr double near_rad = 0.03;
constexpr int checked_stride = 2; // of the nodes that a loop is checked against for free space
// The overlap of a displaced match refers to the points in view there, but at least to this part of all
// points: fewer fit anywhere.
constexpr double least_in_view = 1.0 / 3;
// A displaced loop is kept for the next round if its weight in the robust kernel is at least this.
constexpr double least_weight_kept = 0.25;
constexpr double most_violations = 0.15; // part of the points: doors, people and chairs move
constexpr int confirming_nodes = 12;     // largest distance along the path of loops that confirm another
constexpr int confirming_places = 20;
constexpr int confirmations_when_clear = 1;
constexpr int confirmations_when_sparse = 2;
// The robust kernel narrows by half every other iteration, to its normal width.
constexpr double widest_kernel = 10000;
constexpr int narrowing_iterations = 32;
constexpr int iterations_as_begun = 10; // from where the graph was, at the normal width

SearchWindow window_of(const Deviation &deviation)
{
    return {std::min(max_window_m, window_m + deviations * deviation.position_m),
            std::min(max_window_rad, window_rad + deviations * deviation.heading_rad)};
}

} // namespace

LoopSearch::LoopSearch(const std::vector<Node> *nodes, PoseGraph graph)
    : nodes_(nodes), graph_(std::move(graph))
{
    for (const GraphEdge &edge : graph_.edges()) {
        if (!edge.recognised) {
            given_.push_back(edge);
        }
    }
    free_space_.reserve(nodes_->size());
    for (const Node &node : *nodes_) {
        free_space_.emplace_back(node);
    }
}

bool LoopSearch::step()
{
    if (round_ == most_rounds) {
        return false;
    }
    if (next_ < static_cast<int>(nodes_->size())) {
        search_from(next_);
        next_ += 1 + static_cast<int>(nodes_->size() / searched_nodes);
        return true;
    }
    solve();
    if (is_solved()) {
        select_solution();
        const bool more = keep_displaced() || round_ + 1 < least_rounds;
        round_ = more ? round_ + 1 : most_rounds;
        found_.clear();
        covariance_.reset();
        next_ = solved_ = 0;
    }
    return true;
}

// The nearest of each earlier visit.
std::vector<LoopSearch::Place> LoopSearch::places_near(int k) const
{
    const std::vector<Deviation> deviation = covariance_->from(k);
    const double path_m = at(*nodes_, k).path_m;
    std::vector<PlaceCandidate> near;
    for (int there = 0; there < k; there++) {
        if (path_m - at(*nodes_, there).path_m < loop_min_path_m) {
            break;
        }
        if (at(*nodes_, there).map_id != at(*nodes_, k).map_id) {
            continue;
        }
        const Pose off = between(graph_.poses(), there, k);
        const double distance = length(off.x, off.y);
        if (distance < reach_m + window_of(at(deviation, there)).half_m) {
            near.push_back({there, distance + metres_a_radian * std::abs(off.theta)});
        }
    }
    const std::vector<int> chosen = nearest_of_each_visit(std::move(near), same_visit_nodes, most_places);
    std::vector<Place> places;
    places.reserve(chosen.size());
    for (const int there : chosen) {
        places.push_back({there, window_of(at(deviation, there))});
    }
    return places;
}

void LoopSearch::search_from(int k)
{
    if (!covariance_) {
        covariance_.emplace(graph_);
    }
    const std::vector<Place> places = places_near(k);
    if (places.empty()) {
        return;
    }
    const std::vector<SurfacePoint> seen = submap_around(*nodes_, graph_.poses(), k, submap_here);
    for (const Place &place : places) {
        const std::optional<FoundLoop> found = match_place(place, k, seen);
        if (found && !violates_free_space(found->loop)) {
            found_.push_back(*found);
        }
    }
}

std::optional<LoopSearch::FoundLoop> LoopSearch::match_place(const Place &place, int k,
                                                             const std::vector<SurfacePoint> &seen) const
{
    const std::vector<Pose> &poses = graph_.poses();
    const Pose guess = between(poses, place.node, k);
    const LikelihoodField field(submap_around(*nodes_, poses, place.node, submap_there));
    const auto is_displaced = [&guess](const LoopMatch &match) {
        const Pose off = between(guess, match.pose);
        return length(off.x, off.y) >= near_m || std::abs(off.theta) >= near_rad;
    };
    const LoopMatch close_by = match_locally(seen, field, guess);
    if (close_by.overlap > clear_overlap && !is_displaced(close_by)) {
        return FoundLoop{loop_from_match(close_by, place.node, k), false};
    }
    const LoopMatch match =
        match_submap(seen, corners_around(*nodes_, poses, k, corners_here), field,
                     corners_around(*nodes_, poses, place.node, corners_there), guess, place.window);
    const bool displaced = is_displaced(match);
    const double in_view = displaced ? part_in_view(seen, place.node, match.pose) : 1;
    if (!is_acceptable(match, std::max(least_in_view, in_view))) {
        return std::nullopt;
    }
    return FoundLoop{loop_from_match(match, place.node, k), displaced};
}

// The part of these points, seen from `pose` relative to node `from`, that some node around it had in view.
double LoopSearch::part_in_view(const std::vector<SurfacePoint> &seen, int from, const Pose &pose) const
{
    const std::vector<Pose> &poses = graph_.poses();
    std::vector<bool> in_view(seen.size(), false);
    for (const int there : nodes_around(*nodes_, poses, from, submap_there)) {
        const FreeSpace &space = at(free_space_, there);
        const Pose place = compose(between(poses, there, from), pose);
        const Eigen::Matrix2d r = rotation(place.theta);
        for (size_t k = 0; k < seen.size(); k++) {
            in_view[k] = in_view[k] || space.has_in_view(r * seen[k].p + Eigen::Vector2d(place.x, place.y));
        }
    }
    const auto count = static_cast<double>(std::count(in_view.begin(), in_view.end(), true));
    return seen.empty() ? 0 : count / static_cast<double>(seen.size());
}

// Whether too many points of the nodes around `to` lie in the free space of the nodes around `from`.
bool LoopSearch::violates_free_space(const Loop &loop) const
{
    const std::vector<Pose> &poses = graph_.poses();
    const int count = static_cast<int>(nodes_->size());
    FreeSpaceCheck sum;
    for (int there = std::max(0, loop.from - submap_there.before);
         there <= std::min(count - 1, loop.from + submap_there.after); there += checked_stride) {
        if (at(*nodes_, there).map_id != at(*nodes_, loop.from).map_id) {
            continue;
        }
        const Pose place = compose(between(poses, there, loop.from), loop.measured);
        for (int here = std::max(0, loop.to - submap_here.before);
             here <= std::min(count - 1, loop.to + submap_here.after); here++) {
            if (at(*nodes_, here).map_id == at(*nodes_, loop.to).map_id) {
                at(free_space_, there)
                    .check(at(*nodes_, here), compose(place, between(poses, loop.to, here)), &sum);
            }
        }
    }
    return sum.violations > most_violations * sum.points;
}

bool LoopSearch::is_confirmed(const FoundLoop &found) const
{
    const bool clear = found.loop.overlap >= clear_overlap;
    const auto confirmations = std::count_if(found_.begin(), found_.end(), [&](const FoundLoop &other) {
        return std::abs(other.loop.to - found.loop.to) <= confirming_nodes &&
               std::abs(other.loop.from - found.loop.from) <= confirming_places &&
               are_consistent(found.loop, other.loop, graph_.poses());
    });
    return confirmations >= (clear ? confirmations_when_clear : confirmations_when_sparse);
}

// Odometry, the confirmed loops of this round, and the given loops that were not found again.
std::vector<GraphEdge> LoopSearch::edges() const
{
    std::vector<GraphEdge> edges;
    for (const FoundLoop &found : found_) {
        if (is_confirmed(found)) {
            edges.push_back(edge_of(found.loop));
        }
    }
    const size_t loops = edges.size();
    for (const GraphEdge &edge : given_) {
        const bool found_again =
            edge.robust && std::any_of(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(loops),
                                       [&](const GraphEdge &loop) {
                                           return std::abs(loop.to - edge.to) <= same_visit_nodes &&
                                                  std::abs(loop.from - edge.from) <= same_visit_nodes;
                                       });
        if (!found_again) {
            edges.push_back(edge);
        }
    }
    return edges;
}

// A loop that displaced two visits may not be found again from where they then lie. Returns whether there is
// one.
bool LoopSearch::keep_displaced()
{
    bool kept = false;
    for (const FoundLoop &found : found_) {
        const GraphEdge edge = edge_of(found.loop);
        if (found.displaced && is_confirmed(found) && graph_.weight(edge) > least_weight_kept) {
            given_.push_back(edge);
            kept = true;
        }
    }
    return kept;
}

void LoopSearch::solve()
{
    if (solved_ == 0) {
        graph_.set_edges(edges());
        as_begun_ = graph_;
    }
    if (solved_ < narrowing_iterations) {
        graph_.optimise(1, std::max(robust_kernel, std::ldexp(widest_kernel, -(solved_ / 2))));
    } else {
        as_begun_->optimise(1);
    }
    solved_++;
}

bool LoopSearch::is_solved() const
{
    return solved_ == narrowing_iterations + iterations_as_begun;
}

// Of two minima of the same cost the lower.
void LoopSearch::select_solution()
{
    if (as_begun_->cost() < graph_.cost()) {
        graph_ = std::move(*as_begun_);
    }
    as_begun_.reset();
}

} // namespace ale
