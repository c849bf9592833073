// What the scans of a drive observed: from this record the map is rebuilt.
//
//   ObservationRecord record;
//   record.add(observation);        (of every scan that is to count)
//
// Lines and corners of every scan, about 1 kB; of some scans all beams too, 11 kB: these show free space.
#ifndef ALE_GRAPH_WALLS_OBSERVATION_RECORD_H
#define ALE_GRAPH_WALLS_OBSERVATION_RECORD_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

extern "C" {
#include "map/line_map.h"
#include "track/scan_observation.h"
}

namespace ale
{

struct RecordedScan {
    uint32_t scan;
    uint32_t keyframe;                      // the one that it belongs to
    ale_pose_t smooth;                      // of the robot
    ale_pose_t tracked;                     // the same in the map as it was then
    std::vector<ale_observation_t> lines;   // robot's frame
    std::vector<ale_corner_t> corners;      // sensor's frame
    std::unique_ptr<ale_seen_copy_t> beams; // of some scans
    uint32_t drive = 0;                     // that it is of; larger is later
};

// The corrected pose of the robot at a scan, map frame; none: the scan is of another map.
using PoseOfScan = std::function<std::optional<ale_pose_t>(const RecordedScan &scan)>;

class ObservationRecord
{
  public:
    ObservationRecord() = default;
    // Of one drive, as scans() and sensor() told it: more drives may follow, but no more of its scans.
    ObservationRecord(uint32_t epoch, const ale_pose_t &sensor, std::vector<RecordedScan> scans)
        : epoch_(epoch), sensor_(sensor), scans_(std::move(scans))
    {
    }

    // The drive begins in this map: its walls and corners count as observed before the first scan. Call it
    // before the first scan of the epoch; forgets all else. O(lines); may throw std::bad_alloc.
    void set_prior_map(uint32_t epoch, const ale_map_t &map);

    // Adds a scan later than the last one. One of another epoch clears the record first. O(lines of the
    // scan); may throw std::bad_alloc.
    void add(const ale_scan_observation_t &observation);

    // Adds the scans of later drives, perhaps of other robots; the first of them becomes number `first_scan`,
    // which is beyond all scans so far. Prior maps stay this record's. O(scans); may throw std::bad_alloc.
    void append(ObservationRecord &&later, uint32_t first_scan);

    // Removes the scans for which `is_removed` holds. O(scans).
    void remove(const std::function<bool(const RecordedScan &)> &is_removed);

    // Scans ascending.
    const std::vector<RecordedScan> &scans() const
    {
        return scans_;
    }
    // Walls and corners of the prior map.
    const std::vector<ale_map_line_t> &prior_lines() const
    {
        return prior_lines_;
    }
    const std::vector<ale_map_corner_t> &prior_corners() const
    {
        return prior_corners_;
    }
    // Pose of the sensor on the robot that took it.
    const ale_pose_t &sensor(const RecordedScan &scan) const
    {
        return scan.drive < sensors_.size() ? sensors_[scan.drive] : sensor_;
    }
    // Of the map; 0: nothing was added.
    uint32_t epoch() const
    {
        return epoch_;
    }

  private:
    bool needs_beams(const ale_scan_observation_t &observation) const;

    uint32_t epoch_ = 0;
    std::vector<ale_pose_t> sensors_; // of drives that others followed
    ale_pose_t sensor_{};             // and of the last
    std::vector<ale_map_line_t> prior_lines_;
    std::vector<ale_map_corner_t> prior_corners_;
    std::vector<RecordedScan> scans_;
    ale_pose_t last_beams_pose_{};
    int64_t last_beams_us_ = 0;
};

} // namespace ale

#endif
