/* What ROS asks of the robot, as commands that the robot knows (drivers/command). Pure functions.
 *
 *   /initialpose  -> relocate X Y THETA
 *   /cmd_vel      -> drive V W
 *   /goal_pose    -> goto X Y           (how it stands there is left to the robot) */
#ifndef ROS2_WISHES_H
#define ROS2_WISHES_H

#include <string>
#include <vector>

#include "geometry_msgs.h"

namespace ros2
{

/* The words of a command, or why there is none. */
struct Wish {
    std::vector<std::string> words;
    std::string refusal;
};

Wish wish_of(const geometry_msgs_msg_dds__PoseWithCovarianceStamped_ &pose);
Wish wish_of(const geometry_msgs_msg_dds__PoseStamped_ &pose);
Wish wish_of(const geometry_msgs_msg_dds__Twist_ &twist);

} // namespace ros2

#endif
