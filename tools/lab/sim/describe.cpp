#include "lab/sim/describe.h"

#include <iomanip>
#include <sstream>

namespace sim
{

namespace
{

void print_sensor(const Description &description, std::ostream &out)
{
    if (description.has_sensor) {
        out << "[sensor]\n"
            << std::fixed << std::setprecision(6) << "x = " << description.sensor.x
            << "\ny = " << description.sensor.y << std::setprecision(9)
            << "\ntheta = " << wrapped(description.sensor.theta) << "\n\n";
    }
}

void print_noise(const ale_noise_t &noise, std::ostream &out)
{
    out << "[noise]\nown_um = " << noise.own_um << "\nown_ppm = " << noise.own_ppm
        << "\nown_ppm_per_m = " << noise.own_ppm_per_m << "\nshared_um = " << noise.shared_um
        << "\nshared_ppm = " << noise.shared_ppm << "\nshared_beams = " << noise.shared_beams
        << "\nsurface_um = " << noise.surface_um << "\nbearing_nrad = " << noise.bearing_nrad << "\n\n";
}

} // namespace

std::string configuration(const Description &description)
{
    std::ostringstream out;
    out << "# " << description.origin << "\n";
    print_sensor(description, out);
    if (description.noise) {
        print_noise(*description.noise, out);
    }
    out << "[odometry]\nuse = " << (description.has_odometry ? "true" : "false")
        << "\nlag_us = " << description.lag_us << "\n";
    return out.str();
}

} // namespace sim
