/* The scanners that can be simulated, by name. */
#ifndef ALE_LAB_SIM_SENSORS_H
#define ALE_LAB_SIM_SENSORS_H

#include <optional>
#include <string>

#include "lab/sim/device/rplidar_device.h"
#include "lab/sim/device/scanner.h"
#include "lab/sim/device/sweep.h"

namespace sim
{

enum class SensorFamily { urg, ldrobot, rplidar };

struct Sensor {
    const char *name;
    SensorFamily family;
    const char *noise; /* model of world/sensor_noise.h */
    Scanner scanner;   /* of the family urg */
    Rotary rotary;     /* of the others */
    RplidarModel rplidar;

    bool is_rotary() const
    {
        return family != SensorFamily::urg;
    }
};

/* Nothing: there is none of that name. */
std::optional<Sensor> sensor_named(const std::string &name);

/* "urg-04lx, ld06, ..." */
std::string sensor_names();

} // namespace sim

#endif
