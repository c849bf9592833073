/* Command line of ale-merge. */
#ifndef ALE_LAB_MERGE_OPTIONS_H
#define ALE_LAB_MERGE_OPTIONS_H

#include <functional>
#include <string>
#include <vector>

#include "common/log/robot_config.h"

extern "C" {
#include "store/tile_file.h"
}

namespace merge
{

struct Options : ale::RobotOptions {
    std::vector<std::string> drives;
    std::string out;
    std::string keep_drives;
    std::string tiles;
    int32_t tile_side_um = ALE_TILE_SIDE_UM;
    std::string into;
    bool versions = false; /* of the one file that `drives` names */
    size_t keep = 20;
    std::vector<std::string> maps;
    std::string trajectories;
    bool laser_frame = false;
    bool points = false;
};

/* Lets the program do its work with what the command line says; the exit code. */
int with_options(int argc, char **argv, const std::function<int(const Options &)> &work);

} // namespace merge

#endif
