// The edge between a node and the one before it along the path.
#ifndef ALE_GRAPH_LOOPS_ODOMETRY_H
#define ALE_GRAPH_LOOPS_ODOMETRY_H

#include "graph/optimise/constraints.h"
#include "graph/optimise/node.h"

namespace ale
{

// Edge from node k - 1, `before`, to node k, `here`. motion: `here` as seen from `before`, as tracked.
// Between two maps the motion is a guess. O(1).
GraphEdge odometry_edge(int k, const Node &before, const Node &here, const Pose &motion);

} // namespace ale

#endif
