// From a keyframe of the core to a node of the graph: the boundary at which floating point begins.
#ifndef ALE_GRAPH_OPTIMISE_SCAN_NODE_H
#define ALE_GRAPH_OPTIMISE_SCAN_NODE_H

#include "graph/optimise/node.h"

extern "C" {
#include "observe/seen.h"
#include "track/keyframe.h"
}

namespace ale
{

// Points at least this far apart are kept: enough for matching, and bounded by what a scan can show.
constexpr double node_point_spacing_m = 0.04;

// Points of a line lie on it and carry its normal; other points the normal of their neighbourhood, if it has
// one. path_m is left 0, `tracked` is the pose in the keyframe.
Node node_of(const ale_keyframe_t &keyframe);

// Its lines, robot's frame.
std::vector<WallSight> walls_of(const ale_features_t &features, const Pose &sensor);

// The same points of any scan, those alone that have a normal; robot's frame.
std::vector<SurfacePoint> surface_of(const ale_seen_t &seen, const ale_features_t &features);

} // namespace ale

#endif
