#include "operator/ros2/ros_commands.h"

#include <cstdio>
#include <stdexcept>

namespace ros2
{

RosCommands::RosCommands(const Participant &participant, Commander &commander, bool stamped)
    : commander_(commander),
      initialpose_(participant, "initialpose", geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, true),
      goal_pose_(participant, "goal_pose", geometry_msgs_msg_dds__PoseStamped__desc, true)
{
    if (stamped) {
        stamped_twist_.emplace(participant, "cmd_vel", geometry_msgs_msg_dds__TwistStamped__desc, false);
    } else {
        twist_.emplace(participant, "cmd_vel", geometry_msgs_msg_dds__Twist__desc, false);
    }
}

void RosCommands::refuse(Name name, const std::string &why)
{
    Topic &topic = topics_[name];
    topic.refused++;
    if (!topic.told || topic.newest_refusal != why) {
        std::fprintf(stderr, "ale-ros2: %s is refused: %s\n", topic.name, why.c_str());
        topic.newest_refusal = why;
        topic.told = true;
    }
}

void RosCommands::obey(Name name, const Wish &wish)
{
    std::string refusal = wish.refusal;
    if (refusal.empty()) {
        try {
            refusal = commander_.send(wish.words);
        } catch (const std::runtime_error &error) {
            refusal = error.what();
        }
    }
    if (!refusal.empty()) {
        refuse(name, refusal);
        return;
    }
    topics_[name].sent++;
    last_ = name;
}

/* A robot that obeys is told of once, and not at every set point. */
void RosCommands::hear_answer()
{
    const std::optional<Answer> answer = commander_.new_answer();
    if (!answer) {
        return;
    }
    if (!answer->obeyed) {
        refuse(last_, "the robot: " + answer->words);
        return;
    }
    topics_[last_].told = false;
    if (last_ != cmd_vel) {
        std::fprintf(stderr, "ale-ros2: %s: %s\n", topics_[last_].name, answer->words.c_str());
    }
}

void RosCommands::poll()
{
    initialpose_.newest([this](const auto &message) { obey(initialpose, wish_of(message)); });
    goal_pose_.newest([this](const auto &message) { obey(goal_pose, wish_of(message)); });
    if (twist_) {
        twist_->newest([this](const auto &message) { obey(cmd_vel, wish_of(message)); });
    }
    if (stamped_twist_) {
        stamped_twist_->newest([this](const auto &message) { obey(cmd_vel, wish_of(message.twist)); });
    }
    hear_answer();
}

} // namespace ros2
