// The relative pose of two overlapping views, as accurately as scans allow, from a guess good to centimetres.
#ifndef ALE_GRAPH_LOOPS_PAIRWISE_MATCH_H
#define ALE_GRAPH_LOOPS_PAIRWISE_MATCH_H

#include <optional>
#include <vector>

#include "graph/fields/likelihood_field.h"
#include "graph/optimise/node.h"

namespace ale
{

struct PairwiseMatch {
    Pose pose;                   // in the frame of the field
    Eigen::Matrix3d information; // of that pose, in its own frame; small along a bare corridor
};

// Matches points, in the frame of their view, with a field. None: fewer than a quarter of them or 25 fit, or
// the match is 0.25 m or 0.1 rad off the guess. Eight passes over the points; may throw std::bad_alloc.
std::optional<PairwiseMatch> match_pair(const LikelihoodField &field, const std::vector<SurfacePoint> &points,
                                        const Pose &guess);

} // namespace ale

#endif
