#include "graph/walls/observation_record.h"

#include <algorithm>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

// All beams are kept after this displacement or rotation of the robot, or this time.
constexpr int32_t beams_step_um = 400000;
constexpr int32_t beams_turn_bam = 400 * ALE_BAM_PER_MRAD;
constexpr int64_t beams_wait_us = 5000000;

} // namespace

bool ObservationRecord::needs_beams(const ale_scan_observation_t &observation) const
{
    return scans_.empty() ||
           !ale_are_near(last_beams_pose_, observation.seen.robot, beams_step_um, beams_turn_bam) ||
           ale_abs64(observation.stamp_us - last_beams_us_) > beams_wait_us;
}

void ObservationRecord::set_prior_map(uint32_t epoch, const ale_map_t &map)
{
    *this = ObservationRecord();
    epoch_ = epoch;
    prior_lines_.assign(map.line, map.line + map.line_count);
    prior_corners_.assign(map.corner, map.corner + map.corner_count);
}

void ObservationRecord::add(const ale_scan_observation_t &observation)
{
    if (observation.epoch != epoch_) {
        *this = ObservationRecord();
        epoch_ = observation.epoch;
    }
    const ale_seen_copy_t &seen = observation.seen;
    RecordedScan scan{observation.scan,
                      observation.keyframe,
                      observation.smooth,
                      seen.robot,
                      {observation.line, observation.line + observation.line_count},
                      {observation.corner, observation.corner + observation.corner_count},
                      nullptr,
                      static_cast<uint32_t>(sensors_.size())};
    if (needs_beams(observation)) {
        scan.beams = std::make_unique<ale_seen_copy_t>(seen);
        last_beams_pose_ = seen.robot;
        last_beams_us_ = observation.stamp_us;
    }
    scans_.push_back(std::move(scan));
    sensor_ = ale_pose_between(seen.robot, seen.sensor);
}

void ObservationRecord::append(ObservationRecord &&later, uint32_t first_scan)
{
    if (epoch_ != 0) {
        sensors_.push_back(sensor_);
    }
    epoch_ = epoch_ == 0 ? later.epoch_ : epoch_;
    const auto first_drive = static_cast<uint32_t>(sensors_.size());
    sensors_.insert(sensors_.end(), later.sensors_.begin(), later.sensors_.end());
    for (RecordedScan &scan : later.scans_) {
        scan.scan += first_scan;
        scan.keyframe += first_scan;
        scan.drive += first_drive;
        scans_.push_back(std::move(scan));
    }
    sensor_ = later.sensor_;
    later = ObservationRecord();
}

void ObservationRecord::remove(const std::function<bool(const RecordedScan &)> &is_removed)
{
    scans_.erase(std::remove_if(scans_.begin(), scans_.end(), is_removed), scans_.end());
}

} // namespace ale
