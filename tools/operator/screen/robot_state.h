/* The newest of everything that the robot publishes, checked. One thread. */
#ifndef SCREEN_ROBOT_STATE_H
#define SCREEN_ROBOT_STATE_H

#include <chrono>
#include <optional>

#include "ale/features_t.hpp"
#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/status_t.hpp"
#include "operator/console/checks.h"
#include "operator/console/lcm_feed.h"
#include "operator/console/map_parts.h"

namespace text_screen
{

struct RobotState {
    using Clock = std::chrono::steady_clock;

    std::optional<ale::pose_t> pose;
    Clock::time_point pose_at{};
    std::optional<ale::features_t> features;
    std::optional<ale::status_t> status;
    ale::map_t map{};
    uint64_t malformed = 0;

    void subscribe(console::LcmFeed &feed)
    {
        feed.on<ale::pose_t>("ALE_POSE", [this](const ale::pose_t &message) {
            console::check(message);
            pose = message;
            pose_at = Clock::now();
        });
        feed.on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &message) {
            console::check(message);
            features = message;
        });
        feed.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) { status = message; });
        feed.on<ale::map_t>("ALE_MAP", [this](const ale::map_t &message) {
            console::check(message);
            if (parts_.add(message)) {
                map = parts_.whole();
            }
        });
    }

  private:
    console::MapParts parts_;
};

} // namespace text_screen

#endif
