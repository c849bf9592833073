// Poses of the plane in double precision for the mapper: metres and radians. O(1), nothing here throws.
//
// Trigonometry comes from lib/base, not from the machine's mathematics library, so that the mapper's results
// are the same bytes everywhere (a BAM is 1.5e-9 rad).
#ifndef ALE_GRAPH_OPTIMISE_SE2_H
#define ALE_GRAPH_OPTIMISE_SE2_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

extern "C" {
#include "base/pose.h"
#include "base/trig.h"
}

namespace ale
{

constexpr double pi = 3.14159265358979323846;
constexpr double bam_per_radian = 2147483648.0 / pi;
constexpr double one_q30 = 1073741824.0;

inline uint32_t to_bam(double radians)
{
    return static_cast<uint32_t>(static_cast<int64_t>(std::nearbyint(radians * bam_per_radian)));
}

inline double cosine(double radians)
{
    return ale_cos_q30(to_bam(radians)) / one_q30;
}

inline double sine(double radians)
{
    return ale_sin_q30(to_bam(radians)) / one_q30;
}

// A BAM as an angle in -pi..pi.
inline double to_radians(uint32_t bam)
{
    return static_cast<int32_t>(bam) / bam_per_radian;
}

inline Eigen::Vector2d to_metres(ale_point_t p)
{
    return {p.x_um * 1e-6, p.y_um * 1e-6};
}

// The angle in -pi..pi.
inline double wrapped(double radians)
{
    return radians - 2 * pi * std::nearbyint(radians / (2 * pi));
}

// Length of a vector. Not std::hypot: its last digit differs between mathematics libraries.
inline double length(double x, double y)
{
    return std::sqrt(x * x + y * y);
}

// Direction of a vector of at most some 10^9 units, -pi..pi.
inline double angle_of(const Eigen::Vector2d &v)
{
    const auto fixed = [](double value) { return static_cast<int64_t>(std::nearbyint(value * 1e9)); };
    return to_radians(ale_atan2_bam(fixed(v.y()), fixed(v.x())));
}

// A pose maps points of its own frame to the frame it is given in.
struct Pose {
    double x = 0;
    double y = 0;
    double theta = 0;
};

inline Eigen::Matrix2d rotation(double theta)
{
    const double c = cosine(theta);
    const double s = sine(theta);
    Eigen::Matrix2d r;
    r << c, -s, s, c;
    return r;
}

inline Eigen::Vector2d apply(const Pose &pose, const Eigen::Vector2d &point)
{
    return rotation(pose.theta) * point + Eigen::Vector2d(pose.x, pose.y);
}

inline Pose compose(const Pose &a, const Pose &b)
{
    const Eigen::Vector2d p = apply(a, {b.x, b.y});
    return {p.x(), p.y(), wrapped(a.theta + b.theta)};
}

inline Pose inverse(const Pose &a)
{
    const Eigen::Vector2d p = rotation(-a.theta) * Eigen::Vector2d(-a.x, -a.y);
    return {p.x(), p.y(), -a.theta};
}

// b as seen from a.
inline Pose between(const Pose &a, const Pose &b)
{
    const Eigen::Vector2d p = rotation(-a.theta) * Eigen::Vector2d(b.x - a.x, b.y - a.y);
    return {p.x(), p.y(), wrapped(b.theta - a.theta)};
}

// Element k of a list that is numbered with int, as the poses of a graph are; k must be in the list.
template <class T> const T &at(const std::vector<T> &list, int k)
{
    return list[static_cast<size_t>(k)];
}

// Pose b of a list as seen from pose a.
inline Pose between(const std::vector<Pose> &poses, int a, int b)
{
    return between(at(poses, a), at(poses, b));
}

inline Pose from_core(const ale_pose_t &pose)
{
    return {pose.x_um * 1e-6, pose.y_um * 1e-6, to_radians(pose.theta_bam)};
}

// Rounded to the core's units: here floating point ends.
inline ale_pose_t to_core(const Pose &pose)
{
    return {static_cast<int32_t>(std::nearbyint(pose.x * 1e6)),
            static_cast<int32_t>(std::nearbyint(pose.y * 1e6)), to_bam(pose.theta)};
}

} // namespace ale

#endif
