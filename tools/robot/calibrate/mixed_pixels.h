/* Mixed pixels: at the edge of something near, a beam now and then measures neither it nor what lies behind.
 */
#ifndef ALE_ROBOT_CALIBRATE_MIXED_PIXELS_H
#define ALE_ROBOT_CALIBRATE_MIXED_PIXELS_H

#include "robot/calibrate/temporal.h"

namespace calibrate
{

struct MixedPixels {
    int edges = 0;    /* depth edges that were looked at */
    double share = 0; /* of an edge's scans with a value in between */
};

MixedPixels count_mixed_pixels(const Recording &recording, const std::vector<Beam> &beams);

} // namespace calibrate

#endif
