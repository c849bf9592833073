// Neighbours along the path, matched pairwise: independent of drift, they show whether the building is bent.
#ifndef ALE_GRAPH_LOOPS_NEIGHBOUR_MATCHES_H
#define ALE_GRAPH_LOOPS_NEIGHBOUR_MATCHES_H

#include <vector>

#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

class NeighbourMatches
{
  public:
    // Touches the memory for so many nodes, so that add() allocates no more.
    void reserve(size_t nodes);
    void clear()
    {
        pairs_.clear();
    }

    // Matches the last node with the two before it, if these are of its map. Two pairwise matches; may throw
    // std::bad_alloc.
    void add(const std::vector<Node> &nodes, const PoseGraph &graph);

    // Node k is no more: its matches go, later nodes move down by one. O(pairs).
    void remove_node(int k);

    // Whether the matches of this map fit the graph, solved with the building constraint, so badly that the
    // building must be bent. O(pairs).
    bool contradict_building(const std::vector<Node> &nodes, const PoseGraph &graph, uint32_t map_id) const;

  private:
    struct Pair {
        GraphEdge match;
        double misfit; // of the poses as tracked
    };
    std::vector<Pair> pairs_; // along the path
};

} // namespace ale

#endif
