#include "lab/sim/describe.h"

#include <iomanip>
#include <sstream>

namespace sim
{

namespace
{

void print_sensor(const Description &description, std::ostream &out)
{
    if (!description.has_sensor && description.blind.empty()) {
        return;
    }
    out << "[sensor]\n" << std::fixed;
    if (description.has_sensor) {
        out << std::setprecision(6) << "x = " << description.sensor.x << "\ny = " << description.sensor.y
            << std::setprecision(9) << "\ntheta = " << wrapped(description.sensor.theta) << "\n";
    }
    const char *before = "blind = ";
    for (const BlindSector &sector : description.blind) {
        out << std::setprecision(2) << before << sector.from << ":" << sector.to;
        before = ", ";
    }
    out << (description.blind.empty() ? "\n" : "\n\n");
}

} // namespace

std::string configuration(const Description &description)
{
    std::ostringstream out;
    out << "# " << description.origin << "\n";
    print_sensor(description, out);
    out << "[odometry]\nuse = " << (description.has_odometry ? "true" : "false")
        << "\nlag_us = " << description.lag_us << "\n";
    return out.str();
}

} // namespace sim
