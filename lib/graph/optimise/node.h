// A node of the graph: what the mapper keeps of a keyframe. Robot's frame, metres and radians.
#ifndef ALE_GRAPH_OPTIMISE_NODE_H
#define ALE_GRAPH_OPTIMISE_NODE_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "graph/optimise/constraints.h"
#include "graph/optimise/se2.h"

namespace ale
{

// A point of a surface and its unit normal, towards the sensor. Zero normal: the direction is unknown.
struct SurfacePoint {
    Eigen::Vector2d p;
    Eigen::Vector2d normal;
};

// Quadrant of a normal, 0..3: opposite sides of a thin panel differ, so that grids keep them apart.
constexpr size_t quadrants = 4;
inline size_t quadrant_of(const Eigen::Vector2d &normal)
{
    return (normal.x() > 0 ? 1U : 0U) + (normal.y() > 0 ? 2U : 0U);
}

struct CornerFeature {
    Eigen::Vector2d p;
    double bisector_rad; // direction into the room
    double angle_rad;    // between the walls
    bool convex;
};

// Direction and length of an extracted line; the direction is known modulo half turns.
struct WallDirection {
    double direction_rad;
    double length_m;
};

struct Node {
    uint32_t scan;
    Pose smooth;   // as the keyframe had it
    Pose tracked;  // map pose of the tracker, with the corrections handed out so far
    double path_m; // driven since the start
    bool broken;   // the smooth pose does not tie it to the node before
    bool weak;     // part of its pose was extrapolated from wheels or velocity
    std::vector<WallDirection> walls;
    std::vector<SurfacePoint> points;
    // By point: its normal comes from beams far apart, precise enough only for matches near the truth.
    std::vector<bool> coarse_normal;
    std::vector<CornerFeature> corners;
    Eigen::Vector2d sensor{0, 0}; // where it sits
    // Walls of the scans after this keyframe, turned into its frame: for the refinement after the drive.
    std::vector<WallDirection> later_walls{};
    int later_scans = 0;       // how many scans these come from
    uint32_t map_id = 0;       // that its pose is in: after all joins so far
    Guess guess = Guess::near; // of the way to the first node of that map, from the one before
    int64_t stamp_us = 0;
};

} // namespace ale

#endif
