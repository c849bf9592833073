#include "graph/known_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "graph/scan_node.h"

extern "C" {
#include "track/map_exchange.h"
}

namespace ale
{

namespace
{

constexpr int64_t spacing_um = static_cast<int64_t>(node_point_spacing_m * 1e6);

} // namespace

KnownMap::KnownMap(const ale_map_t &map)
{
    for (int k = 0; k < map.line_count; k++) {
        ale_wall_t wall;
        if (!ale_map_line_wall(&map.line[k], &wall)) {
            continue;
        }
        const Eigen::Vector2d normal(wall.normal_x_q30 / 1073741824.0, wall.normal_y_q30 / 1073741824.0);
        for (int64_t t_um = wall.start_um; t_um <= wall.end_um; t_um += spacing_um) {
            const ale_point_t p = ale_wall_point(&wall, t_um);
            points_.push_back({{p.x_um * 1e-6, p.y_um * 1e-6}, normal});
        }
    }
}

std::optional<TightMatch> KnownMap::find(const std::vector<SurfacePoint> &seen, const Pose &guess) const
{
    double reach_m = 0;
    for (const SurfacePoint &point : seen) {
        reach_m = std::max(reach_m, point.p.norm());
    }
    reach_m += SurfaceField::reach_m;
    std::vector<SurfacePoint> around;
    std::copy_if(points_.begin(), points_.end(), std::back_inserter(around), [&](const SurfacePoint &point) {
        return std::abs(point.p.x() - guess.x) < reach_m && std::abs(point.p.y() - guess.y) < reach_m;
    });
    return around.empty() ? std::nullopt : match_to(SurfaceField(around), seen, guess);
}

} // namespace ale
