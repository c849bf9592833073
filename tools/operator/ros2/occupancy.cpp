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
constexpr double step_m = 0.1;
constexpr double step_rad = 0.05;
/* More than robots speed up, slow down or begin to turn. */
constexpr double most_m_s2 = 3;
constexpr double most_rad_s2 = 10;

Pose2 smooth_of(const ale::pose_t &pose)
{
    return {static_cast<double>(pose.x), static_cast<double>(pose.y), static_cast<double>(pose.theta)};
}

Pose2 map_of(const ale::pose_t &pose)
{
    return {static_cast<double>(pose.map_x), static_cast<double>(pose.map_y),
            static_cast<double>(pose.map_theta)};
}

bool is_far(const Pose2 &off, double most_m, double most_rad)
{
    return std::hypot(off.x, off.y) > most_m || std::fabs(std::remainder(off.theta, 2 * M_PI)) > most_rad;
}

/* Whether the smooth pose, which never jumps, is where no robot can have gone to: its map was forgotten. */
bool leaps(const ale::pose_t &before, const ale::pose_t &now, const Pose2 &way)
{
    const double seconds = std::fabs(static_cast<double>(now.utime - before.utime)) * 1e-6;
    const Pose2 expected = {static_cast<double>(before.vx) * seconds,
                            static_cast<double>(before.vy) * seconds,
                            static_cast<double>(before.omega) * seconds};
    return is_far({way.x - expected.x, way.y - expected.y, way.theta - expected.theta},
                  step_m + most_m_s2 * seconds * seconds, step_rad + most_rad_s2 * seconds * seconds);
}

} // namespace

/* Whether the map pose went elsewhere than the smooth one, or that is of another map. */
bool Occupancy::steps(const ale::pose_t &pose) const
{
    const Pose2 way = compose(inverse(smooth_of(*pose_)), smooth_of(pose));
    if (leaps(*pose_, pose, way)) {
        return true;
    }
    const Pose2 expected = compose(map_of(*pose_), way);
    return is_far(compose(inverse(expected), map_of(pose)), step_m, step_rad);
}

void Occupancy::take(const ale::scan_t &scan)
{
    scan_ = scan;
    add_scan();
}

void Occupancy::take(const ale::pose_t &pose)
{
    if (pose_ && steps(pose)) {
        forget();
    }
    pose_ = pose;
    add_scan();
}

void Occupancy::take(const ale::tracking_t &tracking)
{
    tracking_ = tracking;
    add_scan();
}

/* A robot that stands where its map began when it forgets it does not leap. */
void Occupancy::take(const ale::graph_t &graph)
{
    if (graph.scan.empty()) {
        return;
    }
    if (first_scan_ && *first_scan_ != graph.scan.front()) {
        forget();
        changed_ = true;
    }
    first_scan_ = graph.scan.front();
}

void Occupancy::take(const ale::map_t &map, const feed::MapPieces &pieces)
{
    map_ = feed::core_map(map, pieces);
    const auto end = std::remove_if(map_->line, map_->line + map_->line_count, ale::is_apart);
    map_->line_count = static_cast<uint16_t>(end - map_->line);
    changed_ = true;
}

void Occupancy::forget()
{
    cloud_ =
        std::make_unique<ale::ScanCloud>(ale::ScanCloud::usual_cell_um, ale::ScanCloud::Points::left_out);
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
    if (static_cast<int64_t>(cloud_->cells()) > most_cells) {
        forget();
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
        forget();
        throw;
    }
}

} // namespace ros2
