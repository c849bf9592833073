// Where a node lies in a patch of the map: hypotheses from corners and from a window around the guess,
// scored by overlap, the best refined by least squares, and judged against the runner-up.
//
// Work: a look-up for each of at most 22,000 hypotheses and 63 points, 150,000 more to score the best, and 84
// passes over the points.
#ifndef ALE_GRAPH_LOOPS_LOOP_MATCH_H
#define ALE_GRAPH_LOOPS_LOOP_MATCH_H

#include <vector>

#include "graph/loops/surface_field.h"
#include "graph/optimise/node.h"

namespace ale
{

// The information of a match takes every point to be known to this along its normal, and on its own.
constexpr double match_sigma_m = 0.01;

struct SearchWindow {
    double half_m; // how far the guess may be off
    double half_rad;
};

struct LoopMatch {
    bool found;
    Pose pose;                   // of the node in the patch
    Eigen::Matrix3d information; // of that pose, in the node's own frame
    double overlap;              // share of the node's points that lie on the patch's surfaces, 0..1
    double ambiguity;            // score of the best other place over that of this one, 0..1
    double rms_m;                // of the inliers along the normal
};

LoopMatch match_patch(const std::vector<SurfacePoint> &scan, const std::vector<CornerMark> &corners,
                      const SurfaceField &field, const std::vector<CornerMark> &field_corners,
                      const Pose &guess, const SearchWindow &window);

// Refines the guess alone: for a place that the tracker seems to know. ambiguity is 0.
LoopMatch match_near(const std::vector<SurfacePoint> &scan, const SurfaceField &field, const Pose &guess);

// The same for two scans that lie a few centimetres off: pairs only what faces the same way.
LoopMatch match_tightly(const std::vector<SurfacePoint> &scan, const SurfaceField &field, const Pose &guess);

} // namespace ale

#endif
