/* What a laser beam meets in a plan of walls. */
#ifndef ALE_SIM_RAY_CAST_H
#define ALE_SIM_RAY_CAST_H

#include <vector>

#include "sim/geometry.h"

namespace sim
{

struct Hit {
    double range = 0;         /* metres */
    int wall = -1;            /* index in the world; -1: nothing within reach */
    double cos_incidence = 1; /* 1: the beam meets the wall head on */
};

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
