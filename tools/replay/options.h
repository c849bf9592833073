/* Command line of ale-replay. */
#ifndef ALE_REPLAY_OPTIONS_H
#define ALE_REPLAY_OPTIONS_H

#include <optional>
#include <string>
#include <vector>

extern "C" {
#include "base/pose.h"
}

namespace ale
{

struct ReplayOptions {
    std::string log;
    std::string config;
    std::string features;
    std::string poses;
    std::string trajectory;
    std::string trajectory_live;
    std::vector<std::string> maps;
    std::string timing;
    std::string load_map;
    std::string save_map;
    std::optional<ale_pose_t> sensor;
    bool laser_frame = false;
    bool close_loops = true;
    bool use_odometry = true;
    bool lines_only = false;
    bool points = false;
};

/* The exit code when the command line has been answered (0: help, version; 2: wrong use, said on stderr),
 * else -1 and *options filled. */
int parse_options(int argc, char **argv, ReplayOptions &options);

} // namespace ale

#endif
