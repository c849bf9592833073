// Twins in double of the planar motion used by lib/track: poses, arcs, and the least-squares pose of walls.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace reference
{
constexpr double pi = 3.14159265358979323846;

// x, y in metres, heading in radians.
using Pose = Eigen::Vector3d;

inline Eigen::Matrix2d rotation(double a)
{
    Eigen::Matrix2d r;
    r << std::cos(a), -std::sin(a), std::sin(a), std::cos(a);
    return r;
}

inline Pose compose(const Pose &a, const Pose &b)
{
    const Eigen::Vector2d p = a.head<2>() + rotation(a[2]) * b.head<2>();
    return {p[0], p[1], a[2] + b[2]};
}

inline Pose inverse(const Pose &a)
{
    const Eigen::Vector2d p = -(rotation(-a[2]) * a.head<2>());
    return {p[0], p[1], -a[2]};
}

inline double wrap(double a)
{
    return std::remainder(a, 2 * pi);
}

// Exponential map: the exact motion of a constant body velocity (vx, vy, omega) over t seconds.
inline Pose sweep(const Eigen::Vector3d &v, double t)
{
    const double a = v[2] * t;
    const double s = std::abs(a) < 1e-9 ? 1 - a * a / 6 : std::sin(a) / a;
    const double c = std::abs(a) < 1e-9 ? a / 2 : (1 - std::cos(a)) / a;
    return {(s * v[0] - c * v[1]) * t, (c * v[0] + s * v[1]) * t, a};
}

// A wall measurement: normal and centre seen from the robot, and the wall's normal and a point on it.
struct WallPair {
    Eigen::Vector2d centre; // robot's frame
    double angle;           // of the view's normal, robot's frame
    double var_offset;      // sum of view and wall
    double var_angle;
    Eigen::Vector2d anchor; // map
    double wall_angle;
};

// Pose by Gauss-Newton on all pairs together with a prediction: the twin of ale_register_scan without
// velocity.
inline Pose refine(const Pose &predicted, const Eigen::Matrix3d &cov, const std::vector<WallPair> &pairs)
{
    Pose x = predicted;
    for (int k = 0; k < 20; k++) {
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        for (const WallPair &p : pairs) {
            const Eigen::Vector2d n(std::cos(p.wall_angle), std::sin(p.wall_angle));
            const Eigen::Vector2d nr = rotation(-x[2]) * n;
            const double e = n.dot(x.head<2>() + rotation(x[2]) * p.centre - p.anchor);
            const Eigen::Vector3d j(nr[0], nr[1], p.centre[0] * nr[1] - p.centre[1] * nr[0]);
            const Eigen::Vector3d turn(0, 0, 1);
            a += j * j.transpose() / p.var_offset + turn * turn.transpose() / p.var_angle;
            g -= j * e / p.var_offset + turn * wrap(p.angle + x[2] - p.wall_angle) / p.var_angle;
        }
        const Pose off = compose(inverse(predicted), x);
        const Eigen::Vector3d error(off[0], off[1], wrap(off[2]));
        const Eigen::Vector3d step = (a + cov.inverse()).ldlt().solve(g - cov.inverse() * error);
        x = compose(x, step);
    }
    return x;
}
} // namespace reference
