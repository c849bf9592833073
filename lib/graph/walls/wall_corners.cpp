#include "graph/walls/wall_corners.h"

#include <algorithm>
#include <memory>
#include <optional>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "map/map_corner.h"
#include "observe/observation.h"
}

namespace ale
{

namespace
{

// Largest distance of the lines' ends, and of their intersection, from the corner as observed.
constexpr int64_t reach_um = 250000;
constexpr int64_t angle_bam = int64_t{25} * ALE_BAM_PER_DEGREE;
constexpr int64_t least_opening_bam = int64_t{30} * ALE_BAM_PER_DEGREE;

// An end of a line of the map, and the direction from there along the line.
struct End {
    size_t line;
    bool is_start;
    uint32_t inwards_bam;
};

// Two ends that form a corner.
struct Junction {
    End a;
    End b;
    ale_point_t p;
    int64_t distance_um; // from the corner as observed
};

int64_t distance_um(ale_point_t a, ale_point_t b)
{
    const ale_point_t d = ale_minus(a, b);
    const auto x = int64_t{d.x_um};
    const auto y = int64_t{d.y_um};
    return static_cast<int64_t>(ale_isqrt(static_cast<uint64_t>(x * x + y * y)));
}

ale_point_t point_of(const WallMap &map, const End &end)
{
    const ale_map_line_t &line = map.lines[end.line];
    return end.is_start ? line.start : line.end;
}

// Line ends within reach_um of a point.
std::vector<End> ends_near(const WallMap &map, ale_point_t p)
{
    std::vector<End> ends;
    for (size_t k = 0; k < map.lines.size(); k++) {
        const ale_map_line_t &line = map.lines[k];
        const ale_point_t d = ale_minus(line.end, line.start);
        const uint32_t along_bam = ale_atan2_bam(d.y_um, d.x_um);
        const bool at_start = distance_um(line.start, p) <= distance_um(line.end, p);
        if (distance_um(at_start ? line.start : line.end, p) < reach_um) {
            ends.push_back({k, at_start, along_bam + (at_start ? 0 : ALE_BAM_HALF_TURN)});
        }
    }
    return ends;
}

// Intersection of the lines through two ends: p = a + t u.
ale_point_t crossing(ale_point_t a, uint32_t u_bam, ale_point_t b, uint32_t v_bam)
{
    const uint32_t across_bam = v_bam + ALE_BAM_QUARTER_TURN;
    const int64_t height_um = ale_along(ale_minus(b, a), across_bam);
    const int64_t t_um = ale_mul_div(height_um, 1 << 30, ale_cos_q30(u_bam - across_bam));
    return ale_plus(a, ale_polar(ale_clamp64(t_um, -2 * reach_um, 2 * reach_um), u_bam));
}

std::optional<Junction> junction(const WallMap &map, const End &a, const End &b,
                                 const ale_map_corner_t &corner)
{
    const int64_t opening_bam = ale_abs64(ale_bam_diff(a.inwards_bam, b.inwards_bam));
    if (opening_bam < least_opening_bam || opening_bam > ALE_BAM_HALF_TURN - least_opening_bam ||
        ale_abs64(opening_bam - corner.angle_bam) > angle_bam) {
        return std::nullopt;
    }
    const ale_point_t pa = point_of(map, a);
    const ale_point_t pb = point_of(map, b);
    const ale_point_t p = crossing(pa, a.inwards_bam, pb, b.inwards_bam);
    if (distance_um(p, pa) > reach_um || distance_um(p, pb) > reach_um ||
        distance_um(p, corner.p) > reach_um) {
        return std::nullopt;
    }
    return Junction{a, b, p, distance_um(p, corner.p)};
}

std::optional<Junction> nearest_junction(const WallMap &map, const ale_map_corner_t &corner)
{
    std::optional<Junction> best;
    const std::vector<End> ends = ends_near(map, corner.p);
    for (size_t i = 0; i < ends.size(); i++) {
        for (size_t k = i + 1; k < ends.size(); k++) {
            const std::optional<Junction> m = junction(map, ends[i], ends[k], corner);
            best = m && (!best || m->distance_um < best->distance_um) ? m : best;
        }
    }
    return best;
}

void move_ends_to(WallMap *map, const Junction &m)
{
    for (const End &end : {m.a, m.b}) {
        ale_map_line_t &line = map->lines[end.line];
        (end.is_start ? line.start : line.end) = m.p;
    }
}

// Corners averaged over all scans at their corrected poses, by the filter of the tracker.
std::unique_ptr<ale_map_corners_t> averaged(const ObservationRecord &record, const PoseOfScan &pose_of)
{
    auto corners = std::make_unique<ale_map_corners_t>();
    auto features = std::make_unique<ale_features_t>();
    ale_map_corners_clear(corners.get());
    corners->count =
        static_cast<uint16_t>(std::min<size_t>(record.prior_corners().size(), ALE_MAP_MAX_CORNERS));
    std::copy_n(record.prior_corners().begin(), corners->count, corners->corner);
    for (const RecordedScan &scan : record.scans()) {
        const std::optional<ale_pose_t> pose = pose_of(scan);
        if (!pose) {
            continue;
        }
        std::copy(scan.corners.begin(), scan.corners.end(), features->corner);
        features->corner_count = static_cast<uint16_t>(scan.corners.size());
        ale_map_corners_update(corners.get(), features.get(), ale_pose_compose(*pose, record.sensor(scan)),
                               scan.scan, true);
    }
    return corners;
}

} // namespace

void add_wall_corners(const ObservationRecord &record, const PoseOfScan &pose_of, WallMap *map)
{
    const std::unique_ptr<ale_map_corners_t> seen = averaged(record, pose_of);
    std::stable_sort(seen->corner, seen->corner + seen->count,
                     [](const ale_map_corner_t &a, const ale_map_corner_t &b) { return a.seen > b.seen; });
    for (int k = 0; k < seen->count && seen->corner[k].seen >= ALE_CORNER_CONFIRMED; k++) {
        ale_map_corner_t corner = seen->corner[k];
        const std::optional<Junction> m = nearest_junction(*map, corner);
        const auto is_here = [&m](const ale_map_corner_t &other) { return distance_um(other.p, m->p) == 0; };
        if (!m || std::any_of(map->corners.begin(), map->corners.end(), is_here)) {
            continue;
        }
        move_ends_to(map, *m);
        corner.p = m->p;
        map->corners.push_back(corner);
    }
}

} // namespace ale
