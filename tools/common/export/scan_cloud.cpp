#include "common/export/scan_cloud.h"

#include <algorithm>
#include <cstdlib>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

constexpr int32_t point_cell_um = 20000;
constexpr int64_t million = 1000000;
/* Longer rays say little about what is free and cost much. */
constexpr int32_t longest_ray_um = 20000000;

int32_t floor_div(int32_t value, int32_t by)
{
    return value / by - (value % by < 0);
}

uint64_t key(int32_t column, int32_t row)
{
    return static_cast<uint64_t>(static_cast<uint32_t>(column)) << 32 | static_cast<uint32_t>(row);
}

/* Pose of the robot `offset_us` after its stamp. */
ale_pose_t moved(const ScanPose &pose, int32_t offset_us)
{
    const auto way = [offset_us](int32_t velocity) {
        return static_cast<int32_t>(ale_round_div(int64_t{velocity} * offset_us, million));
    };
    const int64_t turn_nrad = ale_round_div(int64_t{pose.velocity_theta_urad_s} * offset_us, 1000);
    const ale_pose_t step = {way(pose.velocity_x_um_s), way(pose.velocity_y_um_s),
                             static_cast<uint32_t>(ale_nrad_to_bam(turn_nrad))};
    return ale_pose_compose(pose.robot, step);
}

} // namespace

void ScanCloud::add(const ale_scan_t &scan, const ScanPose &pose, const ale_pose_t &sensor)
{
    if (!pose.measured) {
        return;
    }
    for (int32_t k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID) {
            const ale_pose_t robot = moved(pose, ale_scan_beam_offset_us(&scan, k));
            add_beam(ale_pose_compose(robot, sensor), scan.range_um[k], ale_scan_bearing(&scan, k));
        }
    }
}

void ScanCloud::add(const ale_seen_copy_t &seen, const ale_pose_t &sensor)
{
    for (int32_t k = 0; k < seen.scan.beams; k++) {
        if (seen.scan.flag[k] == ALE_BEAM_VALID) {
            const uint32_t bearing_bam =
                seen.straightened ? seen.bearing_bam[k] : ale_scan_bearing(&seen.scan, k);
            add_beam(sensor, seen.scan.range_um[k], bearing_bam);
        }
    }
}

void ScanCloud::add_beam(const ale_pose_t &laser, int32_t range_um, uint32_t bearing_bam)
{
    const ale_point_t end = ale_pose_apply(laser, ale_rotate({range_um, 0}, bearing_bam));
    include(extent_, end);
    if (keeps_points_) {
        add_point(end);
    }
    if (range_um <= longest_ray_um) {
        add_ray({laser.x_um, laser.y_um}, end);
    }
}

void ScanCloud::add_point(const ale_point_t &p)
{
    if (point_cells_.insert(key(floor_div(p.x_um, point_cell_um), floor_div(p.y_um, point_cell_um))).second) {
        points_.push_back(p);
    }
}

ScanCloud::Count &ScanCloud::count(int32_t column, int32_t row)
{
    const int32_t tile_column = floor_div(column, tile_side);
    const int32_t tile_row = floor_div(row, tile_side);
    Tile &tile = tiles_[key(tile_column, tile_row)];
    const int32_t within = (row - tile_row * tile_side) * tile_side + (column - tile_column * tile_side);
    return tile[static_cast<size_t>(within)];
}

/* One cell a step along the longer axis. */
void ScanCloud::add_ray(const ale_point_t &from, const ale_point_t &to)
{
    const auto saturate = [](uint16_t &value) {
        value = static_cast<uint16_t>(value + (value < UINT16_MAX));
    };
    const int64_t dx = int64_t{to.x_um} - from.x_um;
    const int64_t dy = int64_t{to.y_um} - from.y_um;
    const int64_t steps = std::max(std::abs(dx), std::abs(dy)) / cell_um_;
    const int32_t last_column = floor_div(to.x_um, cell_um_);
    const int32_t last_row = floor_div(to.y_um, cell_um_);
    for (int64_t i = 0; i < steps; i++) {
        const int32_t column = floor_div(static_cast<int32_t>(from.x_um + dx * i / steps), cell_um_);
        const int32_t row = floor_div(static_cast<int32_t>(from.y_um + dy * i / steps), cell_um_);
        if (column != last_column || row != last_row) {
            saturate(count(column, row).passed);
        }
    }
    saturate(count(last_column, last_row).ended);
}

ScanCloud::Cell ScanCloud::cell(int32_t column, int32_t row) const
{
    /* A wall seen at a grazing angle is passed by many beams and still a wall. */
    constexpr int passed_per_ended = 4;
    const int32_t tile_column = floor_div(column, tile_side);
    const int32_t tile_row = floor_div(row, tile_side);
    const auto tile = tiles_.find(key(tile_column, tile_row));
    if (tile == tiles_.end()) {
        return Cell::unknown;
    }
    const int32_t within = (row - tile_row * tile_side) * tile_side + (column - tile_column * tile_side);
    const Count &seen = tile->second[static_cast<size_t>(within)];
    if (seen.ended > 1 && seen.ended * passed_per_ended >= seen.passed) {
        return Cell::occupied;
    }
    return seen.passed > 1 ? Cell::free : Cell::unknown;
}

} // namespace ale
