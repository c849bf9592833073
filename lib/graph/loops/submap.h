// Submap: what the nodes around a place saw, in the frame of the node of that place. Metres. Every function
// may throw std::bad_alloc.
#ifndef ALE_GRAPH_LOOPS_SUBMAP_H
#define ALE_GRAPH_LOOPS_SUBMAP_H

#include <vector>

#include "graph/optimise/node.h"

namespace ale
{

// How many nodes before and after the place, along the path.
struct SubmapExtent {
    int before;
    int after;
};

// The nodes of the submap of node k, ascending; those more than four metres away, or of another map, are left
// out. O(extent).
std::vector<int> nodes_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                              const SubmapExtent &extent);

// Their points; coarse normals count as unknown. O(points).
std::vector<SurfacePoint> submap_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                        const SubmapExtent &extent);
// Corners of all nodes of the extent in this map, however far. O(corners).
std::vector<CornerFeature> corners_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                          int k, const SubmapExtent &extent);

} // namespace ale

#endif
