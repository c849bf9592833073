// How well a graph knows one pose relative to another: the covariance along the most certain path, an upper
// bound of the covariance of the whole graph.
//
// Source: Dijkstra projection, Bosse et al., "An Atlas framework for scalable mapping", ICRA 2003.
#ifndef ALE_GRAPH_OPTIMISE_PATH_COVARIANCE_H
#define ALE_GRAPH_OPTIMISE_PATH_COVARIANCE_H

#include <vector>

#include "graph/optimise/pose_graph.h"

namespace ale
{

// Standard deviations of a relative pose: of the position in its worst direction, and of the heading.
struct Deviation {
    double position_m;
    double heading_rad;
};

class PathCovariance
{
  public:
    // Copies what it needs of the graph. Edges that the robust kernel has all but switched off, and
    // guesses, are left out.
    // O(edges); may throw std::bad_alloc.
    explicit PathCovariance(const PoseGraph &graph);

    // Of every pose relative to pose k; 1000 m and 1000 rad where no path leads. O(e log e); may throw
    // std::bad_alloc.
    std::vector<Deviation> from(int k) const;

  private:
    struct Step {
        int to;
        Eigen::Matrix3d jacobian;   // of the error at its end by that at its beginning
        Eigen::Matrix3d covariance; // that it adds, at its end
    };
    std::vector<std::vector<Step>> steps_; // by the pose that they leave
};

} // namespace ale

#endif
