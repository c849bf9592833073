// What the mapper keeps of a keyframe. Robot's frame, metres.
#ifndef ALE_GRAPH_OPTIMISE_NODE_H
#define ALE_GRAPH_OPTIMISE_NODE_H

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "graph/optimise/se2.h"

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

// A line as the robot sees it; the direction but for half turns.
struct WallSight {
    double direction;
    double length_m;
};

struct Node {
    uint32_t scan;
    Pose smooth;   // as it was handed in
    Pose tracked;  // as the tracker places it, with the corrections that it was handed
    double path_m; // driven since the start
    bool broken;   // smooth does not tie it to the node before
    bool weak;     // part of its pose was guessed from wheels or velocity
    std::vector<WallSight> walls;
    std::vector<SurfacePoint> points;
    // By point: its normal is told by beams far apart, good enough only where the place is known already.
    std::vector<bool> vague;
    std::vector<CornerMark> corners;
    Eigen::Vector2d eye{0, 0}; // where the sensor sits
    // Walls of the scans after it, as if seen from here: for what is done when the drive is over.
    std::vector<WallSight> walls_after{};
    int scans_after = 0; // that these are of
};

} // namespace ale

#endif
