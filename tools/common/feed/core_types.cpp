#include "common/feed/core_types.h"

#include <algorithm>
#include <cmath>

extern "C" {
#include "lcm/convert.h"
}

namespace feed
{

namespace
{

ale_point_t core_point(float x, float y)
{
    return {ale_from_metres(static_cast<double>(x)), ale_from_metres(static_cast<double>(y))};
}

/* The driver's own flag is carried as 0x80 | flag; a code below is the device's. */
constexpr unsigned flag_mark = 0x80;

uint8_t beam_flag(unsigned code)
{
    if (code >= flag_mark) {
        return static_cast<uint8_t>(code - flag_mark);
    }
    return code == 0 ? ALE_BEAM_VALID : ALE_BEAM_UNKNOWN;
}

ale_map_line_t core_line(const ale::map_line_t &line)
{
    ale_map_line_t out{};
    out.id = static_cast<uint32_t>(line.id);
    out.start = core_point(line.x1, line.y1);
    out.end = core_point(line.x2, line.y2);
    out.seen = static_cast<uint32_t>(std::max(0, line.seen));
    return out;
}

ale_map_corner_t core_corner(const ale::corner_t &corner)
{
    ale_map_corner_t out{};
    out.p = core_point(corner.x, corner.y);
    out.angle_bam = ale_from_radians(static_cast<double>(corner.angle));
    out.kind = static_cast<uint8_t>(corner.kind);
    return out;
}

} // namespace

ale_pose_t core_pose(float x, float y, float theta)
{
    const ale_point_t point = core_point(x, y);
    return {point.x_um, point.y_um, ale_from_radians(static_cast<double>(theta))};
}

ale::ScanPose core_scan_pose(const ale::pose_t &pose)
{
    ale::ScanPose out{};
    out.stamp_us = pose.utime;
    out.robot = core_pose(pose.map_x, pose.map_y, pose.map_theta);
    out.velocity_x_um_s = ale_from_metres(static_cast<double>(pose.vx));
    out.velocity_y_um_s = ale_from_metres(static_cast<double>(pose.vy));
    out.velocity_theta_urad_s = ale_from_metres(static_cast<double>(pose.omega));
    out.measured = pose.predicted == 0;
    return out;
}

std::unique_ptr<ale_scan_t> core_scan(const ale::scan_t &scan)
{
    auto out = std::make_unique<ale_scan_t>();
    out->stamp_us = scan.utime;
    out->stamp_beam = scan.stamp_beam;
    out->beam_time_ns = static_cast<int32_t>(std::lround(scan.beam_time_us * 1000));
    out->first_bearing_bam = ale_from_radians(static_cast<double>(scan.first_bearing));
    out->step_bam = static_cast<int32_t>(ale_from_radians(static_cast<double>(scan.step)));
    out->range_min_um = ale_from_metres(static_cast<double>(scan.range_min));
    out->range_max_um = ale_from_metres(static_cast<double>(scan.range_max));
    out->beams = static_cast<uint16_t>(scan.num_ranges);
    for (size_t k = 0; k < out->beams; k++) {
        const unsigned code = scan.codes[k];
        const int64_t range_mm = static_cast<int64_t>(scan.range_mm[k]) * scan.range_unit_mm;
        const int64_t range_um = std::clamp<int64_t>(range_mm * 1000, 0, ALE_MAX_RANGE_UM);
        out->range_um[k] = code == 0 ? static_cast<int32_t>(range_um) : 0;
        out->flag[k] = beam_flag(code);
    }
    return out;
}

std::unique_ptr<ale_map_t> core_map(const ale::map_t &map, const MapPieces &pieces)
{
    auto out = std::make_unique<ale_map_t>();
    out->version = static_cast<uint32_t>(map.version);
    out->line_count = static_cast<uint16_t>(std::min<size_t>(map.lines.size(), ALE_MAP_MAX_LINES));
    out->corner_count = static_cast<uint16_t>(std::min<size_t>(map.corners.size(), ALE_MAP_MAX_CORNERS));
    for (size_t k = 0; k < out->line_count; k++) {
        out->line[k] = core_line(map.lines[k]);
        out->line[k].map_id = static_cast<uint32_t>(pieces.map_of(map.version, map.lines[k].id));
    }
    std::transform(map.corners.begin(), map.corners.begin() + out->corner_count, out->corner, core_corner);
    return out;
}

} // namespace feed
