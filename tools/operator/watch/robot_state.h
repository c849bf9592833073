/* The newest of everything that the robot publishes, checked. One thread. */
#ifndef WATCH_ROBOT_STATE_H
#define WATCH_ROBOT_STATE_H

#include <chrono>
#include <optional>
#include <string>

#include "ale/features_t.hpp"
#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/feed/checks.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"

namespace watch
{

struct RobotState {
    using Clock = std::chrono::steady_clock;

    std::optional<ale::pose_t> pose;
    Clock::time_point pose_at{};
    std::optional<ale::tracking_t> tracking;
    std::optional<ale::features_t> features;
    std::optional<ale::status_t> status;
    ale::map_t map{}; /* the newest whole one */
    feed::MapPieces pieces;
    uint64_t malformed = 0;

    /* Each throws std::runtime_error when the message makes no sense. */
    void take(const ale::pose_t &message)
    {
        feed::check(message);
        pose = message;
        pose_at = Clock::now();
    }
    void take(const ale::tracking_t &message)
    {
        feed::check(message);
        tracking = message;
    }
    void take(const ale::map_pieces_t &message)
    {
        feed::check(message);
        pieces.add(message);
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

    /* Few words where the robot goes on in a map that is not joined with the first; else empty. */
    std::string map_trouble() const
    {
        if (!tracking || (tracking->maps <= 1 && tracking->map_id == 0)) {
            return "";
        }
        return tracking->map_id != 0 ? "new map, not joined yet"
                                     : std::to_string(tracking->maps) + " maps, not joined";
    }
    /* What the wheels do wrong, in a word; empty: nothing. */
    std::string wheel_trouble() const
    {
        return tracking && tracking->wheel_fault != 0 ? tracking->wheel_word : "";
    }

  private:
    feed::MapParts parts_;
};

} // namespace watch

#endif
