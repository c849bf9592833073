#include "graph/loops/free_space.h"

#include <algorithm>

namespace ale
{

namespace
{

// A point counts as before a surface when it is so much nearer, and as seen when it is not so much behind.
constexpr double before_m = 0.20;
constexpr double before_by_range = 0.02;
constexpr double behind_m = 0.30;

} // namespace

int FreeSpace::sector_of(const Eigen::Vector2d &from_eye)
{
    const double turn = angle_of(from_eye) / (2 * pi);
    return std::clamp(static_cast<int>((turn - std::floor(turn)) * sectors), 0, sectors - 1);
}

// The nearest of a sector and of those beside it: at an edge the bearing decides too much.
FreeSpace::FreeSpace(const Node &node) : eye_(node.eye), range_m_{}
{
    std::array<float, sectors> nearest{};
    for (const SurfacePoint &point : node.points) {
        const Eigen::Vector2d from_eye = point.p - eye_;
        float &range = nearest[static_cast<size_t>(sector_of(from_eye))];
        const auto distance = static_cast<float>(length(from_eye.x(), from_eye.y()));
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

double FreeSpace::range_towards(const Eigen::Vector2d &from_eye) const
{
    return static_cast<double>(range_m_[static_cast<size_t>(sector_of(from_eye))]);
}

bool FreeSpace::reaches(const Eigen::Vector2d &p) const
{
    const Eigen::Vector2d from_eye = p - eye_;
    const double range = range_towards(from_eye);
    return range > 0 && length(from_eye.x(), from_eye.y()) < range + behind_m;
}

void FreeSpace::confront(const Node &other, const Pose &pose, Contradiction *sum) const
{
    const Eigen::Matrix2d r = rotation(pose.theta);
    const Eigen::Vector2d t = Eigen::Vector2d(pose.x, pose.y) - eye_;
    for (const SurfacePoint &point : other.points) {
        const Eigen::Vector2d from_eye = r * point.p + t;
        const double distance = length(from_eye.x(), from_eye.y());
        const double range = range_towards(from_eye);
        if (range > 0 && distance < range + behind_m) {
            sum->points++;
            sum->in_free += distance < range - before_m - before_by_range * distance ? 1 : 0;
        }
    }
}

} // namespace ale
