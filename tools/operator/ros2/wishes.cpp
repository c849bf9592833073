#include "operator/ros2/wishes.h"

#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "operator/ros2/frames.h"
#include "operator/ros2/geometry.h"

namespace ros2
{

namespace
{

constexpr double most = 2000; /* metres, metres a second, radians a second: of no robot */

Wish refused(const std::string &why)
{
    return {{}, why};
}

Wish command(const char *verb, std::initializer_list<double> values)
{
    Wish wish{{verb}, ""};
    for (const double value : values) {
        if (!(std::fabs(value) < most)) {
            return refused("a number out of this world");
        }
        char word[32];
        std::snprintf(word, sizeof word, "%.6f", value);
        wish.words.emplace_back(word);
    }
    return wish;
}

/* What somebody's message calls it, as printable ASCII. */
std::string printable(const char *name)
{
    constexpr size_t most_letters = 32;
    std::string out;
    for (; name && *name != '\0' && out.size() < most_letters; name++) {
        out += *name >= ' ' && *name <= '~' ? *name : '?';
    }
    return out;
}

/* Why it is no pose in the map; empty: it is one. */
std::string doubt(const char *frame, const geometry_msgs_msg_dds__Pose_ &pose)
{
    const std::string name = printable(frame && frame[0] == '/' ? frame + 1 : frame);
    if (name != map_frame) {
        return "a pose in the frame \"" + name + "\": only those in \"map\" are understood";
    }
    return heading_of(pose.orientation) ? "" : "an orientation that is no heading";
}

} // namespace

Wish wish_of(const geometry_msgs_msg_dds__PoseWithCovarianceStamped_ &pose)
{
    const geometry_msgs_msg_dds__Pose_ &at = pose.pose.pose;
    const std::string why = doubt(pose.header.frame_id, at);
    return why.empty() ? command("relocate", {at.position.x, at.position.y, *heading_of(at.orientation)})
                       : refused(why);
}

Wish wish_of(const geometry_msgs_msg_dds__PoseStamped_ &pose)
{
    const std::string why = doubt(pose.header.frame_id, pose.pose);
    return why.empty() ? command("goto", {pose.pose.position.x, pose.pose.position.y}) : refused(why);
}

Wish wish_of(const geometry_msgs_msg_dds__Twist_ &twist)
{
    constexpr double most_sideways = 0.001;
    if (!(std::fabs(twist.linear.y) < most_sideways)) {
        return refused("this robot does not go sideways (linear.y)");
    }
    return command("drive", {twist.linear.x, twist.angular.z});
}

} // namespace ros2
