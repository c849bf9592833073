/* The newest of everything that the robot publishes, checked. One thread. */
#ifndef WATCH_ROBOT_STATE_H
#define WATCH_ROBOT_STATE_H

#include <chrono>
#include <optional>

#include "ale/features_t.hpp"
#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/status_t.hpp"
#include "common/feed/checks.h"
#include "common/feed/map_parts.h"

namespace watch
{

struct RobotState {
    using Clock = std::chrono::steady_clock;

    std::optional<ale::pose_t> pose;
    Clock::time_point pose_at{};
    std::optional<ale::features_t> features;
    std::optional<ale::status_t> status;
    ale::map_t map{}; /* the newest whole one */
    uint64_t malformed = 0;

    /* Each throws std::runtime_error when the message makes no sense. */
    void take(const ale::pose_t &message)
    {
        feed::check(message);
        pose = message;
        pose_at = Clock::now();
    }
    void take(const ale::features_t &message)
    {
        feed::check(message);
        features = message;
    }
    void take(const ale::status_t &message)
    {
        status = message;
    }
    void take(const ale::map_t &message)
    {
        feed::check(message);
        if (parts_.add(message)) {
            map = parts_.whole();
        }
    }

  private:
    feed::MapParts parts_;
};

} // namespace watch

#endif
