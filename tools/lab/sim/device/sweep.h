/* Part of a turn of a rotary scanner: as many points as it sends in one packet, each with its own bearing. */
#ifndef ALE_LAB_SIM_SWEEP_H
#define ALE_LAB_SIM_SWEEP_H

#include <cstdint>
#include <vector>

namespace sim
{

/* How a rotary scanner measures and sends. All of them turn clockwise, seen from above. */
struct Rotary {
    double points_a_second = 4500;
    double turns_a_second = 10;
    double wander = 0.01; /* of the motor's speed, as a part of it, over seven seconds */
    uint32_t packet_points = 12;
    int32_t min_mm = 20;
    int32_t max_mm = 12000;
    int64_t line_us = 2040; /* that a packet takes on the line */

    double point_us() const
    {
        return 1e6 / points_a_second;
    }
};

struct Echo {
    double clockwise; /* bearing from straight ahead, degrees, 0 to 360 */
    int32_t mm;       /* 0: nothing came back */
};

/* Times are microseconds of play. */
struct Sweep {
    uint32_t number = 0;
    uint32_t turn = 0;
    bool begins_turn =
        false;           /* its first point is the turn's first one, or the turn's first lies within it */
    double start_us = 0; /* of its first point; the others follow at the scanner's own pace */
    double end_us = 0;   /* of its last point */
    double degrees_a_second = 0;
    std::vector<Echo> echoes;
};

} // namespace sim

#endif
