// Walls of a map for tests: straight, known to 2 mm and 2 mrad.
#pragma once

#include "lib/motion/convert.h"

extern "C" {
#include "map/wall.h"
}

// About (x, y), its normal in a direction, to half a length on either side; seen so many times.
inline ale_wall_t make_wall(double x, double y, double normal, double half, uint32_t seen = 5)
{
    ale_observation_t v = {};
    v.centre = {convert::um(x), convert::um(y)};
    v.normal_bam = convert::bam(normal);
    v.start_um = convert::um(-half);
    v.end_um = convert::um(half);
    v.var_offset_um2 = 4000000;
    v.var_angle_urad2 = 4000000;
    ale_wall_t w;
    ale_wall_from_observation(&w, &v);
    w.seen = seen;
    return w;
}
