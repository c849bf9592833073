#include "sim/describe.h"

#include <cinttypes>
#include <cstdio>

namespace sim
{

std::string configuration(const Description &description)
{
    char sensor[128] = "";
    if (description.has_sensor) {
        std::snprintf(sensor, sizeof sensor, "[sensor]\nx = %.6f\ny = %.6f\ntheta = %.9f\n\n",
                      description.sensor.x, description.sensor.y, wrapped(description.sensor.theta));
    }
    char odometry[96];
    std::snprintf(odometry, sizeof odometry, "[odometry]\nuse = %s\nlag_us = %" PRId64 "\n",
                  description.has_odometry ? "true" : "false", description.lag_us);
    return "# " + description.origin + "\n" + sensor + odometry;
}

} // namespace sim
