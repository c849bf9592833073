/* The plane of the simulated world, in metres and radians. Headings are not wrapped: a robot that has
 * turned twice has a heading of 4 pi, so poses can be interpolated. */
#ifndef ALE_LAB_SIM_GEOMETRY_H
#define ALE_LAB_SIM_GEOMETRY_H

#include <cmath>

namespace sim
{

constexpr double pi = 3.14159265358979323846;

struct Point {
    double x = 0;
    double y = 0;
};

struct Pose {
    double x = 0;
    double y = 0;
    double theta = 0;
};

struct Wall {
    Point a;
    Point b;
};

inline double distance(Point a, Point b)
{
    return std::hypot(a.x - b.x, a.y - b.y);
}

/* The pose b, given in the frame of a, in the frame a is given in. */
inline Pose compose(const Pose &a, const Pose &b)
{
    const double c = std::cos(a.theta);
    const double s = std::sin(a.theta);
    return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.theta + b.theta};
}

inline Pose interpolate(const Pose &a, const Pose &b, double u)
{
    return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), a.theta + u * (b.theta - a.theta)};
}

/* The angle in -pi..pi. */
inline double wrapped(double angle)
{
    return std::remainder(angle, 2 * pi);
}

inline double distance_to_wall(Point p, const Wall &wall)
{
    const double dx = wall.b.x - wall.a.x;
    const double dy = wall.b.y - wall.a.y;
    const double along = ((p.x - wall.a.x) * dx + (p.y - wall.a.y) * dy) / (dx * dx + dy * dy);
    const double u = std::fmin(1, std::fmax(0, along));
    return distance(p, {wall.a.x + u * dx, wall.a.y + u * dy});
}

} // namespace sim

#endif
