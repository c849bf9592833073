/* Names of the frames (REP 105). */
#ifndef ROS2_FRAMES_H
#define ROS2_FRAMES_H

namespace ros2
{

constexpr char map_frame[] = "map";
constexpr char odom_frame[] = "odom";
constexpr char robot_frame[] = "base_link";
constexpr char laser_frame[] = "laser";

} // namespace ros2

#endif
