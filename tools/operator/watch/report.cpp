#include "operator/watch/report.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "common/export/formatted.h"
#include "common/export/text_file.h"
#include "common/export/trajectory.h"

namespace watch
{

namespace
{

constexpr double degrees_per_radian = 57.29577951308232;
constexpr std::array<const char *, stage_count> stage_names = {"deskew", "smooth", "extract", "match", "map"};
constexpr std::array<const char *, 3> state_names = {"LOST", "weak", "good"};

std::string seen(const Record &record)
{
    const auto walls = record.map() ? record.map()->lines.size() : 0;
    return ale::formatted("lines %2d corners %2d  map %3zu", record.lines(), record.corners(), walls);
}

std::string worst_stage(const Record &record)
{
    const auto &worst = record.worst_stage_ns();
    const auto largest = std::max_element(worst.begin(), worst.end());
    return ale::formatted("worst %s %.2f ms", stage_names[static_cast<size_t>(largest - worst.begin())],
                          *largest / 1e6);
}

std::string latency(const Record &record)
{
    return record.status() ? ale::formatted("latency %.2f ms", record.status()->latency_p50_us / 1e3)
                           : "latency -";
}

/* What the robot does by itself, in its own words. */
std::string by_itself(const Record &record)
{
    const bool says = record.status() && !record.status()->exploration.empty();
    return says ? "  " + record.status()->exploration : "";
}

} // namespace

std::string status_line(const Record &record, double elapsed_s, double silent_s)
{
    if (record.poses().empty()) {
        return ale::formatted("%5.0f s  poses %5d  none yet", elapsed_s, 0);
    }
    const ale::pose_t &pose = record.poses().back().pose;
    const double heading_deg =
        std::remainder(static_cast<double>(pose.map_theta) * degrees_per_radian, 360.0);
    return ale::formatted("%5.0f s  poses %5zu  %s  ", elapsed_s, record.poses().size(),
                          state_names[static_cast<unsigned char>(pose.state)]) +
           ale::formatted("x %7.3f y %7.3f heading %6.1f  ", static_cast<double>(pose.map_x),
                          static_cast<double>(pose.map_y), heading_deg) +
           seen(record) + "  " + worst_stage(record) + "  " +
           ale::formatted("dropped %" PRId64 "  ", record.predicted() + record.missing()) + latency(record) +
           by_itself(record) + (silent_s >= 1 ? ale::formatted("  SILENT for %.0f s", silent_s) : "");
}

std::string summary_line(const Record &record, uint64_t malformed)
{
    return ale::formatted("%zu poses, %" PRId64 " missing, %" PRId64 " predicted; ", record.poses().size(),
                          record.missing(), record.predicted()) +
           ale::formatted("good %" PRId64 ", weak %" PRId64 ", lost %" PRId64 "; ", record.in_state(2),
                          record.in_state(1), record.in_state(0)) +
           ale::formatted("%" PRIu64 " malformed messages", malformed);
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
    for (const PoseRow &row : record.poses()) {
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
