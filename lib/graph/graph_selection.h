// Which keyframes and loops of a graph are told when not all fit (mapper_graph.h).
#ifndef ALE_GRAPH_GRAPH_SELECTION_H
#define ALE_GRAPH_GRAPH_SELECTION_H

#include <vector>

#include "graph/optimise/constraints.h"
#include "graph/optimise/node.h"

extern "C" {
#include "graph/mapper_graph.h"
}

namespace ale
{

// Fills all of *out but its epoch. Of loops those that join maps come first, then those that were closed,
// then recognised ones; of each kind the latest. Both ends of each are told: where keyframes do not all fit,
// such ends take half of the list at most. The first and the last keyframe are told, and of the others as
// many as fit, evenly along the path. O(keyframes + loops log loops); may throw std::bad_alloc.
void select_graph(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                  const std::vector<GraphEdge> &edges, ale_mapper_graph_t *out);

} // namespace ale

#endif
