#include "graph/loops/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "graph/loops/patch.h"
#include "graph/loops/surface_field.h"
#include "graph/loops/tight_match.h"
#include "graph/loops/visits.h"
#include "graph/optimise/thinning.h"
#include "graph/walls/building_axes.h"

namespace ale
{

namespace
{

constexpr size_t loop_candidates = 3;
constexpr double loop_reach_m = 2.5;      // places this near, beside what drift may have done
constexpr double drift_per_metre = 0.008; // how far the guess may have drifted
constexpr double drift_rad_per_metre = 0.002;
constexpr double max_window_m = 2.0;
constexpr double max_window_rad = 0.35;
constexpr int patch_nodes = 6; // to each side of the place
constexpr int present_nodes = 2 * patch_nodes;
constexpr PatchExtent patch_there{patch_nodes, patch_nodes};
constexpr PatchExtent patch_here{2, 0};
constexpr PatchExtent corners_there{2, 2};
constexpr size_t partners_when_clear = 1;
constexpr size_t partners_when_sparse = 3;
constexpr size_t partners_when_near = 2;
// Nearer than this the tracker has recognised the place itself, better than a loop edge would tie it.
constexpr double known_m = 0.05;
constexpr double known_rad = 0.015;
// How well it then knows it.
constexpr double recognised_m = 0.015;
constexpr double recognised_rad = 0.004;
constexpr size_t pending_loops = 12;
constexpr int optimise_iterations = 10;
constexpr int straighten_rounds = 2;
// All that may follow from one keyframe: a loop for each candidate, or one and walls as a compass.
constexpr int iterations_a_keyframe = optimise_iterations * (1 + straighten_rounds);
static_assert(iterations_a_keyframe >= optimise_iterations * static_cast<int>(loop_candidates));
constexpr size_t straighten_every = 8; // keyframes
constexpr int neighbours_back = 2;     // nodes
constexpr double believable_chi2 = 30; // of a loop edge after optimisation
constexpr double weak_doubt = 3;       // how much worse a motion is known that wheels had to tell
constexpr double broken_doubt = 50;    // or nobody

// Relative motion between neighbouring nodes as the tracker measured it.
Eigen::Matrix3d motion_information(const Pose &motion, const Node &to)
{
    const double distance = length(motion.x, motion.y);
    const double turn = std::abs(motion.theta);
    const double doubt = to.broken ? broken_doubt : (to.weak ? weak_doubt : 1);
    const double sigma_m = doubt * (0.004 + 0.008 * distance + 0.004 * turn);
    const double sigma_rad = doubt * (0.0015 + 0.002 * distance + 0.004 * turn);
    return known_to(sigma_m, sigma_rad);
}

bool is_known(const Pose &guess, const Pose &matched)
{
    const Pose off = between(guess, matched);
    return length(off.x, off.y) < known_m && std::abs(off.theta) < known_rad;
}

bool is_recognised(const Pose &guess, const LoopMatch &match, double overlap)
{
    return match.found && match.overlap >= overlap && is_known(guess, match.pose);
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
        // Since when, nobody knows.
        nodes_.back().walls_after.clear();
        nodes_.back().scans_after = 0;
    }
    nodes_.push_back(std::move(node));
    added_++;
    link_to_previous(motion);
    match_neighbours();
    bool moved = false;
    iterations_left_ = iterations_a_keyframe;
    for (const int there : candidates()) {
        moved = look_at(there) || moved;
    }
    moved = (known_ && lay_on_known()) || moved;
    return straighten() || moved;
}

void LoopCloser::see_walls(const Pose &smooth, const std::vector<WallSight> &walls)
{
    if (nodes_.empty() || nodes_.back().scans_after == most_scans_after) {
        return;
    }
    Node &node = nodes_.back();
    const double turned = smooth.theta - node.smooth.theta;
    for (const WallSight &wall : walls) {
        node.walls_after.push_back({wrapped(wall.direction + turned), wall.length_m});
    }
    node.scans_after++;
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
        refinement_.emplace(&nodes_, search_->graph(), known_ ? &*known_ : nullptr);
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

// Turns what has drifted back to the directions of the walls. Twice: large drift hides which wall is which.
// Waits for the next node where loops have used up what it takes.
bool LoopCloser::straighten()
{
    if (iterations_left_ < straighten_rounds * optimise_iterations ||
        added_ < straightened_at_ + straighten_every ||
        !have_drifted(headings_by_walls(nodes_, graph_.poses()), graph_.poses())) {
        return false;
    }
    straightened_at_ = added_;
    const PoseGraph before = graph_;
    for (int round = 0; round < straighten_rounds; round++) {
        graph_.set_headings(headings_by_walls(nodes_, graph_.poses()));
        if (!optimise()) {
            graph_ = before;
            return false;
        }
    }
    if (are_neighbours_torn()) {
        graph_ = before; // no drift: the building bends
        return false;
    }
    statistics_.straightened++;
    return true;
}

// Ties the present node to the walls of the map that the drive began in. As with loops: where the tracker
// lies on them it knows better.
bool LoopCloser::lay_on_known()
{
    const int here = static_cast<int>(nodes_.size()) - 1;
    const Pose guess = graph_.poses().back();
    const auto match = known_->find(patch_around(nodes_, graph_.poses(), here, patch_here), guess);
    if (!match) {
        return false;
    }
    const bool known = is_known(guess, match->pose);
    if (known || iterations_left_ < optimise_iterations) {
        graph_.add_anchor({here, known ? guess : match->pose, match->information});
        return false;
    }
    const PoseGraph before = graph_;
    graph_.add_anchor({here, match->pose, match->information});
    if (!optimise() || graph_.residual2(graph_.anchors().back()) > believable_chi2) {
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

// The first node holds the map in its place, the last ones are the present visit, and loops that wait for
// confirmation are of these nodes and no others.
void LoopCloser::make_room()
{
    if (nodes_.size() < capacity_) {
        return;
    }
    std::vector<bool> may_go(nodes_.size(), true);
    may_go.front() = false;
    std::fill(may_go.end() - present_nodes, may_go.end(), false);
    for (const Loop &loop : pending_) {
        may_go[static_cast<size_t>(loop.from)] = may_go[static_cast<size_t>(loop.to)] = false;
    }
    const std::optional<size_t> gone = most_redundant(graph_.poses(), may_go);
    if (!gone) {
        return; // never: fewer are held than the least capacity
    }
    const int k = static_cast<int>(*gone);
    nodes_.erase(nodes_.begin() + k);
    graph_.take_out(k, static_cast<int>(loop_candidates));
    const auto move_up = [k](int *node) { *node -= *node > k ? 1 : 0; };
    for (Loop &loop : pending_) {
        move_up(&loop.from);
        move_up(&loop.to);
    }
    const auto ends_there = [k](const Neighbours &pair) {
        return pair.match.from == k || pair.match.to == k;
    };
    neighbours_.erase(std::remove_if(neighbours_.begin(), neighbours_.end(), ends_there), neighbours_.end());
    for (Neighbours &pair : neighbours_) {
        move_up(&pair.match.from);
        move_up(&pair.match.to);
    }
    statistics_.thinned++;
}

void LoopCloser::begin_anew()
{
    nodes_.clear();
    graph_.clear();
    known_.reset();
    pending_.clear();
    neighbours_.clear();
    search_.reset();
    refinement_.reset();
    refined_ = false;
    added_ = straightened_at_ = 0;
    statistics_ = {};
}

void LoopCloser::told()
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
    const SurfaceField field(nodes_.back().points);
    for (int there = std::max(0, here - neighbours_back); there < here; there++) {
        const Pose guess = between(graph_.poses().back(), graph_.poses()[static_cast<size_t>(there)]);
        if (const auto match = match_to(field, nodes_[static_cast<size_t>(there)].points, guess)) {
            const GraphEdge edge{here, there, match->pose, match->information, true};
            neighbours_.push_back({edge, graph_.misfit(edge)});
        }
    }
}

bool LoopCloser::are_neighbours_torn() const
{
    double misfit = 0;
    double tracked = 0;
    for (const Neighbours &pair : neighbours_) {
        misfit += graph_.misfit(pair.match);
        tracked += pair.misfit;
    }
    const bool drifted = true; // or the walls would not have had their say
    return are_torn(misfit, tracked, neighbours_.size(), drifted);
}

// Earlier nodes near the present pose, visited long ago: the nearest of each visit.
std::vector<int> LoopCloser::candidates() const
{
    const Pose &here = graph_.poses().back();
    std::vector<NearPlace> places;
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
    return nearest_of_each_visit(std::move(places), 2 * patch_nodes, loop_candidates);
}

// A place that is displaced is tied at once, or waits for others that say the same; one that the tracker has
// recognised is noted. Whether the graph has moved.
bool LoopCloser::look_at(int there)
{
    statistics_.candidates++;
    Loop loop;
    switch (look_for_loop(there, &loop)) {
    case Sight::unclear:
        statistics_.unclear++;
        return false;
    case Sight::known:
        statistics_.known++;
        graph_.add_edge({loop.from, loop.to, loop.measured, loop.information, true, true});
        return false;
    case Sight::displaced:
        break;
    }
    const std::vector<Loop> partners = partners_of(loop);
    const bool moved = partners.size() >= partners_wanted(loop) && close(loop, partners);
    pending_.push_back(loop);
    if (pending_.size() > pending_loops) {
        pending_.pop_front();
        statistics_.unconfirmed++;
    }
    return moved;
}

LoopCloser::Sight LoopCloser::look_for_loop(int there, Loop *loop) const
{
    const int here = static_cast<int>(nodes_.size()) - 1;
    const double driven_m = nodes_.back().path_m - nodes_[static_cast<size_t>(there)].path_m;
    const SearchWindow window{std::min(max_window_m, 0.3 + drift_per_metre * driven_m),
                              std::min(max_window_rad, 0.07 + drift_rad_per_metre * driven_m)};
    const SurfaceField field(patch_around(nodes_, graph_.poses(), there, patch_there));
    const Pose guess = between(graph_.poses()[static_cast<size_t>(there)], graph_.poses().back());
    const std::vector<SurfacePoint> seen = patch_around(nodes_, graph_.poses(), here, patch_here);
    *loop = {there, here, guess, known_to(recognised_m, recognised_rad), 1};
    if (is_recognised(guess, match_near(seen, field, guess), clear_overlap)) {
        return Sight::known;
    }
    const LoopMatch match =
        match_patch(seen, nodes_.back().corners, field,
                    corners_around(nodes_, graph_.poses(), there, corners_there), guess, window);
    if (!is_sight(match)) {
        return Sight::unclear;
    }
    if (is_recognised(guess, match, least_overlap)) {
        return Sight::known;
    }
    *loop = loop_by(match, there, here);
    return Sight::displaced;
}

// How many others must say the same. A place that lies where drift would have left it is likelier than one
// that does not.
size_t LoopCloser::partners_wanted(const Loop &loop) const
{
    const Pose guess =
        between(graph_.poses()[static_cast<size_t>(loop.from)], graph_.poses()[static_cast<size_t>(loop.to)]);
    const Pose off = between(guess, loop.measured);
    const double driven_m =
        nodes_[static_cast<size_t>(loop.to)].path_m - nodes_[static_cast<size_t>(loop.from)].path_m;
    if (loop.overlap >= clear_overlap) {
        return partners_when_clear;
    }
    return length(off.x, off.y) < drift_per_metre * driven_m ? partners_when_near : partners_when_sparse;
}

// Other loops, found from other nodes, that say the same.
std::vector<Loop> LoopCloser::partners_of(const Loop &loop) const
{
    std::vector<Loop> partners;
    std::copy_if(pending_.begin(), pending_.end(), std::back_inserter(partners),
                 [&](const Loop &other) { return agree(other, loop, graph_.poses()); });
    return partners;
}

bool LoopCloser::is_tied(const Loop &loop) const
{
    return std::any_of(graph_.edges().begin(), graph_.edges().end(),
                       [&](const GraphEdge &edge) { return edge.from == loop.from && edge.to == loop.to; });
}

// Ties the loop and those that agree with it; takes all back when the graph then contradicts them.
bool LoopCloser::close(const Loop &loop, const std::vector<Loop> &partners)
{
    const PoseGraph before = graph_;
    for (const Loop &partner : partners) {
        if (!is_tied(partner)) {
            graph_.add_edge({partner.from, partner.to, partner.measured, partner.information, true});
        }
    }
    graph_.add_edge({loop.from, loop.to, loop.measured, loop.information, true});
    if (!optimise() || graph_.residual2(graph_.edges().back()) > believable_chi2) {
        graph_ = before;
        statistics_.contradicted++;
        return false;
    }
    statistics_.loops++;
    return true;
}

} // namespace ale
