/* Poses and times as ROS has them: metres, radians, x ahead, counter-clockwise (REP 103). Pure functions. */
#ifndef ROS2_GEOMETRY_H
#define ROS2_GEOMETRY_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry_msgs.h"

namespace ros2
{

struct Pose2 {
    double x;
    double y;
    double theta;
};

/* A sequence whose elements live elsewhere. */
template <class Sequence, class Element> Sequence sequence_of(std::vector<Element> &elements)
{
    Sequence out{};
    out._length = out._maximum = static_cast<uint32_t>(elements.size());
    out._buffer = elements.data();
    return out;
}

/* The pose that b is, seen from the frame that a is seen from. */
Pose2 compose(const Pose2 &a, const Pose2 &b);
/* The frame's origin as seen from a. */
Pose2 inverse(const Pose2 &a);

builtin_interfaces_msg_dds__Time_ ros_time(int64_t utime_us);
geometry_msgs_msg_dds__Pose_ ros_pose(const Pose2 &pose);
geometry_msgs_msg_dds__Quaternion_ ros_turn(double theta);

/* The message lives no longer than the names. */
geometry_msgs_msg_dds__TransformStamped_ ros_transform(int64_t utime_us, std::string &frame,
                                                       std::string &child, const Pose2 &pose);

/* The heading of a rotation about the vertical axis; nothing when it is no rotation or another one. */
std::optional<double> heading_of(const geometry_msgs_msg_dds__Quaternion_ &turn);

} // namespace ros2

#endif
