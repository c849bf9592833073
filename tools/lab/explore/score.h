/* What an exploration was worth, from the plan of the world alone: nothing of the robot's code is used.
 *
 * The reachable area is what a disc of the robot's width sweeps when its centre goes wherever the disc
 * touches no wall, from the start: flood fill in steps of 2.5 cm. A place counts as mapped when the robot's
 * grid says free or occupied there, and as wrong when it says occupied more than 10 cm from every wall. */
#ifndef ALE_LAB_EXPLORE_SCORE_H
#define ALE_LAB_EXPLORE_SCORE_H

#include <functional>

#include "lab/sim/world/world.h"

namespace explore
{

struct Score {
    double reachable_m2 = 0;
    double mapped = 0; /* part of the reachable area, 0..1 */
    double wrong = 0;
};

enum class Place { unseen, free, occupied };

/* `asked`: what the robot says of a place, in the frame of its start. */
Score score(const sim::World &world, double robot_width, const std::function<Place(sim::Point)> &asked);

} // namespace explore

#endif
