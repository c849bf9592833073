#include "graph/loops/prior_map.h"

#include <algorithm>
#include <cmath>

#include "graph/optimise/scan_node.h"

extern "C" {
#include "base/fixed.h"
#include "map/map_exchange.h"
}

namespace ale
{

namespace
{

constexpr int64_t spacing_um = static_cast<int64_t>(node_point_spacing_m * 1e6);

// Half the side of the largest square that a field holds.
constexpr int side_cells = 512;
static_assert(side_cells * side_cells == LikelihoodField::max_cells);
constexpr double field_half_m = side_cells * LikelihoodField::cell_m / 2 - LikelihoodField::reach_m;

} // namespace

PriorMap::PriorMap(const ale_map_t &map)
{
    walls_.reserve(map.line_count);
    for (int k = 0; k < map.line_count; k++) {
        ale_wall_t wall;
        if (ale_map_line_wall(&map.line[k], &wall)) {
            walls_.push_back(wall);
        }
    }
}

void PriorMap::change(const ale_tile_change_t &change)
{
    views_.reset();
    const auto goes = [&change](const ale_wall_t &wall) {
        return std::binary_search(change.gone, change.gone + change.gone_count, wall.prior_id);
    };
    walls_.erase(std::remove_if(walls_.begin(), walls_.end(), goes), walls_.end());
    for (int k = 0; k < change.line_count; k++) {
        const uint32_t id = change.line[k].id;
        const auto is_it = [id](const ale_wall_t &wall) { return wall.prior_id == id; };
        ale_wall_t wall;
        if (std::none_of(walls_.begin(), walls_.end(), is_it) && ale_map_line_wall(&change.line[k], &wall)) {
            wall.prior_id = id;
            walls_.push_back(wall);
        }
    }
}

const PriorViews &PriorMap::views()
{
    if (!views_) {
        views_.emplace(walls_);
    }
    return *views_;
}

// Points of the walls, node_point_spacing_m apart, in a square about the guess that a field holds.
std::vector<SurfacePoint> PriorMap::points_around(const Pose &guess, double reach_m) const
{
    const double half_m = std::min(reach_m, field_half_m);
    const ale_point_t middle = {to_core(guess).x_um, to_core(guess).y_um};
    const auto along_um = static_cast<int64_t>(half_m * 1.5e6);
    std::vector<SurfacePoint> points;
    for (const ale_wall_t &wall : walls_) {
        const Eigen::Vector2d normal(wall.normal_x_q30 / one_q30, wall.normal_y_q30 / one_q30);
        const int64_t foot_um = ale_wall_along(&wall, middle);
        const int64_t before = ale_max64(foot_um - along_um - wall.start_um, 0) / spacing_um;
        const int64_t last_um = ale_min64(wall.end_um, foot_um + along_um);
        for (int64_t t_um = wall.start_um + before * spacing_um; t_um <= last_um; t_um += spacing_um) {
            const Eigen::Vector2d p = to_metres(ale_wall_point(&wall, t_um));
            if (std::abs(p.x() - guess.x) < half_m && std::abs(p.y() - guess.y) < half_m) {
                points.push_back({p, normal});
            }
        }
    }
    return points;
}

std::optional<PairwiseMatch> PriorMap::find(const std::vector<SurfacePoint> &seen, const Pose &guess) const
{
    double reach_m = 0;
    for (const SurfacePoint &point : seen) {
        reach_m = std::max(reach_m, point.p.norm());
    }
    const std::vector<SurfacePoint> points = points_around(guess, reach_m + LikelihoodField::reach_m);
    return points.empty() ? std::nullopt : match_pair(LikelihoodField(points), seen, guess);
}

} // namespace ale
