#include "lab/sim/world/ray_cast.h"

namespace sim
{

namespace
{

/* While a scan is taken the robot moves: walls a little beyond the reach of its centre count as near. */
constexpr double margin = 1.0;

} // namespace

Hit nearer(const Hit &hit, const Pose &beam, const Circle &circle, int surface)
{
    const double c = std::cos(beam.theta);
    const double s = std::sin(beam.theta);
    const double x = circle.centre.x - beam.x;
    const double y = circle.centre.y - beam.y;
    const double ahead = c * x + s * y;
    const double beside = c * y - s * x;
    const double depth2 = circle.radius * circle.radius - beside * beside;
    if (depth2 <= 0) {
        return hit;
    }
    const double range = ahead - std::sqrt(depth2);
    if (range <= 0 || range >= hit.range) {
        return hit;
    }
    return {range, surface, std::sqrt(depth2) / circle.radius};
}

Surroundings::Surroundings(const std::vector<Wall> &walls, Point centre, double reach) : reach_(reach)
{
    for (size_t k = 0; k < walls.size(); k++) {
        if (distance_to_wall(centre, walls[k]) <= reach + margin) {
            near_.push_back({walls[k], static_cast<int>(k)});
        }
    }
}

Hit Surroundings::cast(const Pose &beam) const
{
    const double c = std::cos(beam.theta);
    const double s = std::sin(beam.theta);
    Hit hit;
    hit.range = reach_;
    for (const Near &near : near_) {
        const double ax = near.wall.a.x - beam.x;
        const double ay = near.wall.a.y - beam.y;
        const double dx = near.wall.b.x - near.wall.a.x;
        const double dy = near.wall.b.y - near.wall.a.y;
        const double cross = c * dy - s * dx;
        if (cross == 0) {
            continue;
        }
        const double range = (ax * dy - ay * dx) / cross;
        const double along = (ax * s - ay * c) / cross;
        if (range > 0 && range < hit.range && along >= 0 && along <= 1) {
            hit.range = range;
            hit.surface = near.index;
            hit.cos_incidence = std::fabs(cross) / std::hypot(dx, dy);
        }
    }
    return hit;
}

} // namespace sim
