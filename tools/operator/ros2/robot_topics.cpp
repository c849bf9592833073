#include "operator/ros2/robot_topics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "operator/ros2/frames.h"
#include "operator/ros2/geometry.h"

extern "C" {
#include "base/scan.h"
}

namespace ros2
{

namespace
{

constexpr int32_t stream_depth = 10;
constexpr int32_t tf_depth = 100; /* as tf2's broadcaster */

std_msgs_msg_dds__Header_ header(int64_t utime, std::string &frame)
{
    return {ros_time(utime), frame.data()};
}

/* REP 117: nothing in reach, too near, no measurement. */
float without_range(unsigned code)
{
    constexpr unsigned flag_mark = 0x80;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    if (code == (flag_mark | ALE_BEAM_NO_RETURN)) {
        return infinity;
    }
    return code == (flag_mark | ALE_BEAM_TOO_NEAR) ? -infinity : std::numeric_limits<float>::quiet_NaN();
}

std::vector<float> ranges_of(const ale::scan_t &scan)
{
    constexpr float metre = 0.001F;
    const int unit_mm = std::max<int>(scan.range_unit_mm, 1);
    std::vector<float> ranges;
    for (size_t k = 0; k < scan.range_mm.size(); k++) {
        const unsigned code = scan.codes[k];
        const float range = static_cast<float>(int{scan.range_mm[k]} * unit_mm) * metre;
        ranges.push_back(code == 0 ? range : without_range(code));
    }
    return ranges;
}

/* From one scan to the next; 0 where it is not known. */
float period_of(const ale::scan_t &before, const ale::scan_t &scan)
{
    constexpr double most_us = 2e6;
    const double gap_us = static_cast<double>(scan.utime) - static_cast<double>(before.utime);
    const double scans = static_cast<double>(scan.scan) - before.scan;
    return scans >= 1 && gap_us > 0 && gap_us < most_us * scans ? static_cast<float>(gap_us / scans * 1e-6)
                                                                : 0.0F;
}

/* x, y, heading of three by three in the six by six of ROS. */
template <class Covariance> void put_covariance(const float (&from)[9], Covariance &to)
{
    constexpr std::array<size_t, 3> axis = {0, 1, 5};
    for (size_t row = 0; row < axis.size(); row++) {
        for (size_t column = 0; column < axis.size(); column++) {
            to[axis[row] * 6 + axis[column]] = static_cast<double>(from[row * 3 + column]);
        }
    }
}

Pose2 pose2(float x, float y, float theta)
{
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(theta)};
}

int8_t ros_cell(ale::OccupancyGrid::Cell cell)
{
    constexpr int8_t unknown = -1;
    constexpr int8_t occupied = 100;
    return cell == ale::OccupancyGrid::Cell::unknown ? unknown
           : cell == ale::OccupancyGrid::Cell::free  ? int8_t{0}
                                                     : occupied;
}

} // namespace

RobotTopics::RobotTopics(const Participant &participant)
    : scan_(participant, "scan", sensor_msgs_msg_dds__LaserScan__desc, Quality::stream, stream_depth),
      odom_(participant, "odom", nav_msgs_msg_dds__Odometry__desc, Quality::stream, stream_depth),
      pose_(participant, "pose", geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, Quality::stream,
            stream_depth),
      tf_(participant, "tf", tf2_msgs_msg_dds__TFMessage__desc, Quality::stream, tf_depth),
      tf_static_(participant, "tf_static", tf2_msgs_msg_dds__TFMessage__desc, Quality::latched, 1),
      map_(participant, "map", nav_msgs_msg_dds__OccupancyGrid__desc, Quality::latched, 1),
      lines_(participant, "ale/lines", visualization_msgs_msg_dds__MarkerArray__desc, Quality::stream,
             stream_depth),
      walls_(participant, "ale/walls", visualization_msgs_msg_dds__MarkerArray__desc, Quality::latched, 1),
      graph_(participant, "ale/graph", visualization_msgs_msg_dds__MarkerArray__desc, Quality::latched, 1),
      plan_(participant, "ale/plan", visualization_msgs_msg_dds__MarkerArray__desc, Quality::stream,
            stream_depth)
{
}

/* The stamp of a scan in ROS is that of its first beam. */
void RobotTopics::send(const ale::scan_t &scan)
{
    constexpr float second = 1e-6F;
    std::string frame = laser_frame;
    std::vector<float> ranges = ranges_of(scan);
    const double first_us = -static_cast<double>(scan.stamp_beam) * static_cast<double>(scan.beam_time_us);
    sensor_msgs_msg_dds__LaserScan_ out{};
    out.header = header(scan.utime + std::llround(first_us), frame);
    out.angle_min = scan.first_bearing;
    out.angle_max = scan.first_bearing + scan.step * static_cast<float>(std::max(scan.num_ranges - 1, 0));
    out.angle_increment = scan.step;
    out.time_increment = scan.beam_time_us * second;
    out.scan_time = before_ ? period_of(*before_, scan) : 0.0F;
    out.range_min = scan.range_min;
    out.range_max = scan.range_max;
    out.ranges = sequence_of<decltype(out.ranges)>(ranges);
    write(scan_, out);
    send_mounting(scan.utime, {scan.sensor_x, scan.sensor_y, scan.sensor_theta});
    before_ = scan;
}

