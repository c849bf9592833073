/* The command line of ale-sim. */
#ifndef ALE_LAB_SIM_OPTIONS_H
#define ALE_LAB_SIM_OPTIONS_H

#include <functional>
#include <optional>
#include <string>

#include "lab/sim/device/sensors.h"
#include "lab/sim/simulator.h"
#include "lab/sim/world/world_source.h"

namespace sim
{

struct Options {
    std::string log;
    std::string world;
    SimulatorOptions simulator;
    WorldSource::Options world_source;
    std::optional<Pose> mounting;
    Sensor sensor = *sensor_named("urg-04lx");
    std::string noise; /* empty: the sensor's own */
    bool once = false;
    bool drive = false;
    std::string drive_key; /* empty: ALE_DRIVE of anybody */
    bool odometry = true;
    bool describe = false;
    std::string write_log;
    std::string truth;
    std::string lcm_url;
};

/* Lets the program do its work with what the command line says; the exit code. */
int with_options(int argc, char **argv, const std::function<int(const Options &)> &work);

} // namespace sim

#endif
