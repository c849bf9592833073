#include "common/feed/seen_space.h"

#include <cmath>

#include "common/feed/core_types.h"

namespace feed
{

namespace
{

/* Memory does not grow without end, whoever says where the robot is: 80,000 m^2, 134 MB. */
constexpr size_t most_tiles = 8192;
constexpr double step_m = 0.1;
constexpr double step_rad = 0.05;
/* More than robots speed up, slow down or begin to turn. */
constexpr double most_m_s2 = 3;
constexpr double most_rad_s2 = 10;
/* Two show what is free and what is not (scan_cloud.cpp); more, what few beams meet. */
constexpr int scans_of_a_place = 4;
constexpr double place_m = 0.02;
constexpr double place_rad = 0.02;

struct Way {
    double x;
    double y;
    double theta;
};

/* Of the second pose, as seen from the first. */
Way way_between(float x, float y, float theta, float to_x, float to_y, float to_theta)
{
    const double dx = static_cast<double>(to_x) - static_cast<double>(x);
    const double dy = static_cast<double>(to_y) - static_cast<double>(y);
    const double c = std::cos(static_cast<double>(theta));
    const double s = std::sin(static_cast<double>(theta));
    return {c * dx + s * dy, c * dy - s * dx, static_cast<double>(to_theta) - static_cast<double>(theta)};
}

Way smooth_way(const ale::pose_t &before, const ale::pose_t &now)
{
    return way_between(before.x, before.y, before.theta, now.x, now.y, now.theta);
}

Way map_way(const ale::pose_t &before, const ale::pose_t &now)
{
    return way_between(before.map_x, before.map_y, before.map_theta, now.map_x, now.map_y, now.map_theta);
}

bool are_apart(const Way &a, const Way &b, double most_m, double most_rad)
{
    return std::hypot(a.x - b.x, a.y - b.y) > most_m ||
           std::fabs(std::remainder(a.theta - b.theta, 2 * M_PI)) > most_rad;
}

/* Whether the smooth pose, which never jumps, is where no robot can have gone to: its map was forgotten. */
bool leaps(const ale::pose_t &before, const ale::pose_t &now)
{
    const double seconds = std::fabs(static_cast<double>(now.utime - before.utime)) * 1e-6;
    const Way expected = {static_cast<double>(before.vx) * seconds, static_cast<double>(before.vy) * seconds,
                          static_cast<double>(before.omega) * seconds};
    return are_apart(smooth_way(before, now), expected, step_m + most_m_s2 * seconds * seconds,
                     step_rad + most_rad_s2 * seconds * seconds);
}

/* Whether the map pose went elsewhere than the smooth one, or that is of another map. */
bool steps(const ale::pose_t &before, const ale::pose_t &now)
{
    return leaps(before, now) || are_apart(map_way(before, now), smooth_way(before, now), step_m, step_rad);
}

} // namespace

bool SeenSpace::take(const ale::scan_t &scan)
{
    scan_ = scan;
    return lay_out();
}

bool SeenSpace::take(const ale::pose_t &pose)
{
    if (pose_ && steps(*pose_, pose)) {
        forget();
    }
    pose_ = pose;
    return lay_out();
}

bool SeenSpace::take(const ale::tracking_t &tracking)
{
    tracking_ = tracking;
    return lay_out();
}

bool SeenSpace::take(const ale::graph_t &graph)
{
    if (graph.scan.empty()) {
        return false;
    }
    const bool another = first_scan_ && *first_scan_ != graph.scan.front();
    if (another) {
        forget();
    }
    first_scan_ = graph.scan.front();
    return another;
}

bool SeenSpace::is_new_here()
{
    if (scans_here_ == 0 || are_apart(map_way(here_, *pose_), {}, place_m, place_rad)) {
        here_ = *pose_;
        scans_here_ = 0;
    }
    return scans_here_++ < scans_of_a_place;
}

bool SeenSpace::lay_out()
{
    if (!scan_ || !pose_ || !tracking_ || scan_->scan != pose_->scan || scan_->scan != tracking_->scan) {
        return false;
    }
    if (cloud_.tiles() > most_tiles) {
        forget();
    }
    const bool wanted = tracking_->map_id == 0 && is_new_here();
    if (wanted) {
        cloud_.add(*core_scan(*scan_), core_scan_pose(*pose_),
                   core_pose(scan_->sensor_x, scan_->sensor_y, scan_->sensor_theta));
    }
    scan_.reset();
    return wanted;
}

} // namespace feed
