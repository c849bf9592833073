#include "operator/ros2/occupancy.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ros2
{

namespace
{

/* A grid of 200 m by 200 m goes out; memory does not grow without end. */
constexpr int64_t most_cells = 16000000;
constexpr size_t most_points = 2000000;
constexpr double step_m = 0.1;
constexpr double step_rad = 0.05;

Pose2 smooth_of(const ale::pose_t &pose)
{
    return {static_cast<double>(pose.x), static_cast<double>(pose.y), static_cast<double>(pose.theta)};
}

Pose2 map_of(const ale::pose_t &pose)
{
    return {static_cast<double>(pose.map_x), static_cast<double>(pose.map_y),
            static_cast<double>(pose.map_theta)};
}

} // namespace

/* Whether the map pose went elsewhere than the smooth one. */
bool Occupancy::steps(const ale::pose_t &pose) const
{
    const Pose2 way = compose(inverse(smooth_of(*pose_)), smooth_of(pose));
    const Pose2 expected = compose(map_of(*pose_), way);
    const Pose2 off = compose(inverse(expected), map_of(pose));
    return std::hypot(off.x, off.y) > step_m || std::fabs(off.theta) > step_rad;
}

void Occupancy::take(const ale::scan_t &scan)
{
    scan_ = scan;
    add_scan();
}

void Occupancy::take(const ale::pose_t &pose)
{
    if (pose_ && steps(pose)) {
        cloud_ = std::make_unique<ale::ScanCloud>();
    }
    pose_ = pose;
    add_scan();
}

void Occupancy::take(const ale::tracking_t &tracking)
{
    tracking_ = tracking;
    add_scan();
}

void Occupancy::take(const ale::map_t &map, const feed::MapPieces &pieces)
{
    map_ = feed::core_map(map, pieces);
    const auto end = std::remove_if(map_->line, map_->line + map_->line_count, ale::is_apart);
    map_->line_count = static_cast<uint16_t>(end - map_->line);
    changed_ = true;
}

void Occupancy::add_scan()
{
    if (!scan_ || !pose_ || !tracking_ || scan_->scan != pose_->scan || scan_->scan != tracking_->scan) {
        return;
    }
    if (tracking_->map_id == 0) {
        cloud_->add(*feed::core_scan(*scan_), feed::core_scan_pose(*pose_),
                    feed::core_pose(scan_->sensor_x, scan_->sensor_y, scan_->sensor_theta));
        changed_ = true;
    }
    scan_.reset();
    if (cloud_->points().size() > most_points) {
        cloud_ = std::make_unique<ale::ScanCloud>();
    }
}

ale::OccupancyGrid Occupancy::grid()
{
    changed_ = false;
    ale::MapScene scene;
    scene.map = map_.get();
    scene.cloud = cloud_.get();
    try {
        return ale::occupancy_of(scene, most_cells);
    } catch (const std::runtime_error &) {
        cloud_ = std::make_unique<ale::ScanCloud>();
        throw;
    }
}

} // namespace ros2
