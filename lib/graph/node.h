// What the mapper keeps of a keyframe. Robot's frame, metres.
#ifndef ALE_GRAPH_NODE_H
#define ALE_GRAPH_NODE_H

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "graph/se2.h"

namespace ale
{

// A point of a surface; the normal points towards the sensor. Zero: direction of the surface unknown.
struct SurfacePoint {
    Eigen::Vector2d p;
    Eigen::Vector2d normal;
};

struct CornerMark {
    Eigen::Vector2d p;
    double bisector; // direction into the room
    double angle;    // between the walls
    bool convex;
};

struct Node {
    uint32_t scan;
    Pose smooth;   // as it was handed in
    double path_m; // driven since the start
    bool broken;   // smooth does not tie it to the node before
    bool weak;     // part of its pose was guessed from wheels or velocity
    double axes_cos_m =
        0; // of its lines: unit vectors of four times their direction, weighted by length, added up
    double axes_sin_m = 0;
    double straight_m = 0; // length of its lines
    std::vector<SurfacePoint> points;
    std::vector<CornerMark> corners;
};

} // namespace ale

#endif
