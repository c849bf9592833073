// Places near another one, told apart by visits: nodes that follow each other along the way saw the same, and
// of them one is enough.
#ifndef ALE_GRAPH_LOOPS_VISITS_H
#define ALE_GRAPH_LOOPS_VISITS_H

#include <cstddef>
#include <vector>

namespace ale
{

struct NearPlace {
    int k; // node
    double distance;
};

// The nearest of each visit, nearest first, `most` at most. Nodes no more than same_visit_nodes from one that
// is taken are of its visit. Of places as far away, those given first. O(n (log n + most)).
std::vector<int> nearest_of_each_visit(std::vector<NearPlace> places, int same_visit_nodes, size_t most);

} // namespace ale

#endif
