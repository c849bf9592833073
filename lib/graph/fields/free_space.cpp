#include "graph/fields/free_space.h"

#include <algorithm>
#include <cmath>

#include "base/trig.h"

namespace ale
{

namespace
{

// A point violates free space if it is this much nearer than the surface, and is in view up to this far
// behind.
constexpr double before_m = 0.20;
constexpr double before_by_range = 0.02;
constexpr double behind_m = 0.30;

constexpr int octant_sectors = 45;

// Where a sector of the octant ends and the next begins, by slope.
using Slopes = std::array<double, octant_sectors - 1>;

Slopes slopes_of_octant()
{
    Slopes slopes{};
    for (size_t k = 0; k < slopes.size(); k++) {
        const auto angle_bam = static_cast<uint32_t>(((uint64_t{k} + 1) << 29) / octant_sectors);
        const ale_direction_t direction = ale_direction(angle_bam);
        slopes.at(k) = static_cast<double>(direction.sin_q30) / direction.cos_q30;
    }
    return slopes;
}

// Counts on from a parabola that touches the arc tangent at 0 and meets it at 1: it is nowhere ahead of that,
// and little more than a sector behind.
int sector_in_octant(double shorter, double longer)
{
    static const Slopes slopes = slopes_of_octant();
    constexpr double in_radian = 4 * octant_sectors / pi;
    const double slope = longer > 0 ? shorter / longer : 0;
    const int begun = static_cast<int>(slope * (in_radian - (in_radian - octant_sectors) * slope));
    auto sector = static_cast<size_t>(std::min(begun, octant_sectors - 1));
    while (sector < slopes.size() && slope >= slopes[sector]) {
        sector++;
    }
    return static_cast<int>(sector);
}

} // namespace

// By slopes, since an arc tangent would be most of what a check costs. The octants of a quadrant are mirror
// images, and so are quadrants.
int FreeSpace::sector_of(const Eigen::Vector2d &from_sensor)
{
    static_assert(sectors == 8 * octant_sectors);
    const double x = std::abs(from_sensor.x());
    const double y = std::abs(from_sensor.y());
    int sector = y > x ? sectors / 4 - 1 - sector_in_octant(x, y) : sector_in_octant(y, x);
    sector = from_sensor.x() < 0 ? sectors / 2 - 1 - sector : sector;
    return from_sensor.y() < 0 ? sectors - 1 - sector : sector;
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
