/* What is known of the robot behind a log or a world, as a fragment of ale-slamd's configuration. */
#ifndef ALE_LAB_SIM_DESCRIBE_H
#define ALE_LAB_SIM_DESCRIBE_H

#include <cstdint>
#include <string>
#include <vector>

#include "lab/sim/device/scanner.h"

namespace sim
{

struct Description {
    std::string origin; /* for people */
    bool has_sensor = false;
    Pose sensor;
    std::vector<BlindSector> blind;
    bool has_odometry = false;
    int64_t lag_us = 0;
};

std::string configuration(const Description &description);

} // namespace sim

#endif
