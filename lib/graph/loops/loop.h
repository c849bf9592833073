// A loop: a node matched with a place that an earlier node saw. Bounds that the search while driving and the
// search after the drive share.
#ifndef ALE_GRAPH_LOOPS_LOOP_H
#define ALE_GRAPH_LOOPS_LOOP_H

#include <vector>

#include "graph/loops/loop_match.h"
#include "graph/optimise/constraints.h"

namespace ale
{

constexpr double loop_min_path_m = 6.0; // nearer than this along the path it is the same visit
constexpr double clear_overlap = 0.55;  // few other loops must confirm it
constexpr double least_overlap = 0.30;  // much is out of sight: more loops must confirm it
constexpr double most_ambiguity = 0.85;

struct Loop {
    int from;
    int to;
    Pose measured; // `to` as seen from `from`
    Eigen::Matrix3d information;
    double overlap; // 0..1
};

// The loop of a match between two nodes. The information of a match treats points as independent; here it is
// bounded by the accuracy of a match, 10 mm and 3 mrad. O(1).
Loop loop_from_match(const LoopMatch &match, int from, int to);

// The loop as a robust edge of the graph.
GraphEdge edge_of(const Loop &loop);

// The same of a loop that ties two maps.
GraphEdge joining_edge_of(const Loop &loop);

// Whether a match lies so near to the tracked pose that the tracker has recognised the place, more accurately
// than the match. O(1).
bool is_near(const Pose &tracked, const Pose &matched);

// Whether overlap and ambiguity suffice. in_view: part of the points that could be seen from the place, 0..1.
bool is_acceptable(const LoopMatch &match, double in_view = 1);

// Pairwise consistency: the cycle through two loops from different nodes closes within 0.15 m and 0.035 rad.
// O(1).
bool are_consistent(const Loop &a, const Loop &b, const std::vector<Pose> &poses);

} // namespace ale

#endif
