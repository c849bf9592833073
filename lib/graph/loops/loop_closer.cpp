#include "graph/loops/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "graph/loops/submap.h"
#include "graph/optimise/scan_node.h"
#include "graph/optimise/thinning.h"
#include "graph/walls/building_direction.h"

namespace ale
{

namespace
{

constexpr int present_nodes = 2 * visit_nodes;
constexpr size_t confirmations_when_clear = 1;
constexpr size_t confirmations_when_sparse = 3;
constexpr size_t confirmations_when_near = 2;
constexpr size_t pending_loops = 12;
constexpr int optimise_iterations = 10;
constexpr int straighten_rounds = 2;
// All that one keyframe may cause: a loop for each candidate, or one and the building constraint.
constexpr int iterations_a_keyframe = optimise_iterations * (1 + straighten_rounds);
static_assert(iterations_a_keyframe >= optimise_iterations * static_cast<int>(most_visits));
constexpr size_t straighten_every = 8; // keyframes
constexpr double most_chi2 = 30;       // of an accepted loop after optimisation
// Accuracy of a join that no match confirms, and how far a match may lie from it.
constexpr double join_m = 0.05;
constexpr double join_rad = 0.02;
constexpr double join_gate_m = 0.20;
constexpr double join_gate_rad = 0.08;

} // namespace

LoopCloser::LoopCloser(size_t capacity) : capacity_(std::max(capacity, least_capacity))
{
    nodes_.resize(capacity_); // touched
    nodes_.clear();
    graph_.reserve(capacity_, capacity_ * (1 + most_visits));
    neighbours_.reserve(capacity_);
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
    neighbours_.add(nodes_, graph_);
    iterations_left_ = iterations_a_keyframe;
    bool moved = tie_joined_map();
    for (const int candidate : earlier_visits(nodes_, graph_.poses())) {
        moved = evaluate_candidate(candidate) || moved;
    }
    moved = (prior_ && present_map() == ALE_FIRST_MAP && match_prior_map()) || moved;
    moved = straighten() || moved;
    joiner_.drive(searched_maps());
    return moved;
}

// What maps are searched for and in. In the saved map nothing is searched as long as all of the drive is in
// it.
SearchedMaps LoopCloser::searched_maps()
{
    const bool all_in_first = count_maps(nodes_) == 1 && present_map() == ALE_FIRST_MAP;
    return {nodes_, graph_.poses(), graph_.edges(), prior_ && !all_in_first ? &prior_->views() : nullptr};
}

void LoopCloser::append(Node node, const Pose &motion)
{
    refined_ = false;
    kind_ = MapKind::drives;
    node.guess = Guess::anywhere; // where a drive begins, and by which clock, is its own
    node.stamp_us = 0;
    nodes_.push_back(std::move(node));
    link_to_previous(motion);
    joiner_.restart();
}

void LoopCloser::add_walls(const Pose &smooth, const std::vector<WallDirection> &walls)
{
    if (!nodes_.empty()) {
        add_later_walls(smooth, walls, &nodes_.back());
    }
}

bool LoopCloser::join_maps(std::vector<FoundJoin> *made)
{
    const bool goes_on = joiner_.refine(searched_maps(), kind_);
    if (goes_on && joiner_.found()) {
        if (made) {
            made->push_back(*joiner_.found());
        }
        make_found_join();
    }
    return goes_on;
}

bool LoopCloser::refine()
{
    if (refined_ || nodes_.size() < 2) {
        return false;
    }
    if (!search_ && join_maps()) {
        return true;
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
        added_ < straightened_at_ + straighten_every || !has_heading_drift(building(), graph_.poses())) {
        return false;
    }
    straightened_at_ = added_;
    const PoseGraph before = graph_;
    for (int round = 0; round < straighten_rounds; round++) {
        graph_.set_building_constraint(building());
        if (!optimise()) {
            graph_ = before;
            return false;
        }
    }
    if (neighbours_.contradict_building(nodes_, graph_, present_map())) {
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
    const auto match = prior_->find(submap_around(nodes_, graph_.poses(), here, visit_here), guess);
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
    const GraphReport report = optimise_map(present_map());
    iterations_left_ -= report.iterations;
    return report.solved;
}

// Other maps stay as they are: nothing ties them to this one.
GraphReport LoopCloser::optimise_map(uint32_t map_id)
{
    graph_.hold(nodes_outside(map_id));
    const GraphReport report = graph_.optimise(optimise_iterations);
    graph_.hold({});
    return report;
}

// Which nodes may go for others: not the first, which holds the map, nor those of the present visit and of
// loops that wait for confirmation; nor, if that leaves any, the first node of a map, from which on its walls
// move with it.
std::vector<bool> LoopCloser::removable_nodes() const
{
    std::vector<bool> removable(nodes_.size(), true);
    const auto keep = [&removable](int k) { removable[static_cast<size_t>(k)] = false; };
    keep(0);
    std::fill(removable.end() - present_nodes, removable.end(), false);
    for (const Loop &loop : pending_) {
        keep(loop.from);
        keep(loop.to);
    }
    const std::vector<bool> with_beginnings = removable;
    for (const GraphEdge &edge : graph_.edges()) {
        if (edge.guess != Guess::none) {
            keep(edge.to);
        }
    }
    const bool any = std::find(removable.begin(), removable.end(), true) != removable.end();
    return any ? removable : with_beginnings;
}

// Removes the most redundant node of a full graph.
void LoopCloser::make_room()
{
    if (nodes_.size() < capacity_) {
        return;
    }
    const std::optional<size_t> redundant = most_redundant(graph_.poses(), removable_nodes());
    if (!redundant) {
        return; // cannot happen: least_capacity exceeds what is kept
    }
    const int k = static_cast<int>(*redundant);
    nodes_.erase(nodes_.begin() + k);
    graph_.remove_pose(k, static_cast<int>(most_visits));
    const auto move_up = [k](int *node) { *node -= *node > k ? 1 : 0; };
    for (Loop &loop : pending_) {
        move_up(&loop.from);
        move_up(&loop.to);
    }
    neighbours_.remove_node(k);
    joiner_.remove_node(k);
    statistics_.thinned++;
}

void LoopCloser::reset()
{
    nodes_.clear();
    graph_.clear();
    prior_.reset();
    pending_.clear();
    neighbours_.clear();
    pace_ = {};
    maps_.clear();
    joined_at_.reset();
    joiner_.reset();
    search_.reset();
    refinement_.reset();
    refined_ = false;
    kind_ = MapKind::pieces;
    added_ = straightened_at_ = 0;
    statistics_ = {};
}

void LoopCloser::mark_handed_out()
{
    for (size_t k = 0; k < nodes_.size(); k++) {
        nodes_[k].tracked = graph_.poses()[k];
    }
}

BuildingConstraint LoopCloser::building() const
{
    return building_constraint_from_walls(nodes_, graph_.poses(), {WallSource::keyframes, present_map()});
}

void LoopCloser::link_to_previous(const Pose &motion)
{
    const int k = static_cast<int>(nodes_.size()) - 1;
    if (k == 0) {
        graph_.add_pose(motion);
        return;
    }
    graph_.add_pose(compose(graph_.poses().back(), motion));
    const Node &before = at(nodes_, k - 1);
    GraphEdge edge = odometry_edge(k, before, nodes_.back(), motion);
    pace_.add(before, nodes_.back(), motion);
    edge.reach_m = edge.guess == Guess::anywhere ? pace_.reach_m(before, nodes_.back()) : 0;
    graph_.add_edge(edge);
}

// Matches a candidate. A displaced place is tied if others confirm it, else it waits; a recognised one is
// tied as tracked. True: the graph has moved.
bool LoopCloser::evaluate_candidate(int candidate)
{
    statistics_.candidates++;
    const auto [outcome, loop] = match_visit(nodes_, graph_.poses(), candidate);
    switch (outcome) {
    case VisitMatch::unclear:
        statistics_.unclear++;
        return false;
    case VisitMatch::recognised:
        statistics_.recognised++;
        graph_.add_edge({loop.from, loop.to, loop.measured, loop.information, true, true});
        return false;
    case VisitMatch::displaced:
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
    std::copy_if(pending_.begin(), pending_.end(), std::back_inserter(confirmations), [&](const Loop &other) {
        return at(nodes_, other.to).map_id == present_map() && are_consistent(other, loop, graph_.poses());
    });
    return confirmations;
}

void LoopCloser::join(const MapJoin &join, const Pose &here)
{
    make_room(); // now, and not when the node is added: its place keeps its number
    joined_at_ = visit_near(nodes_, graph_.poses(), here, join.into_map_id);
    move_tracked(join.map_id, join.shift);
    unite(join);
    joiner_.restart();
}

void LoopCloser::make_found_join()
{
    const FoundJoin found = *joiner_.found();
    joiner_.forget_found();
    make_join(found);
}

void LoopCloser::make_join(const FoundJoin &found)
{
    unite(found.join);
    for (const Loop &loop : found.loops) {
        graph_.add_edge(joining_edge_of(loop));
    }
    for (const PosePrior &prior : found.on_prior) {
        graph_.add_pose_prior(prior);
    }
    optimise_map(found.join.into_map_id);
}

void LoopCloser::mark_join_handed_out()
{
    const MapJoin &join = joiner_.found()->join;
    move_tracked(join.map_id, join.shift);
}

void LoopCloser::withdraw_join()
{
    const MapJoin &join = joiner_.found()->join;
    move_tracked(join.map_id, inverse(join.shift));
    joiner_.forget_found();
}

void LoopCloser::move_tracked(uint32_t map_id, const Pose &shift)
{
    for (Node &node : nodes_) {
        node.tracked = node.map_id == map_id ? compose(shift, node.tracked) : node.tracked;
    }
}

// All of a map moves, and is part of the other from now on.
void LoopCloser::unite(const MapJoin &join)
{
    std::vector<bool> moved = nodes_outside(join.map_id);
    moved.flip();
    for (size_t k = 0; k < nodes_.size(); k++) {
        nodes_[k].map_id = moved[k] ? join.into_map_id : nodes_[k].map_id;
    }
    graph_.move_rigidly(moved, join.shift);
    maps_.join(join.map_id, join.into_map_id);
    statistics_.joins++;
}

// Where the present node has joined an older map its place there holds the two together: as matched, or, if
// no match is clear and near, as the tracker has recognised it. True: the graph has moved.
bool LoopCloser::tie_joined_map()
{
    if (!joined_at_) {
        return false;
    }
    const auto [there, extent] = *joined_at_;
    joined_at_.reset();
    const int here = static_cast<int>(nodes_.size()) - 1;
    auto [outcome, loop] = match_visit(nodes_, graph_.poses(), there, extent);
    const Pose guess = between(graph_.poses(), there, here);
    const Pose off = between(guess, loop.measured);
    const bool is_matched = outcome != VisitMatch::unclear && length(off.x, off.y) < join_gate_m &&
                            std::abs(off.theta) < join_gate_rad;
    if (!is_matched) {
        loop = {there, here, guess, information_from_deviations(join_m, join_rad), 0};
    }
    graph_.add_edge(joining_edge_of(loop));
    return outcome == VisitMatch::displaced && is_matched && optimise();
}

// One flag for each node.
std::vector<bool> LoopCloser::nodes_outside(uint32_t map_id) const
{
    std::vector<bool> outside(nodes_.size());
    for (size_t k = 0; k < nodes_.size(); k++) {
        outside[k] = nodes_[k].map_id != map_id;
    }
    return outside;
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
