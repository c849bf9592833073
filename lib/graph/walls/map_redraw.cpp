#include "graph/walls/map_redraw.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "graph/walls/meeting_walls.h"
#include "graph/walls/wall_groups.h"
#include "graph/walls/wall_spans.h"

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "map/map_exchange.h"
}

namespace ale
{

namespace
{

// How well a corrected pose is known to its neighbours of other visits.
constexpr int64_t pose_um = 15000;
constexpr int64_t pose_urad = 6000;

constexpr int64_t million = 1000000;
constexpr uint32_t known_scan = UINT32_MAX; // later than any, so that lines stay sorted

PlacedLine placed(uint32_t scan, const ale_observation_t &line, const ale_viewpoint_t &robot)
{
    const int64_t aside_um = ale_along(line.centre, ale_tangent_bam(line.normal_bam));
    const int64_t swung_um = ale_mul_div(aside_um, pose_urad, million);
    return {scan, ale_observation_from(&line, &robot), pose_um * pose_um + swung_um * swung_um,
            pose_urad * pose_urad};
}

// A wall that the drive began with, as a line of all the scans behind it. Poses are known to it as to each
// other: what doubt there is, the lines of the drive carry.
std::optional<PlacedLine> placed(const ale_map_line_t &known)
{
    ale_wall_t wall;
    if (!ale_map_line_wall(&known, &wall)) {
        return std::nullopt;
    }
    ale_observation_t view{};
    view.centre = wall.anchor;
    view.normal_bam = wall.normal_bam;
    view.start_um = wall.start_um;
    view.end_um = wall.end_um;
    view.var_offset_um2 = wall.var_offset_um2;
    view.var_angle_urad2 = wall.var_angle_urad2;
    return PlacedLine{known_scan, view, 0, 0, std::max<uint32_t>(known.seen, ALE_MAP_CONFIRMED)};
}

// Offset and angle are told at the middle, where a map that is taken in puts the anchor.
ale_map_line_t line_of(const WallSpan &span)
{
    const ale_wall_t &wall = span.wall;
    const int64_t middle_um = (int64_t{wall.start_um} + wall.end_um) / 2;
    ale_map_line_t line{};
    line.start = ale_wall_point(&wall, wall.start_um);
    line.end = ale_wall_point(&wall, wall.end_um);
    line.var_alpha_nrad2 = wall.var_angle_urad2 * million;
    line.cov_alpha_rho = ale_wall_offset_angle_cov(&wall, middle_um) * 1000;
    line.var_rho_um2 = ale_wall_offset_var(&wall, middle_um);
    line.seen = span.seen;
    return line;
}

} // namespace

void redraw_map(const MapRecord &record, const PoseOfSight &pose_of, ale_map_t *out)
{
    std::vector<PlacedLine> lines;
    lines.reserve(std::accumulate(record.sights().begin(), record.sights().end(), size_t{0},
                                  [](size_t sum, const Sight &sight) { return sum + sight.lines.size(); }));
    std::vector<PlacedLook> looks;
    for (const Sight &sight : record.sights()) {
        const ale_viewpoint_t robot = ale_viewpoint(pose_of(sight));
        for (const ale_observation_t &line : sight.lines) {
            lines.push_back(placed(sight.scan, line, robot));
        }
        if (sight.look) {
            looks.push_back({sight.look.get(), ale_pose_compose(robot.pose, record.sensor())});
        }
    }
    for (const ale_map_line_t &known : record.known_lines()) {
        if (const auto line = placed(known)) {
            lines.push_back(*line);
        }
    }
    *out = {};
    for (const WallSpan &span : spans_of(group_lines(lines), lines, looks)) {
        if (out->line_count == ALE_MAP_MAX_LINES) {
            out->refused++;
            continue;
        }
        out->line[out->line_count] = line_of(span);
        out->line[out->line_count].id = out->line_count;
        out->line_count++;
    }
    meet_corners(record, pose_of, out);
}

} // namespace ale
