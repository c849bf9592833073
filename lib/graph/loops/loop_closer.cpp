#include "graph/loops/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "graph/loops/likelihood_field.h"
#include "graph/loops/pairwise_match.h"
#include "graph/loops/place_candidates.h"
#include "graph/loops/submap.h"
#include "graph/optimise/thinning.h"
#include "graph/walls/building_direction.h"

namespace ale
{

namespace
{

constexpr size_t loop_candidates = 3;
constexpr double loop_reach_m = 2.5;      // of places, beside drift
constexpr double drift_per_metre = 0.008; // of the guess
constexpr double drift_rad_per_metre = 0.002;
constexpr double max_window_m = 2.0;
constexpr double max_window_rad = 0.35;
constexpr int submap_nodes = 6; // to each side of the place
constexpr int present_nodes = 2 * submap_nodes;
constexpr SubmapExtent submap_there{submap_nodes, submap_nodes};
constexpr SubmapExtent submap_here{2, 0};
constexpr SubmapExtent corners_there{2, 2};
constexpr size_t confirmations_when_clear = 1;
constexpr size_t confirmations_when_sparse = 3;
constexpr size_t confirmations_when_near = 2;
// A match this near to the tracked pose: the tracker has recognised the place, more accurately than the
// match.
constexpr double near_m = 0.05;
constexpr double near_rad = 0.015;
// Accuracy of the tracker there.
constexpr double recognised_m = 0.015;
constexpr double recognised_rad = 0.004;
constexpr size_t pending_loops = 12;
constexpr int optimise_iterations = 10;
constexpr int straighten_rounds = 2;
// All that one keyframe may cause: a loop for each candidate, or one and the building constraint.
constexpr int iterations_a_keyframe = optimise_iterations * (1 + straighten_rounds);
static_assert(iterations_a_keyframe >= optimise_iterations * static_cast<int>(loop_candidates));
constexpr size_t straighten_every = 8; // keyframes
constexpr int neighbours_back = 2;     // nodes
constexpr double most_chi2 = 30;       // of an accepted loop after optimisation
// Factors on the errors of an odometry edge that was extrapolated, or is unknown.
constexpr double weak_factor = 3;
constexpr double broken_factor = 50;

// Information of the tracked motion between neighbouring nodes.
Eigen::Matrix3d motion_information(const Pose &motion, const Node &to)
{
    const double distance = length(motion.x, motion.y);
    const double turn = std::abs(motion.theta);
    const double factor = to.broken ? broken_factor : (to.weak ? weak_factor : 1);
    const double sigma_m = factor * (0.004 + 0.008 * distance + 0.004 * turn);
    const double sigma_rad = factor * (0.0015 + 0.002 * distance + 0.004 * turn);
    return information_from_deviations(sigma_m, sigma_rad);
}

bool is_near(const Pose &guess, const Pose &matched)
{
    const Pose off = between(guess, matched);
    return length(off.x, off.y) < near_m && std::abs(off.theta) < near_rad;
}

bool is_recognised(const Pose &guess, const LoopMatch &match, double overlap)
{
    return match.found && match.overlap >= overlap && is_near(guess, match.pose);
}

} // namespace

LoopCloser::LoopCloser(size_t capacity) : capacity_(std::max(capacity, least_capacity))
{
    nodes_.resize(capacity_); // touched
    nodes_.clear();
    graph_.reserve(capacity_, capacity_ * (1 + loop_candidates));
    neighbours_.resize(capacity_ * neighbours_back); // touched
    neighbours_.clear();
}

bool LoopCloser::add(Node node, const Pose &motion)
{
    make_room();
    search_.reset();
    refinement_.reset();
    refined_ = false;
    if (node.broken && !nodes_.empty()) {
        // The break may lie anywhere between the two nodes.
        nodes_.back().later_walls.clear();
        nodes_.back().later_scans = 0;
    }
    nodes_.push_back(std::move(node));
    added_++;
    link_to_previous(motion);
    match_neighbours();
    bool moved = false;
    iterations_left_ = iterations_a_keyframe;
    for (const int candidate : candidates()) {
        moved = evaluate_candidate(candidate) || moved;
    }
    moved = (prior_ && match_prior_map()) || moved;
    return straighten() || moved;
}

void LoopCloser::add_walls(const Pose &smooth, const std::vector<WallDirection> &walls)
{
    if (nodes_.empty() || nodes_.back().later_scans == most_later_scans) {
        return;
    }
    Node &node = nodes_.back();
    const double turned = smooth.theta - node.smooth.theta;
    for (const WallDirection &wall : walls) {
        node.later_walls.push_back({wrapped(wall.direction_rad + turned), wall.length_m});
    }
    node.later_scans++;
}

bool LoopCloser::refine()
{
    if (refined_ || nodes_.size() < 2) {
        return false;
    }
    if (!search_) {
        search_.emplace(&nodes_, graph_);
    }
    if (search_->step()) {
        return true;
    }
    if (!refinement_) {
        refinement_.emplace(&nodes_, search_->graph(), prior_ ? &*prior_ : nullptr);
    }
    if (refinement_->step()) {
        return true;
    }
    graph_ = refinement_->graph();
    search_.reset();
    refinement_.reset();
    refined_ = true;
    return false;
}

// Corrects heading drift by the building constraint. Twice: large drift confuses the directions. Waits for
// the next node if loops have used up the iterations.
bool LoopCloser::straighten()
{
    if (iterations_left_ < straighten_rounds * optimise_iterations ||
        added_ < straightened_at_ + straighten_every ||
        !has_heading_drift(building_constraint_from_walls(nodes_, graph_.poses()), graph_.poses())) {
        return false;
    }
    straightened_at_ = added_;
    const PoseGraph before = graph_;
    for (int round = 0; round < straighten_rounds; round++) {
        graph_.set_building_constraint(building_constraint_from_walls(nodes_, graph_.poses()));
        if (!optimise()) {
            graph_ = before;
            return false;
        }
    }
    if (neighbours_contradict_building()) {
        graph_ = before; // no drift: the building is bent
        return false;
    }
    statistics_.straightened++;
    return true;
}

// Ties the present node to the walls of the prior map. As with loops: a node already on them keeps its
// tracked pose.
bool LoopCloser::match_prior_map()
{
    const int here = static_cast<int>(nodes_.size()) - 1;
    const Pose guess = graph_.poses().back();
    const auto match = prior_->find(submap_around(nodes_, graph_.poses(), here, submap_here), guess);
    if (!match) {
        return false;
    }
    const bool is_on_map = is_near(guess, match->pose);
    if (is_on_map || iterations_left_ < optimise_iterations) {
        graph_.add_pose_prior({here, is_on_map ? guess : match->pose, match->information});
        return false;
    }
    const PoseGraph before = graph_;
    graph_.add_pose_prior({here, match->pose, match->information});
    if (!optimise() || graph_.residual2(graph_.pose_priors().back()) > most_chi2) {
        graph_ = before;
        return false;
    }
    return true;
}

bool LoopCloser::optimise()
{
    const GraphReport report = graph_.optimise(optimise_iterations);
    iterations_left_ -= report.iterations;
    return report.solved;
}

// Removes the most redundant node of a full graph. Kept are the first node, which holds the map, the nodes of
// the present visit, and those of loops that wait for confirmation.
void LoopCloser::make_room()
{
    if (nodes_.size() < capacity_) {
        return;
    }
    std::vector<bool> removable(nodes_.size(), true);
    removable.front() = false;
    std::fill(removable.end() - present_nodes, removable.end(), false);
    for (const Loop &loop : pending_) {
        removable[static_cast<size_t>(loop.from)] = removable[static_cast<size_t>(loop.to)] = false;
    }
    const std::optional<size_t> redundant = most_redundant(graph_.poses(), removable);
    if (!redundant) {
        return; // cannot happen: least_capacity exceeds what is kept
    }
    const int k = static_cast<int>(*redundant);
    nodes_.erase(nodes_.begin() + k);
    graph_.remove_pose(k, static_cast<int>(loop_candidates));
    const auto move_up = [k](int *node) { *node -= *node > k ? 1 : 0; };
    for (Loop &loop : pending_) {
        move_up(&loop.from);
        move_up(&loop.to);
    }
    const auto ends_there = [k](const NeighbourMatch &pair) {
        return pair.match.from == k || pair.match.to == k;
    };
    neighbours_.erase(std::remove_if(neighbours_.begin(), neighbours_.end(), ends_there), neighbours_.end());
    for (NeighbourMatch &pair : neighbours_) {
        move_up(&pair.match.from);
        move_up(&pair.match.to);
    }
    statistics_.thinned++;
}

void LoopCloser::reset()
{
    nodes_.clear();
    graph_.clear();
    prior_.reset();
    pending_.clear();
    neighbours_.clear();
    search_.reset();
    refinement_.reset();
    refined_ = false;
    added_ = straightened_at_ = 0;
    statistics_ = {};
}

void LoopCloser::mark_handed_out()
{
    for (size_t k = 0; k < nodes_.size(); k++) {
        nodes_[k].tracked = graph_.poses()[k];
    }
}

void LoopCloser::link_to_previous(const Pose &motion)
{
    const int k = static_cast<int>(nodes_.size()) - 1;
    const Node &here = nodes_.back();
    if (k == 0) {
        graph_.add_pose(motion);
        return;
    }
    graph_.add_pose(compose(graph_.poses().back(), motion));
    graph_.add_edge({k - 1, k, motion, motion_information(motion, here), false});
}

void LoopCloser::match_neighbours()
{
    const int here = static_cast<int>(nodes_.size()) - 1;
    const LikelihoodField field(nodes_.back().points);
    for (int there = std::max(0, here - neighbours_back); there < here; there++) {
        const Pose guess = between(graph_.poses(), here, there);
        if (const auto match = match_pair(field, at(nodes_, there).points, guess)) {
            const GraphEdge edge{here, there, match->pose, match->information, true};
            neighbours_.push_back({edge, graph_.misfit(edge)});
        }
    }
}

bool LoopCloser::neighbours_contradict_building() const
{
    double misfit = 0;
    double tracked = 0;
    for (const NeighbourMatch &pair : neighbours_) {
        misfit += graph_.misfit(pair.match);
        tracked += pair.misfit;
    }
    const bool drifted = true; // else straighten() would not have been called
    return matches_contradict(misfit, tracked, neighbours_.size(), drifted);
}

// Earlier nodes near the present pose, visited long ago: the nearest of each visit.
std::vector<int> LoopCloser::candidates() const
{
    const Pose &here = graph_.poses().back();
    std::vector<PlaceCandidate> places;
    for (size_t k = 0; k < nodes_.size(); k++) {
        const double driven_m = nodes_.back().path_m - nodes_[k].path_m;
        if (driven_m < loop_min_path_m) {
            break;
        }
        const Pose &there = graph_.poses()[k];
        const double distance = length(there.x - here.x, there.y - here.y);
        if (distance < loop_reach_m + std::min(max_window_m, drift_per_metre * driven_m)) {
            places.push_back({static_cast<int>(k), distance});
        }
    }
    return nearest_of_each_visit(std::move(places), 2 * submap_nodes, loop_candidates);
}

// Matches a candidate. A displaced place is tied if others confirm it, else it waits; a recognised one is
// tied as tracked. True: the graph has moved.
bool LoopCloser::evaluate_candidate(int candidate)
{
    statistics_.candidates++;
    Loop loop;
    switch (match_candidate(candidate, &loop)) {
    case MatchOutcome::unclear:
        statistics_.unclear++;
        return false;
    case MatchOutcome::recognised:
        statistics_.recognised++;
        graph_.add_edge({loop.from, loop.to, loop.measured, loop.information, true, true});
        return false;
    case MatchOutcome::displaced:
        break;
    }
    const std::vector<Loop> confirmations = confirmations_of(loop);
    const bool moved = confirmations.size() >= confirmations_needed(loop) && close_loop(loop, confirmations);
    pending_.push_back(loop);
    if (pending_.size() > pending_loops) {
        pending_.pop_front();
        statistics_.unconfirmed++;
    }
    return moved;
}

LoopCloser::MatchOutcome LoopCloser::match_candidate(int candidate, Loop *loop) const
{
    const int here = static_cast<int>(nodes_.size()) - 1;
    const double driven_m = nodes_.back().path_m - at(nodes_, candidate).path_m;
    const SearchWindow window{std::min(max_window_m, 0.3 + drift_per_metre * driven_m),
                              std::min(max_window_rad, 0.07 + drift_rad_per_metre * driven_m)};
    const LikelihoodField field(submap_around(nodes_, graph_.poses(), candidate, submap_there));
    const Pose guess = between(graph_.poses(), candidate, here);
    const std::vector<SurfacePoint> seen = submap_around(nodes_, graph_.poses(), here, submap_here);
    *loop = {candidate, here, guess, information_from_deviations(recognised_m, recognised_rad), 1};
    if (is_recognised(guess, match_locally(seen, field, guess), clear_overlap)) {
        return MatchOutcome::recognised;
    }
    const LoopMatch match =
        match_submap(seen, nodes_.back().corners, field,
                     corners_around(nodes_, graph_.poses(), candidate, corners_there), guess, window);
    if (!is_acceptable(match)) {
        return MatchOutcome::unclear;
    }
    if (is_recognised(guess, match, least_overlap)) {
        return MatchOutcome::recognised;
    }
    *loop = loop_from_match(match, candidate, here);
    return MatchOutcome::displaced;
}

// How many other loops must confirm it. A place as far off as drift explains is likelier than one that is
// not.
size_t LoopCloser::confirmations_needed(const Loop &loop) const
{
    const Pose off = between(between(graph_.poses(), loop.from, loop.to), loop.measured);
    const double driven_m = at(nodes_, loop.to).path_m - at(nodes_, loop.from).path_m;
    if (loop.overlap >= clear_overlap) {
        return confirmations_when_clear;
    }
    return length(off.x, off.y) < drift_per_metre * driven_m ? confirmations_when_near
                                                             : confirmations_when_sparse;
}

// Waiting loops from other nodes that are consistent with it.
std::vector<Loop> LoopCloser::confirmations_of(const Loop &loop) const
{
    std::vector<Loop> confirmations;
    std::copy_if(pending_.begin(), pending_.end(), std::back_inserter(confirmations),
                 [&](const Loop &other) { return are_consistent(other, loop, graph_.poses()); });
    return confirmations;
}

bool LoopCloser::is_in_graph(const Loop &loop) const
{
    return std::any_of(graph_.edges().begin(), graph_.edges().end(),
                       [&](const GraphEdge &edge) { return edge.from == loop.from && edge.to == loop.to; });
}

// Adds the loop and those that confirm it; removes all again if the graph then contradicts the loop.
bool LoopCloser::close_loop(const Loop &loop, const std::vector<Loop> &confirmations)
{
    const PoseGraph before = graph_;
    for (const Loop &other : confirmations) {
        if (!is_in_graph(other)) {
            graph_.add_edge(edge_of(other));
        }
    }
    graph_.add_edge(edge_of(loop));
    if (!optimise() || graph_.residual2(graph_.edges().back()) > most_chi2) {
        graph_ = before;
        statistics_.contradicted++;
        return false;
    }
    statistics_.loops++;
    return true;
}

} // namespace ale
