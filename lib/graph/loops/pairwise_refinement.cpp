#include "graph/loops/pairwise_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/fields/likelihood_field.h"
#include "graph/loops/map_table.h"
#include "graph/loops/pairwise_match.h"
#include "graph/loops/place_candidates.h"
#include "graph/walls/building_direction.h"

namespace ale
{

namespace
{

constexpr int rounds = 2; // the second finds neighbours that the first has brought together
constexpr int nodes_per_step = 8;
constexpr int solves_per_round = 10;
constexpr int nodes_along = 2; // the next along the path
constexpr size_t max_other_visits = 6;
constexpr int same_visit_nodes = 3;
constexpr double reach_m = 3.0;
constexpr double metres_a_radian = 1.0; // a rotation reduces the overlap of two views as this displacement

} // namespace

PairwiseRefinement::PairwiseRefinement(const std::vector<Node> *nodes, PoseGraph graph, const PriorMap *prior)
    : nodes_(nodes), prior_(prior), graph_(std::move(graph)), given_(graph_.edges()),
      drifted_(!graph_.building_constraint().priors.empty()), building_map_(largest_map(*nodes))
{
}

bool PairwiseRefinement::step()
{
    const int count = static_cast<int>(nodes_->size());
    if (round_ == rounds) {
        return false;
    }
    if (next_ < count) {
        const int last = std::min(count, next_ + nodes_per_step);
        for (; next_ < last; next_++) {
            match_neighbours(next_);
            if (prior_ && at(*nodes_, next_).map_id == ALE_FIRST_MAP) {
                match_prior_map(next_);
            }
        }
        return true;
    }
    solve();
    if (is_solved()) {
        select_solution();
        matched_.clear();
        pose_priors_.clear();
        next_ = 0;
        solved_ = 0;
        round_++;
    }
    return true;
}

// Later nodes that may see the same: the next few along the path, and the nearest of each other visit.
std::vector<int> PairwiseRefinement::neighbours_of(int k) const
{
    const int count = static_cast<int>(nodes_->size());
    std::vector<PlaceCandidate> places;
    for (int there = k + nodes_along + 1; there < count; there++) {
        const Pose off = between(graph_.poses(), k, there);
        const double distance = length(off.x, off.y) + metres_a_radian * std::abs(off.theta);
        if (distance < reach_m && at(*nodes_, there).map_id == at(*nodes_, k).map_id) {
            places.push_back({there, distance});
        }
    }
    std::vector<int> chosen = nearest_of_each_visit(std::move(places), same_visit_nodes, max_other_visits);
    for (int there = k + 1; there < std::min(count, k + 1 + nodes_along); there++) {
        if (at(*nodes_, there).map_id == at(*nodes_, k).map_id) {
            chosen.push_back(there);
        }
    }
    return chosen;
}

void PairwiseRefinement::match_neighbours(int k)
{
    const LikelihoodField field(at(*nodes_, k).points);
    for (const int there : neighbours_of(k)) {
        const Pose guess = between(graph_.poses(), k, there);
        if (const auto match = match_pair(field, at(*nodes_, there).points, guess)) {
            matched_.push_back({k, there, match->pose, match->information, true});
        }
    }
}

void PairwiseRefinement::match_prior_map(int k)
{
    if (const auto match = prior_->find(at(*nodes_, k).points, at(graph_.poses(), k))) {
        pose_priors_.push_back({k, match->pose, match->information});
    }
}

// Of the given edges all odometry, and the loops that no match between the same places replaces. A place that
// the tracker has recognised, but no match confirms, is dropped in the last round.
std::vector<GraphEdge> PairwiseRefinement::edges_to_keep() const
{
    std::vector<std::vector<int>> matched_with(nodes_->size());
    for (const GraphEdge &edge : matched_) {
        matched_with[static_cast<size_t>(edge.to)].push_back(edge.from);
    }
    const auto is_replaced = [&](const GraphEdge &loop) {
        const int last = std::min(static_cast<int>(nodes_->size()) - 1, loop.to + same_visit_nodes);
        for (int k = std::max(0, loop.to - same_visit_nodes); k <= last; k++) {
            for (const int there : at(matched_with, k)) {
                if (std::abs(there - loop.from) <= same_visit_nodes) {
                    return true;
                }
            }
        }
        return false;
    };
    std::vector<GraphEdge> kept;
    for (const GraphEdge &edge : given_) {
        const bool unconfirmed = edge.recognised && round_ > 0;
        if (!edge.robust || (!unconfirmed && !is_replaced(edge))) {
            kept.push_back(edge);
        }
    }
    return kept;
}

// Also without visible heading drift: select_solution() decides by the matches.
void PairwiseRefinement::update_building_constraint()
{
    const BuildingConstraint building =
        building_constraint_from_walls(*nodes_, graph_.poses(), {WallSource::all_scans, building_map_});
    drifted_ = drifted_ || has_heading_drift(building, graph_.poses());
    graph_.set_building_constraint(building);
}

void PairwiseRefinement::solve()
{
    if (solved_ == 0) {
        update_building_constraint();
        graph_.set_edges(edges_to_keep());
        for (const GraphEdge &edge : matched_) {
            graph_.add_edge(edge);
        }
        graph_.set_pose_priors(pose_priors_);
    }
    if (solved_ == solves_per_round) {
        constrained_ = graph_;
        graph_.set_building_constraint({});
    }
    graph_.optimise(1);
    solved_++;
}

// With a building constraint the graph is solved without it, too.
bool PairwiseRefinement::is_solved() const
{
    return solved_ == 2 * solves_per_round ||
           (solved_ == solves_per_round && graph_.building_constraint().priors.empty());
}

// Keeps the building constraint unless the matches contradict it.
void PairwiseRefinement::select_solution()
{
    if (!constrained_) {
        return;
    }
    const auto misfit = [this](const PoseGraph &graph) {
        double sum = 0;
        for (const GraphEdge &edge : matched_) {
            sum += graph.misfit(edge);
        }
        return sum;
    };
    if (!matches_contradict(misfit(*constrained_), misfit(graph_), matched_.size(), drifted_)) {
        graph_ = std::move(*constrained_);
    }
    constrained_.reset();
}

} // namespace ale
