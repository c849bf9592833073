#include "common/export/occupancy_grid.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace ale
{

namespace
{

constexpr int32_t border = 10; /* cells */

} // namespace

OccupancyGrid::OccupancyGrid(const Extent &extent, int32_t cell_um, int64_t most_cells)
    : cell_um_(cell_um), left_(floor_cell(extent.left_um) - border),
      bottom_(floor_cell(extent.bottom_um) - border),
      columns_(floor_cell(extent.right_um) + border + 1 - left_),
      rows_(floor_cell(extent.top_um) + border + 1 - bottom_)
{
    if (int64_t{columns_} * rows_ > most_cells) {
        throw std::runtime_error("the map is too large for an occupancy grid of " + length_label(cell_um));
    }
    cells_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), Cell::unknown);
}

void OccupancyGrid::fill(const ScanCloud &cloud)
{
    for (int32_t row = 0; row < rows_; row++) {
        for (int32_t column = 0; column < columns_; column++) {
            cells_[index(column, row)] = cloud.cell(left_ + column, bottom_ + row);
        }
    }
}

/* Every cell that the wall crosses along its longer axis. */
void OccupancyGrid::draw(const ale_point_t &from, const ale_point_t &to)
{
    const int64_t dx = int64_t{to.x_um} - from.x_um;
    const int64_t dy = int64_t{to.y_um} - from.y_um;
    const int64_t steps = 2 * std::max(std::abs(dx), std::abs(dy)) / cell_um_ + 1;
    for (int64_t i = 0; i <= steps; i++) {
        const int32_t column = floor_cell(static_cast<int32_t>(from.x_um + dx * i / steps)) - left_;
        const int32_t row = floor_cell(static_cast<int32_t>(from.y_um + dy * i / steps)) - bottom_;
        cells_[index(column, row)] = Cell::occupied;
    }
}

OccupancyGrid occupancy_of(const MapScene &scene, int64_t most_cells)
{
    MapScene whole = scene;
    whole.draw_points = true;
    OccupancyGrid grid(extent_of(whole), scene.cloud ? scene.cloud->cell_um() : ScanCloud::usual_cell_um,
                       most_cells);
    if (scene.cloud) {
        grid.fill(*scene.cloud);
    }
    for (int i = 0; i < scene.map->line_count; i++) {
        grid.draw(scene.map->line[i].start, scene.map->line[i].end);
    }
    return grid;
}

} // namespace ale
