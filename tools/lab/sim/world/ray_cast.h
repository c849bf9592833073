/* What a laser beam meets in a plan of walls, and of legs. */
#ifndef ALE_LAB_SIM_RAY_CAST_H
#define ALE_LAB_SIM_RAY_CAST_H

#include <vector>

#include "lab/sim/geometry.h"
#include "lab/sim/world/walker.h"

namespace sim
{

struct Hit {
    double range = 0;         /* metres */
    int surface = -1;         /* wall by its index in the world, then walkers; -1: nothing within reach */
    double cos_incidence = 1; /* 1: the beam meets the wall head on */
};

/* The hit, or the nearer one on the circle. */
Hit nearer(const Hit &hit, const Pose &beam, const Circle &circle, int surface);

/* The walls within reach of a place: a scan looks at these only. */
class Surroundings
{
  public:
    Surroundings(const std::vector<Wall> &walls, Point centre, double reach);

    /* First wall that the beam from pose (its heading is the beam's) meets, at most `reach` away.
     * Time grows with the number of walls near. */
    Hit cast(const Pose &beam) const;

  private:
    struct Near {
        Wall wall;
        int index;
    };
    std::vector<Near> near_;
    double reach_;
};

} // namespace sim

#endif