void RobotTopics::send(const ale::pose_t &pose)
{
    std::string map = map_frame;
    std::string odom = odom_frame;
    std::string robot = robot_frame;
    const Pose2 smooth = pose2(pose.x, pose.y, pose.theta);
    nav_msgs_msg_dds__Odometry_ out{};
    out.header = header(pose.utime, odom);
    out.child_frame_id = robot.data();
    out.pose.pose = ros_pose(smooth);
    put_covariance(pose.cov, out.pose.covariance);
    out.twist.twist.linear = {static_cast<double>(pose.vx), static_cast<double>(pose.vy), 0};
    out.twist.twist.angular = {0, 0, static_cast<double>(pose.omega)};
    write(odom_, out);
    std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms = {
        ros_transform(pose.utime, odom, robot, smooth)};
    write(tf_, {sequence_of<decltype(tf2_msgs_msg_dds__TFMessage_::transforms)>(transforms)});
    newest_ = pose;
}

/* Which map the map pose is in comes behind the pose. */
void RobotTopics::send(const ale::tracking_t &tracking)
{
    if (!newest_ || tracking.scan != newest_->scan || tracking.map_id != 0) {
        return;
    }
    std::string map = map_frame;
    std::string odom = odom_frame;
    const ale::pose_t &pose = *newest_;
    const Pose2 in_map = pose2(pose.map_x, pose.map_y, pose.map_theta);
    const Pose2 correction = compose(in_map, inverse(pose2(pose.x, pose.y, pose.theta)));
    std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms = {
        ros_transform(pose.utime, map, odom, correction)};
    write(tf_, {sequence_of<decltype(tf2_msgs_msg_dds__TFMessage_::transforms)>(transforms)});
    geometry_msgs_msg_dds__PoseWithCovarianceStamped_ out{};
    out.header = header(pose.utime, map);
    out.pose.pose = ros_pose(in_map);
    put_covariance(pose.cov, out.pose.covariance);
    write(pose_, out);
}

void RobotTopics::send_mounting(int64_t utime, const std::array<float, 3> &mounting)
{
    if (mounting_ == mounting) {
        return;
    }
    std::string robot = robot_frame;
    std::string laser = laser_frame;
    std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms = {
        ros_transform(utime, robot, laser, pose2(mounting[0], mounting[1], mounting[2]))};
    write(tf_static_, {sequence_of<decltype(tf2_msgs_msg_dds__TFMessage_::transforms)>(transforms)});
    mounting_ = mounting;
}

void RobotTopics::send(const ale::features_t &features)
{
    constexpr int64_t half_a_second_us = 500000;
    std::vector<Drawing> drawings = drawings_of(features);
    send_drawings(lines_, drawings, {features.utime, half_a_second_us}, laser_frame);
    send_mounting(features.utime, {features.sensor_x, features.sensor_y, features.sensor_theta});
}

void RobotTopics::send(const ale::map_t &map, const feed::MapPieces &pieces)
{
    std::vector<Drawing> drawings = drawings_of(map, pieces);
    send_drawings(walls_, drawings, {map.utime, 0}, map_frame);
}

void RobotTopics::send(const ale::graph_t &graph)
{
    std::vector<Drawing> drawings = drawings_of(graph);
    send_drawings(graph_, drawings, {graph.utime, 0}, map_frame);
}

/* The robot repeats it every second while there is one. */
void RobotTopics::send(const ale::plan_t &plan)
{
    constexpr int64_t three_seconds_us = 3000000;
    std::vector<Drawing> drawings = drawings_of(plan);
    send_drawings(plan_, drawings, {plan.utime, three_seconds_us}, map_frame);
}

void RobotTopics::send_drawings(Writer<visualization_msgs_msg_dds__MarkerArray_> &writer,
                                std::vector<Drawing> &drawings, const Shown &shown, const char *frame_name)
{
    std::string frame = frame_name;
    std::vector<visualization_msgs_msg_dds__Marker_> markers = markers_of(drawings, shown, frame);
    write(writer, {sequence_of<decltype(visualization_msgs_msg_dds__MarkerArray_::markers)>(markers)});
}

void RobotTopics::send(const ale::OccupancyGrid &grid, int64_t utime)
{
    constexpr double metre = 1e-6;
    std::string frame = map_frame;
    std::vector<int8_t> cells;
    cells.reserve(static_cast<size_t>(grid.columns()) * static_cast<size_t>(grid.rows()));
    for (int32_t row = 0; row < grid.rows(); row++) {
        for (int32_t column = 0; column < grid.columns(); column++) {
            cells.push_back(ros_cell(grid.at(column, row)));
        }
    }
    nav_msgs_msg_dds__OccupancyGrid_ out{};
    out.header = header(utime, frame);
    out.info.map_load_time = ros_time(utime);
    out.info.resolution = static_cast<float>(grid.cell_um() * metre);
    out.info.width = static_cast<uint32_t>(grid.columns());
    out.info.height = static_cast<uint32_t>(grid.rows());
    out.info.origin = ros_pose(
        {static_cast<double>(grid.left_um()) * metre, static_cast<double>(grid.bottom_um()) * metre, 0});
    out.data = sequence_of<decltype(out.data)>(cells);
    write(map_, out);
}

} // namespace ros2
