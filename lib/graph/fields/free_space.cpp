#include "graph/fields/free_space.h"

#include <algorithm>

namespace ale
{

namespace
{

// A point violates free space if it is this much nearer than the surface, and is in view up to this far
// behind.
constexpr double before_m = 0.20;
constexpr double before_by_range = 0.02;
constexpr double behind_m = 0.30;

} // namespace

int FreeSpace::sector_of(const Eigen::Vector2d &from_sensor)
{
    const double turn = angle_of(from_sensor) / (2 * pi);
    return std::clamp(static_cast<int>((turn - std::floor(turn)) * sectors), 0, sectors - 1);
}

// The nearest range of a sector and of those beside it: at an edge the bearing is too sensitive.
FreeSpace::FreeSpace(const Node &node) : sensor_(node.sensor), range_m_{}
{
    std::array<float, sectors> nearest{};
    for (const SurfacePoint &point : node.points) {
        const Eigen::Vector2d from_sensor = point.p - sensor_;
        float &range = nearest[static_cast<size_t>(sector_of(from_sensor))];
        const auto distance = static_cast<float>(length(from_sensor.x(), from_sensor.y()));
        range = range > 0 ? std::min(range, distance) : distance;
    }
    for (size_t k = 0; k < sectors; k++) {
        range_m_[k] = nearest[k];
        for (const size_t beside : {(k + 1) % sectors, (k + sectors - 1) % sectors}) {
            if (nearest[k] > 0 && nearest[beside] > 0) {
                range_m_[k] = std::min(range_m_[k], nearest[beside]);
            }
        }
    }
}

double FreeSpace::range_towards(const Eigen::Vector2d &from_sensor) const
{
    return static_cast<double>(range_m_[static_cast<size_t>(sector_of(from_sensor))]);
}

bool FreeSpace::has_in_view(const Eigen::Vector2d &p) const
{
    const Eigen::Vector2d from_sensor = p - sensor_;
    const double range = range_towards(from_sensor);
    return range > 0 && length(from_sensor.x(), from_sensor.y()) < range + behind_m;
}

void FreeSpace::check(const Node &other, const Pose &pose, FreeSpaceCheck *sum) const
{
    const Eigen::Matrix2d r = rotation(pose.theta);
    const Eigen::Vector2d t = Eigen::Vector2d(pose.x, pose.y) - sensor_;
    for (const SurfacePoint &point : other.points) {
        const Eigen::Vector2d from_sensor = r * point.p + t;
        const double distance = length(from_sensor.x(), from_sensor.y());
        const double range = range_towards(from_sensor);
        if (range > 0 && distance < range + behind_m) {
            sum->points++;
            sum->violations += distance < range - before_m - before_by_range * distance ? 1 : 0;
        }
    }
}

} // namespace ale
