/* The configuration that a log is replayed with: file, log and command line, the latter before the former. */
#ifndef ALE_LAB_REPLAY_ROBOT_CONFIG_H
#define ALE_LAB_REPLAY_ROBOT_CONFIG_H

#include "lab/replay/log_reader.h"
#include "lab/replay/options.h"

extern "C" {
#include "config/config.h"
}

namespace ale
{

/* recorded: the configuration text of a flight recording, or nullptr; --config goes before it.
 * Throws cli::WrongUse with the one line that names file, line and key. */
ale_config_t robot_config(const ReplayOptions &options, const ale_log_info_t &info, const char *recorded);

/* The bearings of a raw device do not know that it hangs upside down. */
ale_scan_t mounted(const ale_scan_t &scan, bool upside_down);

} // namespace ale

#endif
