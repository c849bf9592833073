/* Command line of ale-replay. */
#ifndef ALE_LAB_REPLAY_OPTIONS_H
#define ALE_LAB_REPLAY_OPTIONS_H

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/export/scan_cloud.h"
#include "common/log/robot_config.h"

namespace ale
{

struct ReplayOptions : RobotOptions {
    std::string log;
    std::string features;
    std::string poses;
    std::string trajectory;
    std::string trajectory_live;
    std::vector<std::string> maps;
    std::string timing;
    std::string lcm;
    std::string load_map;
    std::optional<ale_pose_t> start; /* in that map */
    std::string save_map;
    int32_t map_cell_um = ScanCloud::usual_cell_um; /* of .pgm */
    bool laser_frame = false;
    bool close_loops = true;
    bool lines_only = false;
    bool points = false;
};

/* Lets the program do its work with what the command line says; the exit code. */
int with_options(int argc, char **argv, const std::function<int(const ReplayOptions &)> &work);

} // namespace ale

#endif
