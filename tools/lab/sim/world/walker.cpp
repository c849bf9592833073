#include "lab/sim/world/walker.h"

namespace sim
{

namespace
{

constexpr double step_m = 0.65;     /* from a heel to the next of the other foot */
constexpr double hip_half_m = 0.10; /* legs beside the way */

double length_of(const std::vector<Point> &path)
{
    double sum = 0;
    for (size_t k = 1; k < path.size(); k++) {
        sum += distance(path[k - 1], path[k]);
    }
    return sum;
}

/* The place so far along the path, and its direction. */
Pose along(const std::vector<Point> &path, double way_m)
{
    size_t k = 1;
    while (k + 1 < path.size() && way_m > distance(path[k - 1], path[k])) {
        way_m -= distance(path[k - 1], path[k]);
        k++;
    }
    const Point a = path[k - 1];
    const Point b = path[k];
    const double part = std::fmin(1, std::fmax(0, way_m / distance(a, b)));
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), std::atan2(b.y - a.y, b.x - a.x)};
}

/* How far a leg has come when its walker has come way_m: it stands for a step, and swings two in the next. */
double leg_in_step(double way_m, double phase)
{
    const double steps = way_m / step_m + phase;
    const double pair = 2 * std::floor(steps / 2);
    return (pair + 2 * std::fmax(0, steps - pair - 1) + 0.5 - phase) * step_m;
}

/* The same; the first and the last steps are shorter, so that both legs rest side by side. */
double leg_at(double way_m, double length_m, double phase)
{
    const double stride = std::fmin(1, std::fmin(way_m, length_m - way_m) / step_m);
    return way_m + stride * (leg_in_step(way_m, phase) - way_m);
}

} // namespace

std::array<Circle, 2> legs_of(const Walker &walker, double seconds)
{
    const double length_m = length_of(walker.path);
    const double leg_s = length_m / walker.speed_m_s + walker.rest_s; /* one way and the rest after it */
    const double in_turn_s = std::fmod(seconds, 2 * leg_s);
    const bool back = in_turn_s >= leg_s;
    const double way_m = std::fmin(length_m, (back ? in_turn_s - leg_s : in_turn_s) * walker.speed_m_s);
    std::array<Circle, 2> legs;
    for (size_t k = 0; k < legs.size(); k++) {
        const double leg_m = leg_at(way_m, length_m, static_cast<double>(k));
        const Pose hip = along(walker.path, back ? length_m - leg_m : leg_m);
        const Pose foot = compose(hip, {0, k == 0 ? hip_half_m : -hip_half_m, 0});
        legs[k] = {{foot.x, foot.y}, leg_radius_m};
    }
    return legs;
}

} // namespace sim
