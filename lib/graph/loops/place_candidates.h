// Chooses among places near a node: nodes in a row along the path saw the same, so one of each visit is
// enough.
#ifndef ALE_GRAPH_LOOPS_PLACE_CANDIDATES_H
#define ALE_GRAPH_LOOPS_PLACE_CANDIDATES_H

#include <cstddef>
#include <vector>

namespace ale
{

struct PlaceCandidate {
    int node;
    double distance; // in any unit
};

// The nearest node of each visit, nearest first, `most` at most. Nodes within same_visit_nodes of a chosen
// one are of its visit. Of equal distances the first given wins. O(n (log n + most)); may throw
// std::bad_alloc.
std::vector<int> nearest_of_each_visit(std::vector<PlaceCandidate> places, int same_visit_nodes, size_t most);

} // namespace ale

#endif
