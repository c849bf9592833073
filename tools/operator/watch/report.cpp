#include "operator/watch/report.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "common/export/formatted.h"
#include "common/export/map_image.h"
#include "common/export/text_file.h"
#include "common/export/trajectory.h"
#include "common/feed/core_types.h"

namespace watch
{

namespace
{

constexpr double degrees_per_radian = 57.29577951308232;
constexpr std::array<const char *, stage_count> stage_names = {"deskew", "smooth", "extract", "match", "map"};
constexpr std::array<const char *, 3> state_names = {"LOST", "weak", "good"};

std::string seen(const RobotState &robot)
{
    const int lines = robot.features ? robot.features->num_lines : 0;
    const int corners = robot.features ? robot.features->num_corners : 0;
    return ale::formatted("lines %2d corners %2d  map %3zu", lines, corners, robot.map.lines.size());
}

std::string worst_stage(const PoseCounts &counts)
{
    const auto &worst = counts.worst_stage_ns;
    const auto largest = std::max_element(worst.begin(), worst.end());
    return ale::formatted("worst %s %.2f ms", stage_names[static_cast<size_t>(largest - worst.begin())],
                          *largest / 1e6);
}

std::string latency(const RobotState &robot)
{
    return robot.status ? ale::formatted("latency %.2f ms", robot.status->latency_p50_us / 1e3) : "latency -";
}

/* In the robot's own words. */
std::string exploration(const RobotState &robot)
{
    const bool explores = robot.status && !robot.status->exploration.empty();
    return explores ? "  " + robot.status->exploration : "";
}

/* What is not as it should be, with its mark before each. */
std::string trouble(const RobotState &robot)
{
    const std::string maps = robot.map_trouble();
    const std::string wheels = robot.wheel_trouble();
    return (maps.empty() ? "" : "  " + maps) + (wheels.empty() ? "" : "  wheels: " + wheels);
}

} // namespace

std::string status_line(const Record &record, double elapsed_s, double silent_s)
{
    const RobotState &robot = record.newest();
    const PoseCounts &counts = record.counts();
    if (!robot.pose) {
        return ale::formatted("%5.0f s  poses %5d  none yet", elapsed_s, 0);
    }
    const ale::pose_t &pose = *robot.pose;
    const double heading_deg =
        std::remainder(static_cast<double>(pose.map_theta) * degrees_per_radian, 360.0);
    return ale::formatted("%5.0f s  poses %5" PRId64 "  %s  ", elapsed_s, counts.received,
                          state_names[static_cast<unsigned char>(pose.state)]) +
           ale::formatted("x %7.3f y %7.3f heading %6.1f  ", static_cast<double>(pose.map_x),
                          static_cast<double>(pose.map_y), heading_deg) +
           seen(robot) + "  " + worst_stage(counts) + "  " +
           ale::formatted("dropped %" PRId64 "  ", counts.predicted + counts.missing) + latency(robot) +
           trouble(robot) + exploration(robot) +
           (silent_s >= 1 ? ale::formatted("  SILENT for %.0f s", silent_s) : "");
}

std::string summary_line(const Record &record)
{
    const PoseCounts &counts = record.counts();
    return ale::formatted("%" PRId64 " poses, %" PRId64 " missing, %" PRId64 " predicted; ", counts.received,
                          counts.missing, counts.predicted) +
           ale::formatted("good %" PRId64 ", weak %" PRId64 ", lost %" PRId64 "; ", counts.in_state[2],
                          counts.in_state[1], counts.in_state[0]) +
           ale::formatted("%" PRIu64 " malformed messages", record.newest().malformed);
}

void write_picture(const Record &record, const std::string &path)
{
    const auto map = feed::core_map(record.newest().map, record.newest().pieces);
    ale::MapScene scene;
    scene.map = map.get();
    scene.trajectory = record.trajectory();
    scene.cloud = &record.cloud();
    scene.draw_points = true;
    write_map_image(path, scene);
}

void write_trajectory(const Record &record, const std::string &path)
{
    ale::TextFile file(path);
    for (const ale::StampedPose &pose : record.trajectory()) {
        put_tum_line(file, pose);
    }
    file.close();
}

void write_csv(const Record &record, const std::string &path)
{
    ale::TextFile file(path);
    file.put("utime,scan,state,predicted,x,y,theta,map_x,map_y,map_theta,lines,corners,age_us,latency_us,"
             "deskew_ns,"
             "smooth_ns,extract_ns,match_ns,map_ns\n");
    for (const PoseRow &row : record.history()) {
        const ale::pose_t &pose = row.pose;
        file.put_integer(pose.utime).put(",").put_integer(pose.scan);
        file.put(",").put_integer(pose.state).put(",").put_integer(pose.predicted != 0 ? 1 : 0);
        for (const float value : {pose.x, pose.y, pose.theta, pose.map_x, pose.map_y, pose.map_theta}) {
            file.put(",").put_decimal(std::llround(static_cast<double>(value) * 1e6), 6);
        }
        file.put(",").put_integer(row.lines).put(",").put_integer(row.corners);
        file.put(",").put_integer(pose.age_us);
        file.put(",").put_integer(pose.utime + pose.age_us - pose.arrival_utime);
        for (const int32_t stage_ns : pose.stage_ns) {
            file.put(",").put_integer(stage_ns);
        }
        file.put("\n");
    }
    file.close();
}

} // namespace watch
