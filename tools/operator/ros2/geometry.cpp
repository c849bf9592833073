#include "operator/ros2/geometry.h"

#include <cmath>

namespace ros2
{

namespace
{

constexpr int64_t million = 1000000;

} // namespace

Pose2 compose(const Pose2 &a, const Pose2 &b)
{
    const double c = std::cos(a.theta);
    const double s = std::sin(a.theta);
    return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y,
            std::remainder(a.theta + b.theta, 2 * std::acos(-1.0))};
}

Pose2 inverse(const Pose2 &a)
{
    const double c = std::cos(a.theta);
    const double s = std::sin(a.theta);
    return {-c * a.x - s * a.y, s * a.x - c * a.y, -a.theta};
}

builtin_interfaces_msg_dds__Time_ ros_time(int64_t utime_us)
{
    const int64_t seconds = utime_us / million - (utime_us % million < 0);
    return {static_cast<int32_t>(seconds), static_cast<uint32_t>((utime_us - seconds * million) * 1000)};
}

geometry_msgs_msg_dds__Quaternion_ ros_turn(double theta)
{
    return {0, 0, std::sin(theta / 2), std::cos(theta / 2)};
}

geometry_msgs_msg_dds__Pose_ ros_pose(const Pose2 &pose)
{
    return {{pose.x, pose.y, 0}, ros_turn(pose.theta)};
}

geometry_msgs_msg_dds__TransformStamped_ ros_transform(int64_t utime_us, std::string &frame,
                                                       std::string &child, const Pose2 &pose)
{
    return {{ros_time(utime_us), frame.data()}, child.data(), {{pose.x, pose.y, 0}, ros_turn(pose.theta)}};
}

std::optional<double> heading_of(const geometry_msgs_msg_dds__Quaternion_ &turn)
{
    constexpr double most_tilt = 0.02;
    constexpr double most_off = 0.05;
    const double length = std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w);
    if (!(std::fabs(length - 1) < most_off) || std::hypot(turn.x, turn.y) > most_tilt) {
        return std::nullopt;
    }
    return 2 * std::atan2(turn.z, turn.w);
}

} // namespace ros2
