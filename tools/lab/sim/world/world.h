/* World files: a plan of walls, where the robot starts, and the way it drives.
 *
 *   x1 y1 x2 y2           a wall, metres
 *   # start x y theta     the robot's first pose, metres and radians (default 0 0 0)
 *   # via x y             the next point of its way; no via: it stands still
 *   # sensor x y theta    mounting of the laser on the robot (default 0 0 0)
 *   # walker SPEED REST x1 y1 x2 y2 ..  somebody who walks that way and back (m/s), and rests (s) at its ends
 *
 * Every other line that begins with # is a comment. */
#ifndef ALE_LAB_SIM_WORLD_H
#define ALE_LAB_SIM_WORLD_H

#include <istream>
#include <string>
#include <vector>

#include "lab/sim/geometry.h"
#include "lab/sim/world/walker.h"

namespace sim
{

struct World {
    std::vector<Wall> walls;
    Pose start;
    Pose sensor;
    std::vector<Point> via;
    std::vector<Walker> walkers;
};

/* Throws std::runtime_error whose text names file, line and what is wrong. */
World load_world(const std::string &path);

/* The same from a stream; `name` stands for the file in messages. */
World parse_world(std::istream &in, const std::string &name);

} // namespace sim

#endif
