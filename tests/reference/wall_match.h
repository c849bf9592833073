// Twin of lib/match/association.c and hypothesis.c: which wall of the map a line shows, and where the robot
// could be.
#ifndef ALE_TESTS_REFERENCE_WALL_MATCH_H
#define ALE_TESTS_REFERENCE_WALL_MATCH_H

#include <vector>

#include <Eigen/Dense>

#include "reference/decisions.h"
#include "reference/planar_motion.h"

namespace reference
{

// A piece of a straight wall, in the map's frame or (what a scan shows) in the robot's; metres and radians.
// It extends along the tangent, a quarter turn clockwise from the normal, from `start` to `end` about its
// centre.
struct WallPiece {
    Eigen::Vector2d centre;
    double normal;
    double start;
    double end;
    double var_offset; // at the centre, along the normal
    double var_angle;
    double cov_offset_angle; // of walls of the map
};

struct WallGate {
    double offset;
    double angle;
    double sigmas;
};

// The wall with the least squared distance in sigmas, of those that overlap the line and lie within the gate;
// -1: none. cov: of the pose, x, y, heading in the robot's own frame.
int wall_shown(const std::vector<WallPiece> &map, const WallPiece &line, const Pose &pose,
               const Eigen::Matrix3d &cov, const WallGate &gate, Decisions &decisions);

// The pose from which two lines lie on two walls: the heading in the mean of both, then both offsets zero.
Pose pose_of_pair(const WallPiece &a, const WallPiece &b, const WallPiece &wall_a, const WallPiece &wall_b);

// Length of the lines that lie on walls of the map when the robot is at a pose.
double length_on_walls(const std::vector<WallPiece> &map, const std::vector<WallPiece> &lines,
                       const Pose &pose, Decisions &decisions);

} // namespace reference

#endif
