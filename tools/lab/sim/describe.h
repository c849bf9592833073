/* What is known of the robot behind a log or a world, as a fragment of ale-slamd's configuration. */
#ifndef ALE_LAB_SIM_DESCRIBE_H
#define ALE_LAB_SIM_DESCRIBE_H

#include <cstdint>
#include <optional>
#include <string>

#include "lab/sim/device/scanner.h"

extern "C" {
#include "base/noise.h"
}

namespace sim
{

struct Description {
    std::string origin; /* for people */
    bool has_sensor = false;
    Pose sensor;
    std::optional<ale_noise_t> noise; /* nothing: that of a URG-04LX */
    bool has_odometry = false;
    int64_t lag_us = 0;
};

std::string configuration(const Description &description);

} // namespace sim

#endif
