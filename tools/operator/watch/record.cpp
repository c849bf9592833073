#include "operator/watch/record.h"

#include <algorithm>

#include "common/feed/core_types.h"

namespace watch
{

void Record::subscribe(feed::LcmFeed &feed)
{
    feed.on<ale::pose_t>("ALE_POSE", [this](const ale::pose_t &message) { take(message); });
    feed.on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &message) { take(message); });
    feed.on<ale::tracking_t>("ALE_TRACKING",
                             [this](const ale::tracking_t &message) { newest_.take(message); });
    feed.on<ale::map_pieces_t>("ALE_MAP_PIECES",
                               [this](const ale::map_pieces_t &message) { newest_.take(message); });
    feed.on<ale::map_t>("ALE_MAP", [this](const ale::map_t &message) { newest_.take(message); });
    feed.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) { newest_.take(message); });
    feed.on<ale::scan_t>("ALE_SCAN", [this](const ale::scan_t &message) { take(message); });
}

void Record::take(const ale::pose_t &pose)
{
    const std::optional<ale::pose_t> before = newest_.pose;
    newest_.take(pose);
    counts_.received++;
    if (before) {
        counts_.missing += std::max<int64_t>(0, static_cast<int64_t>(pose.scan) - before->scan - 1);
    }
    counts_.predicted += pose.predicted != 0 ? 1 : 0;
    counts_.in_state[static_cast<unsigned char>(pose.state)]++;
    for (size_t k = 0; k < stage_count; k++) {
        counts_.worst_stage_ns[k] = std::max(counts_.worst_stage_ns[k], pose.stage_ns[k]);
    }
    if (with_history_) {
        const auto &seen = newest_.features;
        history_.push_back({pose, seen ? seen->num_lines : 0, seen ? seen->num_corners : 0});
        add_scan_to_cloud();
    }
}

void Record::take(const ale::features_t &features)
{
    newest_.take(features);
    /* Features follow the pose of their scan: its row gets its own. */
    if (!history_.empty() && history_.back().pose.scan == features.scan) {
        history_.back().lines = features.num_lines;
        history_.back().corners = features.num_corners;
    }
}

void Record::take(const ale::scan_t &scan)
{
    feed::check(scan);
    if (with_history_) {
        scan_ = scan;
        add_scan_to_cloud();
    }
}

void Record::add_scan_to_cloud()
{
    if (!scan_ || !newest_.pose || newest_.pose->scan != scan_->scan) {
        return;
    }
    cloud_.add(*feed::core_scan(*scan_), feed::core_scan_pose(*newest_.pose),
               feed::core_pose(scan_->sensor_x, scan_->sensor_y, scan_->sensor_theta));
    scan_.reset();
}

ale::Trajectory Record::trajectory() const
{
    ale::Trajectory poses;
    for (const PoseRow &row : history_) {
        const ale::pose_t &pose = row.pose;
        poses.push_back({pose.utime, feed::core_pose(pose.map_x, pose.map_y, pose.map_theta)});
    }
    return poses;
}

} // namespace watch
