/* What a robot vouches for, taken apart only after its signature was found to be right; and whom an operator
 * believes. */
#ifndef ALE_COMMON_FEED_VOUCHED_H
#define ALE_COMMON_FEED_VOUCHED_H

#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "ale/vouched_t.hpp"

extern "C" {
#include "command/operator.h"
#include "command/vouched.h"
}

namespace feed
{

/* Nothing when none of these robots has signed the bytes, or one that calls itself by the name of another
 * one.
 */
inline std::optional<ale::vouched_t> vouched_by(const ale_keys_t &robots, const uint8_t *bytes, size_t count)
{
    ale::vouched_t message;
    if (!ale_is_vouched(&robots, bytes, count) || message.decode(bytes, 0, static_cast<int>(count)) < 0 ||
        !ale_may_be_called(&robots, message.key, message.status.robot.c_str())) {
        return std::nullopt;
    }
    return message;
}

inline ale_start_t start_of(const ale::vouched_t &message)
{
    ale_start_t start{};
    start.key = message.key;
    start.boot = message.boot;
    start.counter = message.counter;
    start.utime = message.utime;
    start.rate_ppm = message.clock_ppm;
    std::snprintf(start.robot, sizeof start.robot, "%s", message.status.robot.c_str());
    return start;
}

/* The robots that are believed: those of the file that is named, else of the one beside the operator's key;
 * none when neither is there. Throws std::runtime_error for a file that cannot be read or names no robot. */
inline ale_keys_t believed(const std::string &robots_file, const std::string &key_file)
{
    const std::string path =
        robots_file.empty() && !key_file.empty() ? key_file + ALE_ROBOTS_ENDING : robots_file;
    ale_keys_t robots{};
    if (path.empty() || (robots_file.empty() && access(path.c_str(), F_OK) != 0)) {
        return robots;
    }
    char error[ALE_KEYS_ERROR];
    if (ale_robots_load(path.c_str(), &robots, error) < 0) {
        throw std::runtime_error(error);
    }
    if (robots.count == 0) {
        throw std::runtime_error(path + ": no robot in it (ale-keys --know)");
    }
    return robots;
}

} // namespace feed

#endif
