/* Command line of ale-explore. */
#ifndef ALE_LAB_EXPLORE_OPTIONS_H
#define ALE_LAB_EXPLORE_OPTIONS_H

#include <functional>
#include <string>

#include "lab/sim/world/world_source.h"

extern "C" {
#include "config/config.h"
}

namespace explore
{

/* When an exploration went well: part of the reachable area mapped, metres from the start at its end. */
constexpr double least_mapped = 0.95;
constexpr double farthest_off = 0.1;

struct Options {
    std::string world;
    std::string map;
    ale_config_t config = ale_config_default();
    sim::WorldSource::Options source;
    uint64_t first_seed = 1;
    uint64_t seeds = 1;
    double longest_s = 1800;

    double width() const
    {
        return config.robot.width_um * 1e-6;
    }
};

/* Lets the program do its work with what the command line says; the exit code. */
int with_options(int argc, char **argv, const std::function<int(const Options &)> &work);

} // namespace explore

#endif
