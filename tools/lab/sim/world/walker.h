/* People who walk to and fro in a world: two legs each, as a scanner a hand above the floor sees them. */
#ifndef ALE_LAB_SIM_WALKER_H
#define ALE_LAB_SIM_WALKER_H

#include <array>
#include <vector>

#include "lab/sim/geometry.h"

namespace sim
{

struct Circle {
    Point centre;
    double radius = 0;
};

/* Walks along the path and back, over and over, and rests at both ends. */
struct Walker {
    double speed_m_s = 1;
    double rest_s = 0;
    std::vector<Point> path; /* at least two, apart */
};

/* Shins and trousers. */
constexpr double leg_radius_m = 0.06;

/* Where the legs are at a time of play. One stands while the other swings past it at twice the walker's
 * speed. */
std::array<Circle, 2> legs_of(const Walker &walker, double seconds);

} // namespace sim

#endif
