#include "graph/loops/neighbour_matches.h"

#include <algorithm>

#include "graph/fields/likelihood_field.h"
#include "graph/loops/pairwise_match.h"
#include "graph/walls/building_direction.h"

namespace ale
{

namespace
{

constexpr int nodes_back = 2;

} // namespace

void NeighbourMatches::reserve(size_t nodes)
{
    pairs_.resize(nodes * nodes_back); // touched
    pairs_.clear();
}

void NeighbourMatches::add(const std::vector<Node> &nodes, const PoseGraph &graph)
{
    const int here = static_cast<int>(nodes.size()) - 1;
    const LikelihoodField field(nodes.back().points);
    for (int there = std::max(0, here - nodes_back); there < here; there++) {
        if (at(nodes, there).map_id != nodes.back().map_id) {
            continue;
        }
        const Pose guess = between(graph.poses(), here, there);
        if (const auto match = match_pair(field, at(nodes, there).points, guess)) {
            const GraphEdge edge{here, there, match->pose, match->information, true};
            pairs_.push_back({edge, graph.misfit(edge)});
        }
    }
}

void NeighbourMatches::remove_node(int k)
{
    const auto ends_there = [k](const Pair &pair) { return pair.match.from == k || pair.match.to == k; };
    pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), ends_there), pairs_.end());
    for (Pair &pair : pairs_) {
        pair.match.from -= pair.match.from > k ? 1 : 0;
        pair.match.to -= pair.match.to > k ? 1 : 0;
    }
}

bool NeighbourMatches::contradict_building(const std::vector<Node> &nodes, const PoseGraph &graph,
                                           uint32_t map_id) const
{
    double misfit = 0;
    double tracked = 0;
    size_t count = 0;
    for (const Pair &pair : pairs_) {
        if (at(nodes, pair.match.from).map_id == map_id) {
            misfit += graph.misfit(pair.match);
            tracked += pair.misfit;
            count++;
        }
    }
    const bool drifted = true; // else nobody would ask
    return matches_contradict(misfit, tracked, count, drifted);
}

} // namespace ale
