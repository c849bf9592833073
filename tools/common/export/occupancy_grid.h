/* A map as square cells: what is free, what is occupied, and what nobody has seen.
 *
 *   const OccupancyGrid grid = occupancy_of(scene, most_cells);
 *   grid.at(column, row)                 row 0 is the lowest y
 *
 * The cells of what scans saw (scene.cloud), and on them the walls of the map. */
#ifndef ALE_COMMON_EXPORT_OCCUPANCY_GRID_H
#define ALE_COMMON_EXPORT_OCCUPANCY_GRID_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/export/map_image.h"

namespace ale
{

class OccupancyGrid
{
  public:
    using Cell = ScanCloud::Cell;

    /* Side of a cell. */
    int32_t cell_um() const
    {
        return cell_um_;
    }
    int32_t columns() const
    {
        return columns_;
    }
    int32_t rows() const
    {
        return rows_;
    }
    /* Lower left corner of cell (0, 0). */
    int64_t left_um() const
    {
        return int64_t{left_} * cell_um_;
    }
    int64_t bottom_um() const
    {
        return int64_t{bottom_} * cell_um_;
    }
    Cell at(int32_t column, int32_t row) const
    {
        return cells_[index(column, row)];
    }

  private:
    friend OccupancyGrid occupancy_of(const MapScene &scene, int64_t most_cells);

    OccupancyGrid(const Extent &extent, int32_t cell_um, int64_t most_cells);
    void fill(const ScanCloud &cloud);
    void draw(const ale_point_t &from, const ale_point_t &to);
    int32_t floor_cell(int32_t um) const
    {
        return um / cell_um_ - (um % cell_um_ < 0);
    }
    size_t index(int32_t column, int32_t row) const
    {
        return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
    }

    int32_t cell_um_;
    int32_t left_; /* in cells */
    int32_t bottom_;
    int32_t columns_;
    int32_t rows_;
    std::vector<Cell> cells_;
};

/* In cells of the cloud's size, 5 cm without one; ten cells of border lie about what there is. Throws
 * std::runtime_error when that is more than most_cells.
 */
OccupancyGrid occupancy_of(const MapScene &scene, int64_t most_cells);

} // namespace ale

#endif
