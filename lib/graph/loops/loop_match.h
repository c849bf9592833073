// Matches a node with a submap: hypotheses from corners (section IV of the ALE paper) and from a window
// around the guess (correlative scan matching, Olson, ICRA 2009), scored on a likelihood field. The best are
// refined point to line and compared with the best other place. Metres and radians.
//
// Work of match_submap: 2,000 hypotheses and those of the window, 0.1 m and 0.035 rad apart (35,000 in one of
// 2 m and 0.35 rad, 1.3 million in one of 10 m and 0.5 rad), with 63 points each, 600 with some 240, 84
// least-squares passes. Memory: 16 bytes a hypothesis.
// Every function may throw std::bad_alloc.
#ifndef ALE_GRAPH_LOOPS_LOOP_MATCH_H
#define ALE_GRAPH_LOOPS_LOOP_MATCH_H

#include <vector>

#include "graph/fields/likelihood_field.h"
#include "graph/optimise/node.h"

namespace ale
{

// Error of a point along its normal, one sigma; points count as independent in the information of a match.
constexpr double match_sigma_m = 0.01;

// Largest error of the guess.
struct SearchWindow {
    double half_m;
    double half_rad;
};

struct LoopMatch {
    bool found;
    Pose pose;                   // of the node in the submap
    Eigen::Matrix3d information; // of that pose, in the node's own frame
    double overlap;              // part of the node's points that lie on surfaces of the submap, 0..1
    double ambiguity;            // score of the best other place over that of this one, 0..1
    double rms_m;                // of the inliers along the normal
};

// Searches the whole window. Points and corners of the node in its frame, those of the field in the submap's.
LoopMatch match_submap(const std::vector<SurfacePoint> &scan, const std::vector<CornerFeature> &corners,
                       const LikelihoodField &field, const std::vector<CornerFeature> &field_corners,
                       const Pose &guess, const SearchWindow &window);

// Refines the guess alone, 12 passes; ambiguity is 0.
LoopMatch match_locally(const std::vector<SurfacePoint> &scan, const LikelihoodField &field,
                        const Pose &guess);

// The same for a guess good to centimetres, 8 passes: pairs only points with normals that face alike.
LoopMatch match_closely(const std::vector<SurfacePoint> &scan, const LikelihoodField &field,
                        const Pose &guess);

// Some `count` of the points, evenly chosen.
std::vector<SurfacePoint> thinned(const std::vector<SurfacePoint> &points, size_t count);

// Mean likelihood of the points, seen from this pose.
double score_of(const Pose &pose, const std::vector<SurfacePoint> &points, const LikelihoodField &field);

// Indices of the `count` best scores, best first; of equals the first.
std::vector<size_t> best_of(const std::vector<double> &scores, size_t count);

// Whether two poses are different places: 0.4 m or 0.26 rad apart.
bool are_distinct(const Pose &a, const Pose &b);

} // namespace ale

#endif
