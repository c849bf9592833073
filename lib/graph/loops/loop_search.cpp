#include "graph/loops/loop_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/loops/loop_match.h"
#include "graph/loops/patch.h"
#include "graph/loops/surface_field.h"
#include "graph/loops/visits.h"

namespace ale
{

namespace
{

constexpr int rounds = 2;
constexpr size_t looked_from = 700; // nodes at most; of more every second, third..
constexpr size_t most_places = 3;
constexpr int same_visit_nodes = 12;
constexpr double reach_m = 2.0; // places this near, beside what the graph does not know
constexpr double metres_a_radian = 0.5;
constexpr PatchExtent patch_there{6, 6};
constexpr PatchExtent patch_here{2, 2};
constexpr PatchExtent corners_there{2, 2};
constexpr PatchExtent corners_here{2, 2};
// The window: three standard deviations and what a match may be off anyway.
constexpr double deviations = 3;
constexpr double window_m = 0.20;
constexpr double window_rad = 0.05;
constexpr double max_window_m = 3.0;
constexpr double max_window_rad = 0.5;
// Nearer than this to where the graph has it nothing else needs to be looked for.
constexpr double near_m = 0.15;
constexpr double near_rad = 0.03;
constexpr int viewer_stride = 2;
// A match elsewhere is judged by the points that were in view there; of those out of view so many at most are
// left out, for what little remains fits anywhere.
constexpr double least_in_view = 1.0 / 3;
// A displaced loop stays in the next round when the kernel, at its normal width, leaves it at least so much.
constexpr double least_weight_kept = 0.25;
constexpr double most_in_free = 0.15; // doors, people and chairs move
constexpr int partner_nodes = 12;     // how far along the way those may be that bear a loop out
constexpr int partner_places = 20;
constexpr int partners_when_clear = 1;
constexpr int partners_when_sparse = 2;
// The robust kernel narrows by half every other iteration, to its normal width.
constexpr double widest_kernel = 10000;
constexpr int iterations = 32;

SearchWindow window_of(const Spread &spread)
{
    return {std::min(max_window_m, window_m + deviations * spread.metres),
            std::min(max_window_rad, window_rad + deviations * spread.radians)};
}

GraphEdge edge_by(const Loop &loop)
{
    return {loop.from, loop.to, loop.measured, loop.information, true};
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
    free_.reserve(nodes_->size());
    for (const Node &node : *nodes_) {
        free_.emplace_back(node);
    }
}

bool LoopSearch::step()
{
    if (round_ == rounds) {
        return false;
    }
    if (next_ < static_cast<int>(nodes_->size())) {
        look_from(next_);
        next_ += 1 + static_cast<int>(nodes_->size() / looked_from);
        return true;
    }
    solve();
    if (solved_ == iterations) {
        keep_displaced();
        found_.clear();
        spread_.reset();
        next_ = solved_ = 0;
        round_++;
    }
    return true;
}

// The nearest of each earlier visit.
std::vector<LoopSearch::Place> LoopSearch::places_near(int k) const
{
    const std::vector<Spread> spread = spread_->from(k);
    const Node &here = (*nodes_)[static_cast<size_t>(k)];
    std::vector<NearPlace> near;
    for (int there = 0; there < k; there++) {
        const auto at = static_cast<size_t>(there);
        if (here.path_m - (*nodes_)[at].path_m < loop_min_path_m) {
            break;
        }
        const Pose off = between(graph_.poses()[at], graph_.poses()[static_cast<size_t>(k)]);
        const double distance = length(off.x, off.y);
        if (distance < reach_m + window_of(spread[at]).half_m) {
            near.push_back({there, distance + metres_a_radian * std::abs(off.theta)});
        }
    }
    const std::vector<int> chosen = nearest_of_each_visit(std::move(near), same_visit_nodes, most_places);
    std::vector<Place> places;
    for (const int there : chosen) {
        places.push_back({there, window_of(spread[static_cast<size_t>(there)])});
    }
    return places;
}

void LoopSearch::look_from(int k)
{
    if (!spread_) {
        spread_.emplace(graph_);
    }
    const std::vector<Place> places = places_near(k);
    if (places.empty()) {
        return;
    }
    const std::vector<SurfacePoint> seen = patch_around(*nodes_, graph_.poses(), k, patch_here);
    for (const Place &place : places) {
        const std::optional<Found> found = look_at(place, k, seen);
        if (found && !is_contradicted(found->loop)) {
            found_.push_back(*found);
        }
    }
}

std::optional<LoopSearch::Found> LoopSearch::look_at(const Place &place, int k,
                                                     const std::vector<SurfacePoint> &seen) const
{
    const std::vector<Pose> &poses = graph_.poses();
    const Pose guess = between(poses[static_cast<size_t>(place.k)], poses[static_cast<size_t>(k)]);
    const SurfaceField field(patch_around(*nodes_, poses, place.k, patch_there));
    const auto is_displaced = [&guess](const LoopMatch &match) {
        const Pose off = between(guess, match.pose);
        return length(off.x, off.y) >= near_m || std::abs(off.theta) >= near_rad;
    };
    const LoopMatch close_by = match_near(seen, field, guess);
    if (close_by.overlap > clear_overlap && !is_displaced(close_by)) {
        return Found{loop_by(close_by, place.k, k), false};
    }
    const LoopMatch match =
        match_patch(seen, corners_around(*nodes_, poses, k, corners_here), field,
                    corners_around(*nodes_, poses, place.k, corners_there), guess, place.window);
    const bool displaced = is_displaced(match);
    const double in_view = displaced ? share_in_view(seen, place.k, match.pose) : 1;
    if (!is_sight(match, std::max(least_in_view, in_view))) {
        return std::nullopt;
    }
    return Found{loop_by(match, place.k, k), displaced};
}

// Of points seen from `pose`, as the node `from` has it, the share that some node around that one had in
// view.
double LoopSearch::share_in_view(const std::vector<SurfacePoint> &seen, int from, const Pose &pose) const
{
    const std::vector<Pose> &poses = graph_.poses();
    std::vector<bool> in_view(seen.size(), false);
    for (const int viewer : viewers_of(poses, from, patch_there)) {
        const auto at = static_cast<size_t>(viewer);
        const Pose place = compose(between(poses[at], poses[static_cast<size_t>(from)]), pose);
        const Eigen::Matrix2d r = rotation(place.theta);
        for (size_t k = 0; k < seen.size(); k++) {
            in_view[k] = in_view[k] || free_[at].reaches(r * seen[k].p + Eigen::Vector2d(place.x, place.y));
        }
    }
    const auto count = static_cast<double>(std::count(in_view.begin(), in_view.end(), true));
    return seen.empty() ? 0 : count / static_cast<double>(seen.size());
}

// Whether what was seen here lies where was seen from there to be nothing.
bool LoopSearch::is_contradicted(const Loop &loop) const
{
    const std::vector<Pose> &poses = graph_.poses();
    const int count = static_cast<int>(nodes_->size());
    Contradiction sum;
    for (int there = std::max(0, loop.from - patch_there.before);
         there <= std::min(count - 1, loop.from + patch_there.after); there += viewer_stride) {
        const Pose place = compose(
            between(poses[static_cast<size_t>(there)], poses[static_cast<size_t>(loop.from)]), loop.measured);
        for (int here = std::max(0, loop.to - patch_here.before);
             here <= std::min(count - 1, loop.to + patch_here.after); here++) {
            const auto at = static_cast<size_t>(here);
            free_[static_cast<size_t>(there)].confront(
                (*nodes_)[at], compose(place, between(poses[static_cast<size_t>(loop.to)], poses[at])), &sum);
        }
    }
    return sum.in_free > most_in_free * sum.points;
}

bool LoopSearch::is_believed(const Found &found) const
{
    const bool clear = found.loop.overlap >= clear_overlap;
    const auto partners = std::count_if(found_.begin(), found_.end(), [&](const Found &other) {
        return std::abs(other.loop.to - found.loop.to) <= partner_nodes &&
               std::abs(other.loop.from - found.loop.from) <= partner_places &&
               agree(found.loop, other.loop, graph_.poses());
    });
    return partners >= (clear ? partners_when_clear : partners_when_sparse);
}

// Motions, the loops of this round, and of those before that were believed what was not found again.
std::vector<GraphEdge> LoopSearch::edges() const
{
    std::vector<GraphEdge> edges;
    for (const Found &found : found_) {
        if (is_believed(found)) {
            edges.push_back(edge_by(found.loop));
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

// What pulled two visits together may not be found from where they then lie.
void LoopSearch::keep_displaced()
{
    for (const Found &found : found_) {
        const GraphEdge edge = edge_by(found.loop);
        if (found.displaced && is_believed(found) && graph_.weight(edge) > least_weight_kept) {
            given_.push_back(edge);
        }
    }
}

void LoopSearch::solve()
{
    if (solved_ == 0) {
        graph_.set_edges(edges());
    }
    graph_.optimise(1, std::max(robust_kernel, std::ldexp(widest_kernel, -(solved_ / 2))));
    solved_++;
}

} // namespace ale
