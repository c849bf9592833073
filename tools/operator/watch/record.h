/* What came from the robot while it was watched: the newest of everything, counts, and for the files the
 * history. */
#ifndef WATCH_RECORD_H
#define WATCH_RECORD_H

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ale/scan_t.hpp"
#include "common/export/scan_cloud.h"
#include "common/export/trajectory.h"
#include "common/feed/lcm_feed.h"
#include "operator/watch/robot_state.h"

namespace watch
{

constexpr size_t stage_count = 5;

/* One pose as received, with the features of its scan. */
struct PoseRow {
    ale::pose_t pose;
    int32_t lines;
    int32_t corners;
};

struct PoseCounts {
    int64_t received = 0;
    int64_t missing = 0;   /* scan numbers that no pose came for, between the first and the last */
    int64_t predicted = 0; /* poses behind which no scan stood */
    std::array<int64_t, 3> in_state{};
    std::array<int32_t, stage_count> worst_stage_ns{};
};

class Record
{
  public:
    /* with_history: poses and points of the scans are kept for the files. */
    explicit Record(bool with_history) : with_history_(with_history)
    {
    }

    void subscribe(feed::LcmFeed &feed);

    /* Each throws std::runtime_error when the message makes no sense. */
    void take(const ale::pose_t &pose);
    void take(const ale::features_t &features);
    void take(const ale::scan_t &scan);

    const RobotState &newest() const
    {
        return newest_;
    }
    const PoseCounts &counts() const
    {
        return counts_;
    }
    void set_malformed(uint64_t messages)
    {
        newest_.malformed = messages;
    }

    const std::vector<PoseRow> &history() const
    {
        return history_;
    }
    /* Map pose of every scan as it was published. */
    ale::Trajectory trajectory() const;
    /* Points of the scans in the map; empty when the robot sends no ALE_SCAN. */
    const ale::ScanCloud &cloud() const
    {
        return cloud_;
    }

  private:
    void add_scan_to_cloud();

    const bool with_history_;
    RobotState newest_;
    PoseCounts counts_;
    std::vector<PoseRow> history_;
    std::optional<ale::scan_t> scan_; /* waits for its pose, or the pose for it */
    ale::ScanCloud cloud_;
};

} // namespace watch

#endif
