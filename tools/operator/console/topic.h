/* What the board shows: the kinds of messages, and a point of the robot's way. */
#ifndef CONSOLE_TOPIC_H
#define CONSOLE_TOPIC_H

#include <cstddef>

namespace console
{

enum class Topic { pose, tracking, features, scan, map, graph, plan, odometry, status };
constexpr size_t topic_count = 9;

struct TrailPoint {
    float x;
    float y;
    bool first; /* no line from the point before: the pose jumped */
};

} // namespace console

#endif
