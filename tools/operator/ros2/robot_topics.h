/* What the robot publishes, on the topics of ROS 2: one call a message of LCM, checked before
 * (feed/checks.h).
 *
 *   /scan /odom /pose /tf /tf_static /map /ale/lines /ale/walls /ale/graph /ale/plan
 *
 * map -> odom goes out while the robot is in its first map only: in another one, which is not joined with it
 * yet, nobody knows where in `map` it is. One thread. */
#ifndef ROS2_ROBOT_TOPICS_H
#define ROS2_ROBOT_TOPICS_H

#include <array>
#include <optional>
#include <vector>

#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/export/occupancy_grid.h"
#include "common/feed/map_pieces.h"
#include "nav_msgs.h"
#include "operator/ros2/dds.h"
#include "operator/ros2/markers.h"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace ros2
{

class RobotTopics
{
  public:
    explicit RobotTopics(const Participant &participant);

    void send(const ale::scan_t &scan);
    void send(const ale::pose_t &pose);
    void send(const ale::tracking_t &tracking);
    void send(const ale::features_t &features);
    /* A whole map. */
    void send(const ale::map_t &map, const feed::MapPieces &pieces);
    void send(const ale::graph_t &graph);
    void send(const ale::plan_t &plan);
    void send(const ale::OccupancyGrid &grid, int64_t utime);

    /* Messages that a reliable reader was too slow for. */
    uint64_t lost() const
    {
        return lost_;
    }

  private:
    template <class Message> void write(Writer<Message> &writer, const Message &message)
    {
        lost_ += writer.write(message) ? 0 : 1;
    }
    void send_drawings(Writer<visualization_msgs_msg_dds__MarkerArray_> &writer,
                       std::vector<Drawing> &drawings, const Shown &shown, const char *frame_name);
    void send_mounting(int64_t utime, const std::array<float, 3> &mounting);

    Writer<sensor_msgs_msg_dds__LaserScan_> scan_;
    Writer<nav_msgs_msg_dds__Odometry_> odom_;
    Writer<geometry_msgs_msg_dds__PoseWithCovarianceStamped_> pose_;
    Writer<tf2_msgs_msg_dds__TFMessage_> tf_;
    Writer<tf2_msgs_msg_dds__TFMessage_> tf_static_;
    Writer<nav_msgs_msg_dds__OccupancyGrid_> map_;
    Writer<visualization_msgs_msg_dds__MarkerArray_> lines_;
    Writer<visualization_msgs_msg_dds__MarkerArray_> walls_;
    Writer<visualization_msgs_msg_dds__MarkerArray_> graph_;
    Writer<visualization_msgs_msg_dds__MarkerArray_> plan_;
    std::optional<ale::pose_t> newest_;
    std::optional<ale::scan_t> before_;
    std::optional<std::array<float, 3>> mounting_; /* as it was sent last */
    uint64_t lost_ = 0;
};

} // namespace ros2

#endif
