#include "graph/optimise/thinning.h"

namespace ale
{

namespace
{

// Keyframes this far apart share little of their views; a radian counts as a metre, as it does when keyframes
// are taken.
constexpr double common_view_m = 2.0;
constexpr double metres_per_radian = 1.0;

// Shared part of two views: 1 at the same pose, 0 beyond common_view_m.
double common_view(const Pose &a, const Pose &b)
{
    const double dx = std::abs(a.x - b.x);
    const double dy = std::abs(a.y - b.y);
    if (dx > common_view_m || dy > common_view_m) {
        return 0;
    }
    const double apart = length(dx, dy) + metres_per_radian * std::abs(wrapped(a.theta - b.theta));
    return std::max(0.0, 1 - apart / common_view_m);
}

std::vector<double> densities(const std::vector<Pose> &poses)
{
    std::vector<double> density(poses.size(), 0);
    for (size_t i = 0; i < poses.size(); i++) {
        for (size_t k = i + 1; k < poses.size(); k++) {
            const double common = common_view(poses[i], poses[k]);
            density[i] += common;
            density[k] += common;
        }
    }
    return density;
}

} // namespace

std::optional<size_t> most_redundant(const std::vector<Pose> &poses, const std::vector<bool> &removable)
{
    const std::vector<double> density = densities(poses);
    std::optional<size_t> best;
    for (size_t k = 0; k < poses.size(); k++) {
        if (removable[k] && (!best || density[k] > density[*best])) {
            best = k;
        }
    }
    return best;
}

} // namespace ale
