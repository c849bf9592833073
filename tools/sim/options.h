/* The command line of ale-sim. */
#ifndef ALE_SIM_OPTIONS_H
#define ALE_SIM_OPTIONS_H

#include <optional>
#include <string>

#include "sim/simulator.h"
#include "sim/world_source.h"

namespace sim
{

struct Options {
    std::string log;
    std::string world;
    SimulatorOptions simulator;
    WorldSource::Options world_source;
    std::optional<Pose> sensor;
    bool once = false;
    bool drive = false;
    bool odometry = true;
    bool describe = false;
    std::string write_log;
    std::string truth;
    std::string lcm_url;
};

extern const char usage[];

/* The exit code when the command line has been answered already (help, version), else -1 with *options
 * filled. Throws WrongUse. */
int parse_options(int argc, char **argv, Options &options);

} // namespace sim

#endif
