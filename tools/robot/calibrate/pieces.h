/* The drive cut into pieces of way, each a comparison of what the wheels counted with what the scans saw.
 *
 * Between two samples of the wheels the robot's centre moves, in the frame halfway between the two headings,
 * by R(theta) m - 2 sin(turn / 2) J (x, y)        J = [0 -1; 1 0] where m is the motion of the laser in its
 * own halfway frame, (x, y, theta) its mounting. These are summed over a piece, so that the noise of matching
 * counts once a piece, and the headings in which wheels err at random do not turn the way that they counted.
 */
#ifndef ALE_ROBOT_CALIBRATE_PIECES_H
#define ALE_ROBOT_CALIBRATE_PIECES_H

#include <Eigen/Core>
#include <vector>

#include "robot/calibrate/drive.h"

namespace mounting
{

/* Wheel samples first..last, both included. */
struct Piece {
    size_t first;
    size_t last;
    Eigen::Vector2d counted_way; /* forward, left: sums in halfway frames, metres */
    double counted_turn;         /* radians */
};

/* Of the laser over a piece. */
struct Seen {
    Eigen::Vector2d way; /* in the laser's halfway frames */
    double lever;        /* sum of 2 sin(turn / 2) */
    double turn;
};

/* Every place of the way is in so many pieces: each begins when a further part of the last one is behind. */
constexpr int overlap = 4;

/* Pieces of 1.5 metres and radians of way together; standing still, and counters that jump, are left out. */
std::vector<Piece> cut(const Drive &drive);

/* The same way as the scans saw it, when a sample stamped t was taken at t + lag. Nothing where the scans do
 * not say. */
std::optional<Seen> seen(const Drive &drive, const Piece &piece, double lag);

} // namespace mounting

#endif
