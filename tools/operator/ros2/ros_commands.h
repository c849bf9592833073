/* Topics that ROS commands the robot by: /initialpose, /cmd_vel, /goal_pose.
 *
 *   RosCommands commands(participant, commander, stamped);
 *   commands.poll();                     25 times a second; of each topic the newest message counts
 *
 * What is refused is told on stderr, each reason once in a row, and counted. One thread. */
#ifndef ROS2_ROS_COMMANDS_H
#define ROS2_ROS_COMMANDS_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "geometry_msgs.h"
#include "operator/ros2/commander.h"
#include "operator/ros2/dds.h"
#include "operator/ros2/wishes.h"

namespace ros2
{

class RosCommands
{
  public:
    /* What became of the messages of a topic. */
    struct Topic {
        const char *name;
        uint64_t sent = 0;
        uint64_t refused = 0;
        std::string newest_refusal{};
        bool told = false; /* the newest refusal, on stderr */
    };
    enum Name { initialpose, cmd_vel, goal_pose };

    /* stamped: /cmd_vel is a TwistStamped. commander outlives this. */
    RosCommands(const Participant &participant, Commander &commander, bool stamped);

    void poll();

    const std::array<Topic, 3> &topics() const
    {
        return topics_;
    }

  private:
    void obey(Name name, const Wish &wish);
    void refuse(Name name, const std::string &why);
    void hear_answer();

    Commander &commander_;
    Reader<geometry_msgs_msg_dds__PoseWithCovarianceStamped_> initialpose_;
    Reader<geometry_msgs_msg_dds__PoseStamped_> goal_pose_;
    std::optional<Reader<geometry_msgs_msg_dds__Twist_>> twist_;
    std::optional<Reader<geometry_msgs_msg_dds__TwistStamped_>> stamped_twist_;
    std::array<Topic, 3> topics_{Topic{"/initialpose"}, Topic{"/cmd_vel"}, Topic{"/goal_pose"}};
    Name last_ = initialpose; /* who sent the last command */
};

} // namespace ros2

#endif
