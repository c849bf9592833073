// Plane geometry of the benchmark, in metres and radians, double precision.
#pragma once

#include <cmath>
#include <Eigen/Core>

namespace bench
{

using Point = Eigen::Vector2d;

constexpr double pi = 3.14159265358979323846;

constexpr double radians(double degrees)
{
    return degrees * pi / 180;
}

// Angle in -pi..pi.
inline double wrapped(double angle)
{
    return std::remainder(angle, 2 * pi);
}

inline double cross(const Point &a, const Point &b)
{
    return a.x() * b.y() - a.y() * b.x();
}

inline Point direction(double angle)
{
    return {std::cos(angle), std::sin(angle)};
}

// A line in normal form, x cos(alpha) + y sin(alpha) = rho.
struct NormalForm {
    double alpha = 0;
    double rho = 0;

    Point normal() const
    {
        return direction(alpha);
    }
    Point tangent() const
    {
        return {-std::sin(alpha), std::cos(alpha)};
    }
    double distance(const Point &p) const
    {
        return normal().dot(p) - rho;
    }
    Point foot(const Point &p) const
    {
        return p - distance(p) * normal();
    }
};

// The line through two points, rho >= 0.
inline NormalForm line_through(const Point &a, const Point &b)
{
    const Point d = b - a;
    NormalForm line;
    line.alpha = std::atan2(d.x(), -d.y());
    line.rho = line.normal().dot(a);
    if (line.rho < 0) {
        line.alpha = wrapped(line.alpha + pi);
        line.rho = -line.rho;
    }
    return line;
}

} // namespace bench
