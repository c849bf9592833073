// From a keyframe of the integer core to a node of the graph: here floating point begins.
//
// Every function may throw std::bad_alloc; time is linear in the beams of the scan.
#ifndef ALE_GRAPH_OPTIMISE_SCAN_NODE_H
#define ALE_GRAPH_OPTIMISE_SCAN_NODE_H

#include "graph/optimise/node.h"

extern "C" {
#include "observe/seen.h"
#include "track/keyframe.h"
}

namespace ale
{

// Points lie at least this far apart: enough for matching, and bounded by what a scan can show.
constexpr double node_point_spacing_m = 0.04;

// The node of a keyframe. Points of a line lie on it and carry its normal; other points carry the normal of
// their neighbouring beams, or none. path_m is left 0; `tracked` is the keyframe's map pose.
Node node_of(const ale_keyframe_t &keyframe);

// Directions of the extracted lines, robot's frame; `sensor` is the sensor's pose on the robot.
std::vector<WallDirection> walls_of(const ale_features_t &features, const Pose &sensor);

constexpr int most_later_scans = 16; // of a node, whose walls it keeps

// Adds the walls of a scan after the node, robot's frame; `smooth` as the node's own. Scans beyond
// most_later_scans are ignored. O(walls).
void add_later_walls(const Pose &smooth, const std::vector<WallDirection> &walls, Node *node);

// The points of any scan that have a normal, robot's frame.
std::vector<SurfacePoint> surface_of(const ale_seen_t &seen, const ale_features_t &features);

} // namespace ale

#endif
