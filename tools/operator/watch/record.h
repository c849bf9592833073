/* All that came from the robot while it was watched: what the status line says and the files hold. */
#ifndef WATCH_RECORD_H
#define WATCH_RECORD_H

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ale/features_t.hpp"
#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "common/export/scan_cloud.h"
#include "common/export/trajectory.h"
#include "operator/console/lcm_feed.h"
#include "operator/console/map_parts.h"

namespace watch
{

constexpr size_t stage_count = 5;

/* One pose as received, with what was seen at that moment. */
struct PoseRow {
    ale::pose_t pose;
    int32_t lines;
    int32_t corners;
};

class Record
{
  public:
    void subscribe(console::LcmFeed &feed);

    void pose(const ale::pose_t &pose);
    void features(const ale::features_t &features);
    void scan(const ale::scan_t &scan);
    void map(const ale::map_t &part);
    void status(const ale::status_t &status);

    /* Map pose of every scan as it was published. */
    ale::Trajectory trajectory() const;

    const std::vector<PoseRow> &poses() const
    {
        return poses_;
    }
    const std::optional<ale::map_t> &map() const
    {
        return map_;
    }
    const std::optional<ale::status_t> &status() const
    {
        return status_;
    }
    /* What the scans saw, laid out in the map; empty when the robot sends no ALE_SCAN. */
    const ale::ScanCloud &cloud() const
    {
        return cloud_;
    }
    int32_t lines() const
    {
        return lines_;
    }
    int32_t corners() const
    {
        return corners_;
    }
    /* Scan numbers that no pose came for, between the first and the last. */
    int64_t missing() const
    {
        return missing_;
    }
    /* Poses behind which no scan stood. */
    int64_t predicted() const
    {
        return predicted_;
    }
    int64_t in_state(int state) const;
    const std::array<int32_t, stage_count> &worst_stage_ns() const
    {
        return worst_stage_ns_;
    }

  private:
    void lay_out_scan();

    std::vector<PoseRow> poses_;
    std::optional<ale::map_t> map_;
    std::optional<ale::status_t> status_;
    console::MapParts map_parts_;
    std::optional<ale::scan_t> scan_; /* waits for its pose, or the pose for it */
    ale::ScanCloud cloud_;
    int32_t lines_ = 0;
    int32_t corners_ = 0;
    int64_t missing_ = 0;
    int64_t predicted_ = 0;
    std::array<int64_t, 3> states_{};
    std::array<int32_t, stage_count> worst_stage_ns_{};
};

} // namespace watch

#endif
