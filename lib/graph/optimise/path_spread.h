// How surely a graph knows one pose as seen from the others: the covariance along the surest path, an upper
// bound of what all paths together would give.
#ifndef ALE_GRAPH_OPTIMISE_PATH_SPREAD_H
#define ALE_GRAPH_OPTIMISE_PATH_SPREAD_H

#include <vector>

#include "graph/optimise/pose_graph.h"

namespace ale
{

// Standard deviations of the relative pose: in the worst direction, and of the heading.
struct Spread {
    double metres;
    double radians;
};

class PathSpread
{
  public:
    // Edges that the robust kernel has all but switched off lead nowhere. Later changes of the graph are not
    // seen; the graph itself is not needed any more.
    explicit PathSpread(const PoseGraph &graph);

    // Of every pose as seen from pose k; poses that no path leads to are known to 1000 m. O(e log e).
    std::vector<Spread> from(int k) const;

  private:
    struct Way {
        int to;
        Eigen::Matrix3d carry;      // what an error at its beginning is at its end
        Eigen::Matrix3d covariance; // that it adds, at its end
    };
    std::vector<std::vector<Way>> ways_; // by the pose that they leave
};

} // namespace ale

#endif
