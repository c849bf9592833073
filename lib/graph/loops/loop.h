// A loop: a node found again at a place that an earlier one saw. What the search while driving and that after
// the drive ask of it alike.
#ifndef ALE_GRAPH_LOOPS_LOOP_H
#define ALE_GRAPH_LOOPS_LOOP_H

#include <vector>

#include "graph/loops/loop_match.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

constexpr double loop_min_path_m = 6.0; // nearer than this along the path it is the same visit
constexpr double clear_overlap = 0.55;  // one node's word, confirmed by another
constexpr double least_overlap = 0.30;  // much is out of sight: more nodes must agree
constexpr double most_ambiguity = 0.85;

struct Loop {
    int from;
    int to;
    Pose measured; // `to` as seen from `from`
    Eigen::Matrix3d information;
    double overlap;
};

// A match between the two places; the matcher's information counts points as independent, which they are not:
// bounded by what a match is worth.
Loop loop_by(const LoopMatch &match, int from, int to);

// Whether the match is worth to be compared with others. in_view: the share of its points, 0..1, that could
// be seen from the place, as far as is known.
bool is_sight(const LoopMatch &match, double in_view = 1);

// Two loops, found from different nodes, that say the same: going round by both gives no displacement.
bool agree(const Loop &a, const Loop &b, const std::vector<Pose> &poses);

} // namespace ale

#endif
