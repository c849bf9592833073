// Where views that overlap lie to each other, as well as scans can tell, when they lie nearly right already.
#ifndef ALE_GRAPH_LOOPS_TIGHT_MATCH_H
#define ALE_GRAPH_LOOPS_TIGHT_MATCH_H

#include <optional>
#include <vector>

#include "graph/loops/surface_field.h"
#include "graph/optimise/node.h"

namespace ale
{

struct TightMatch {
    Pose pose;                   // in the frame of the field
    Eigen::Matrix3d information; // of that pose, in its own frame; little along a bare corridor
};

// None: too few of the points lie on the field, or they would have to be moved by 0.25 m or 0.1 rad.
std::optional<TightMatch> match_to(const SurfaceField &field, const std::vector<SurfacePoint> &points,
                                   const Pose &guess);

} // namespace ale

#endif
