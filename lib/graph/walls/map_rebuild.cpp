#include "graph/walls/map_rebuild.h"

#include <algorithm>
#include <numeric>
#include <optional>

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

// Error of a corrected pose relative to those of other visits, one sigma.
constexpr int64_t pose_um = 15000;
constexpr int64_t pose_urad = 6000;

constexpr int64_t million = 1000000;
constexpr uint32_t prior_scan = UINT32_MAX; // of a prior map: after any scan, so that lines stay sorted

PlacedLine placed(const RecordedScan &scan, const ale_observation_t &line, const ale_viewpoint_t &robot)
{
    const int64_t aside_um = ale_along(line.centre, ale_tangent_bam(line.normal_bam));
    const int64_t rotated_um = ale_mul_div(aside_um, pose_urad, million);
    return {scan.scan,
            ale_observation_from(&line, &robot),
            pose_um * pose_um + rotated_um * rotated_um,
            pose_urad * pose_urad,
            1,
            scan.drive};
}

// A wall of the prior map, as one line with the weight of all scans behind it. It adds no pose error: the
// lines of the drive carry that.
std::optional<PlacedLine> placed(const ale_map_line_t &prior)
{
    ale_wall_t wall;
    if (!ale_map_line_wall(&prior, &wall)) {
        return std::nullopt;
    }
    return PlacedLine{prior_scan, as_observation(wall), 0, 0,
                      std::max<uint32_t>(prior.seen, ALE_MAP_CONFIRMED)};
}

std::vector<ale_map_line_t> prior_of(const ObservationRecord &record, PriorWalls prior)
{
    return prior == PriorWalls::counted ? record.prior_lines() : std::vector<ale_map_line_t>();
}

// Variances refer to the middle, where the import of a map puts the anchor.
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
    line.seen = span.scans;
    return line;
}

} // namespace

WallMap rebuild_walls(const ObservationRecord &record, const PoseOfScan &pose_of, PriorWalls prior)
{
    std::vector<PlacedLine> lines;
    lines.reserve(
        std::accumulate(record.scans().begin(), record.scans().end(), size_t{0},
                        [](size_t sum, const RecordedScan &scan) { return sum + scan.lines.size(); }));
    std::vector<PlacedScan> scans;
    for (const RecordedScan &scan : record.scans()) {
        const std::optional<ale_pose_t> pose = pose_of(scan);
        if (!pose) {
            continue;
        }
        const ale_viewpoint_t robot = ale_viewpoint(*pose);
        for (const ale_observation_t &line : scan.lines) {
            lines.push_back(placed(scan, line, robot));
        }
        if (scan.beams) {
            scans.push_back(
                {scan.beams.get(), ale_pose_compose(robot.pose, record.sensor(scan)), scan.drive});
        }
    }
    for (const ale_map_line_t &wall : prior_of(record, prior)) {
        if (const auto line = placed(wall)) {
            lines.push_back(*line);
        }
    }
    WallMap map;
    for (const WallSpan &span : spans_of(group_lines(lines), lines, scans)) {
        map.lines.push_back(line_of(span));
    }
    add_wall_corners(record, pose_of, &map);
    return map;
}

void rebuild_map(const ObservationRecord &record, const PoseOfScan &pose_of, ale_map_t *out, PriorWalls prior)
{
    const WallMap map = rebuild_walls(record, pose_of, prior);
    *out = {};
    out->line_count = static_cast<uint16_t>(std::min<size_t>(map.lines.size(), ALE_MAP_MAX_LINES));
    out->corner_count = static_cast<uint16_t>(std::min<size_t>(map.corners.size(), ALE_MAP_MAX_CORNERS));
    out->refused = static_cast<uint32_t>(map.lines.size() - out->line_count);
    std::copy_n(map.lines.begin(), out->line_count, out->line);
    std::copy_n(map.corners.begin(), out->corner_count, out->corner);
    for (uint16_t k = 0; k < out->line_count; k++) {
        out->line[k].id = k;
    }
}

} // namespace ale
