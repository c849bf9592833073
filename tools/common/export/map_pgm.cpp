#include "common/export/map_image.h"
#include "common/export/occupancy_grid.h"

namespace ale
{

namespace
{

constexpr int64_t most_cells = 250000000;

/* Values as map_server reads them. */
char grey(OccupancyGrid::Cell cell)
{
    constexpr char occupied = 0;
    constexpr char unknown = static_cast<char>(205);
    constexpr char free_space = static_cast<char>(254);
    return cell == OccupancyGrid::Cell::unknown ? unknown
           : cell == OccupancyGrid::Cell::free  ? free_space
                                                : occupied;
}

/* Row 0 of the file is the top of the map. */
void write_cells(const OccupancyGrid &grid, const std::string &path)
{
    std::string pixels;
    pixels.reserve(static_cast<size_t>(grid.columns()) * static_cast<size_t>(grid.rows()));
    for (int32_t row = grid.rows() - 1; row >= 0; row--) {
        for (int32_t column = 0; column < grid.columns(); column++) {
            pixels += grey(grid.at(column, row));
        }
    }
    TextFile file(path);
    file.put("P5\n").put_integer(grid.columns()).put(" ").put_integer(grid.rows());
    file.put("\n255\n").put(pixels);
    file.close();
}

void write_yaml(const OccupancyGrid &grid, const std::string &path, const std::string &image)
{
    TextFile file(path);
    file.put("image: ").put(image).put("\nresolution: ").put_decimal(grid.cell_um(), 6);
    file.put("\norigin: [").put_decimal(grid.left_um(), 6).put(", ");
    file.put_decimal(grid.bottom_um(), 6).put(", 0]\n");
    file.put("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    file.close();
}

} // namespace

void write_pgm(const std::string &path, const MapScene &scene)
{
    const OccupancyGrid grid = occupancy_of(scene, most_cells);
    write_cells(grid, path);
    const std::string stem = path.substr(0, path.size() - 4);
    write_yaml(grid, stem + ".yaml", path.substr(path.find_last_of('/') + 1));
}

} // namespace ale
