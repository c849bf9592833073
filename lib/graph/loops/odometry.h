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

// How fast the robot has been seen to drive: so far it can have got while nobody watched.
class Pace
{
  public:
    // What it drove between two nodes of one map. O(1).
    void add(const Node &before, const Node &here, const Pose &motion);
    // How far apart these two nodes may be; endless_m where no speed or no time is known. O(1).
    double reach_m(const Node &before, const Node &here) const;

    static constexpr double endless_m = 1e6;

  private:
    double fastest_m_s_ = 0;
};

} // namespace ale

#endif
