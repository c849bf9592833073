#include "operator/watch/record.h"

#include <algorithm>

#include "operator/console/checks.h"
#include "operator/watch/core_types.h"

namespace watch
{

void Record::subscribe(console::LcmFeed &feed)
{
    feed.on<ale::pose_t>("ALE_POSE", [this](const ale::pose_t &message) { pose(message); });
    feed.on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &message) { features(message); });
    feed.on<ale::scan_t>("ALE_SCAN", [this](const ale::scan_t &message) { scan(message); });
    feed.on<ale::map_t>("ALE_MAP", [this](const ale::map_t &message) { map(message); });
    feed.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) { status(message); });
}

void Record::pose(const ale::pose_t &pose)
{
    console::check(pose);
    if (!poses_.empty()) {
        missing_ += std::max<int64_t>(0, static_cast<int64_t>(pose.scan) - poses_.back().pose.scan - 1);
    }
    predicted_ += pose.predicted != 0 ? 1 : 0;
    states_[static_cast<unsigned char>(pose.state)]++;
    for (size_t k = 0; k < stage_count; k++) {
        worst_stage_ns_[k] = std::max(worst_stage_ns_[k], pose.stage_ns[k]);
    }
    poses_.push_back({pose, lines_, corners_});
    lay_out_scan();
}

void Record::features(const ale::features_t &features)
{
    console::check(features);
    lines_ = features.num_lines;
    corners_ = features.num_corners;
    /* Features follow the pose of their scan: its row gets its own. */
    if (!poses_.empty() && poses_.back().pose.scan == features.scan) {
        poses_.back().lines = lines_;
        poses_.back().corners = corners_;
    }
}

void Record::scan(const ale::scan_t &scan)
{
    console::check(scan);
    scan_ = scan;
    lay_out_scan();
}

void Record::lay_out_scan()
{
    if (!scan_ || poses_.empty() || poses_.back().pose.scan != scan_->scan) {
        return;
    }
    const ale::pose_t &pose = poses_.back().pose;
    cloud_.add(*core_scan(*scan_), core_scan_pose(pose),
               core_pose(scan_->sensor_x, scan_->sensor_y, scan_->sensor_theta));
    scan_.reset();
}

void Record::map(const ale::map_t &part)
{
    console::check(part);
    if (map_parts_.add(part)) {
        map_ = map_parts_.whole();
    }
}

void Record::status(const ale::status_t &status)
{
    status_ = status;
}

ale::Trajectory Record::trajectory() const
{
    ale::Trajectory poses;
    for (const PoseRow &row : poses_) {
        const ale::pose_t &pose = row.pose;
        poses.push_back({pose.utime, core_pose(pose.map_x, pose.map_y, pose.map_theta)});
    }
    return poses;
}

int64_t Record::in_state(int state) const
{
    return states_[static_cast<size_t>(state)];
}

} // namespace watch
