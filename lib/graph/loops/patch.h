// A piece of the map as the nodes around a place saw it, in the frame of that place.
#ifndef ALE_GRAPH_LOOPS_PATCH_H
#define ALE_GRAPH_LOOPS_PATCH_H

#include <vector>

#include "graph/optimise/node.h"

namespace ale
{

// Which nodes along the way see a place.
struct PatchExtent {
    int before;
    int after;
};

// The nodes that see the place of k: those around it along the way, none farther from it than four metres.
std::vector<int> viewers_of(const std::vector<Pose> &poses, int k, const PatchExtent &extent);

// What these saw; vague normals count as unknown.
std::vector<SurfacePoint> patch_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                       const PatchExtent &extent);
std::vector<CornerMark> corners_around(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int k,
                                       const PatchExtent &extent);

} // namespace ale

#endif
