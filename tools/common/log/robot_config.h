/* The configuration that a log is read with: file, log and command line, the latter before the former. */
#ifndef ALE_COMMON_LOG_ROBOT_CONFIG_H
#define ALE_COMMON_LOG_ROBOT_CONFIG_H

#include <optional>
#include <string>

#include "common/log/log_reader.h"

extern "C" {
#include "config/config.h"
}

namespace ale
{

/* What the command line says of the robot. */
struct RobotOptions {
    std::string config; /* file for ale-slamd, or empty */
    std::string model;  /* preset of the noise, or empty; what the file says under [noise] goes before it */
    std::optional<ale_pose_t> sensor;
    bool use_odometry = true;
};

/* recorded: the configuration text of a flight recording, or nullptr; --config goes before it.
 * Throws cli::WrongUse with the one line that names file, line and key. */
ale_config_t robot_config(const RobotOptions &options, const ale_log_info_t &info, const char *recorded);

/* The bearings of a raw device do not know that it hangs upside down. */
ale_scan_t mounted(const ale_scan_t &scan, bool upside_down);

} // namespace ale

#endif
