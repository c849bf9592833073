#include "graph/loops/refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/loops/surface_field.h"
#include "graph/loops/tight_match.h"
#include "graph/loops/visits.h"
#include "graph/walls/building_axes.h"

namespace ale
{

namespace
{

constexpr int rounds = 2; // the second finds neighbours that the first has brought together
constexpr int nodes_per_step = 8;
constexpr int solves_per_round = 10;
constexpr int nodes_along = 2; // the next few along the way
constexpr size_t other_visits = 6;
constexpr int same_visit_nodes = 3;
constexpr double reach_m = 3.0;
constexpr double metres_a_radian = 1.0; // how much less two views share when they look elsewhere

} // namespace

Refinement::Refinement(const std::vector<Node> *nodes, PoseGraph graph, const KnownMap *known)
    : nodes_(nodes), known_(known), graph_(std::move(graph)), given_(graph_.edges()),
      drifted_(!graph_.headings().priors.empty())
{
}

bool Refinement::step()
{
    const int count = static_cast<int>(nodes_->size());
    if (round_ == rounds) {
        return false;
    }
    if (next_ < count) {
        const int last = std::min(count, next_ + nodes_per_step);
        for (; next_ < last; next_++) {
            match_around(next_);
            if (known_) {
                match_known(next_);
            }
        }
        return true;
    }
    solve();
    if (is_solved()) {
        choose();
        matched_.clear();
        anchors_.clear();
        next_ = 0;
        solved_ = 0;
        round_++;
    }
    return true;
}

// Later nodes that may see the same: the next few along the way, and the nearest of each other visit.
std::vector<int> Refinement::neighbours_of(int k) const
{
    const int count = static_cast<int>(nodes_->size());
    std::vector<NearPlace> places;
    for (int there = k + nodes_along + 1; there < count; there++) {
        const Pose off =
            between(graph_.poses()[static_cast<size_t>(k)], graph_.poses()[static_cast<size_t>(there)]);
        const double distance = length(off.x, off.y) + metres_a_radian * std::abs(off.theta);
        if (distance < reach_m) {
            places.push_back({there, distance});
        }
    }
    std::vector<int> chosen = nearest_of_each_visit(std::move(places), same_visit_nodes, other_visits);
    for (int there = k + 1; there < std::min(count, k + 1 + nodes_along); there++) {
        chosen.push_back(there);
    }
    return chosen;
}

void Refinement::match_around(int k)
{
    const SurfaceField field((*nodes_)[static_cast<size_t>(k)].points);
    for (const int there : neighbours_of(k)) {
        const std::vector<SurfacePoint> &points = (*nodes_)[static_cast<size_t>(there)].points;
        const Pose guess =
            between(graph_.poses()[static_cast<size_t>(k)], graph_.poses()[static_cast<size_t>(there)]);
        if (const auto match = match_to(field, points, guess)) {
            matched_.push_back({k, there, match->pose, match->information, true});
        }
    }
}

void Refinement::match_known(int k)
{
    const auto at = static_cast<size_t>(k);
    if (const auto match = known_->find((*nodes_)[at].points, graph_.poses()[at])) {
        anchors_.push_back({k, match->pose, match->information});
    }
}

// What the graph was given: motions all, and of loops those that no match between the same places says
// better. Where the tracker says that it has been before, and no match bears it out, it has no say in the
// end.
std::vector<GraphEdge> Refinement::still_needed() const
{
    std::vector<std::vector<int>> matched_with(nodes_->size());
    for (const GraphEdge &edge : matched_) {
        matched_with[static_cast<size_t>(edge.to)].push_back(edge.from);
    }
    const auto is_said_better = [&](const GraphEdge &loop) {
        const int last = std::min(static_cast<int>(nodes_->size()) - 1, loop.to + same_visit_nodes);
        for (int k = std::max(0, loop.to - same_visit_nodes); k <= last; k++) {
            for (const int there : matched_with[static_cast<size_t>(k)]) {
                if (std::abs(there - loop.from) <= same_visit_nodes) {
                    return true;
                }
            }
        }
        return false;
    };
    std::vector<GraphEdge> needed;
    for (const GraphEdge &edge : given_) {
        const bool doubted = edge.recognised && round_ > 0;
        if (!edge.robust || (!doubted && !is_said_better(edge))) {
            needed.push_back(edge);
        }
    }
    return needed;
}

// Not only where headings have visibly drifted: in the end the matches judge what became of it.
void Refinement::follow_walls()
{
    const BuildingHeadings headings = headings_by_walls(*nodes_, graph_.poses(), Witnesses::all_scans);
    drifted_ = drifted_ || have_drifted(headings, graph_.poses());
    graph_.set_headings(headings);
}

void Refinement::solve()
{
    if (solved_ == 0) {
        follow_walls();
        graph_.set_edges(still_needed());
        for (const GraphEdge &edge : matched_) {
            graph_.add_edge(edge);
        }
        graph_.set_anchors(anchors_);
    }
    if (solved_ == solves_per_round) {
        turned_ = graph_;
        graph_.set_headings({});
    }
    graph_.optimise(1);
    solved_++;
}

// Where walls serve as a compass the graph is solved without them, too.
bool Refinement::is_solved() const
{
    return solved_ == 2 * solves_per_round ||
           (solved_ == solves_per_round && graph_.headings().priors.empty());
}

// The compass stays unless it tears what views show of each other.
void Refinement::choose()
{
    if (!turned_) {
        return;
    }
    const auto misfit = [this](const PoseGraph &graph) {
        double sum = 0;
        for (const GraphEdge &edge : matched_) {
            sum += graph.misfit(edge);
        }
        return sum;
    };
    if (!are_torn(misfit(*turned_), misfit(graph_), matched_.size(), drifted_)) {
        graph_ = std::move(*turned_);
    }
    turned_.reset();
}

} // namespace ale
