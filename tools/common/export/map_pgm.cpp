#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "common/export/map_image.h"

namespace ale
{

namespace
{

constexpr int32_t border = 10; /* cells */
constexpr int64_t most_cells = 250000000;
constexpr char occupied = 0;
constexpr char unknown = static_cast<char>(205);
constexpr char free_space = static_cast<char>(254);

/* Values as map_server reads them; row 0 of the file is the top of the map. */
class Grid
{
  public:
    /* Throws std::runtime_error when the map is too large for a picture of its cells. */
    Grid(const Extent &extent, int32_t cell_um)
        : cell_um_(cell_um), left_(floor_cell(extent.left_um) - border),
          bottom_(floor_cell(extent.bottom_um) - border),
          columns_(floor_cell(extent.right_um) + border + 1 - left_),
          rows_(floor_cell(extent.top_um) + border + 1 - bottom_)
    {
        if (int64_t{columns_} * rows_ > most_cells) {
            throw std::runtime_error("the map is too large for an occupancy grid of " +
                                     length_label(cell_um));
        }
        value_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), unknown);
    }
    void fill(const ScanCloud &cloud);
    void draw(const ale_point_t &from, const ale_point_t &to);
    void write(const std::string &path) const;
    void write_yaml(const std::string &path, const std::string &image) const;

  private:
    int32_t floor_cell(int32_t um) const
    {
        return um / cell_um_ - (um % cell_um_ < 0);
    }
    char &at(int32_t column, int32_t row)
    {
        const auto from_top = static_cast<size_t>(rows_ - 1 - (row - bottom_));
        return value_[from_top * static_cast<size_t>(columns_) + static_cast<size_t>(column - left_)];
    }

    int32_t cell_um_;
    int32_t left_;
    int32_t bottom_;
    int32_t columns_;
    int32_t rows_;
    std::string value_;
};

void Grid::fill(const ScanCloud &cloud)
{
    for (int32_t row = bottom_; row < bottom_ + rows_; row++) {
        for (int32_t column = left_; column < left_ + columns_; column++) {
            const ScanCloud::Cell cell = cloud.cell(column, row);
            at(column, row) = cell == ScanCloud::Cell::unknown ? unknown
                              : cell == ScanCloud::Cell::free  ? free_space
                                                               : occupied;
        }
    }
}

/* Every cell that the wall crosses along its longer axis. */
void Grid::draw(const ale_point_t &from, const ale_point_t &to)
{
    const int64_t dx = int64_t{to.x_um} - from.x_um;
    const int64_t dy = int64_t{to.y_um} - from.y_um;
    const int64_t steps = 2 * std::max(std::abs(dx), std::abs(dy)) / cell_um_ + 1;
    for (int64_t i = 0; i <= steps; i++) {
        at(floor_cell(static_cast<int32_t>(from.x_um + dx * i / steps)),
           floor_cell(static_cast<int32_t>(from.y_um + dy * i / steps))) = occupied;
    }
}

void Grid::write(const std::string &path) const
{
    TextFile file(path);
    file.put("P5\n").put_integer(columns_).put(" ").put_integer(rows_).put("\n255\n").put(value_);
    file.close();
}

void Grid::write_yaml(const std::string &path, const std::string &image) const
{
    TextFile file(path);
    file.put("image: ").put(image).put("\nresolution: ").put_decimal(cell_um_, 6);
    file.put("\norigin: [").put_decimal(int64_t{left_} * cell_um_, 6).put(", ");
    file.put_decimal(int64_t{bottom_} * cell_um_, 6).put(", 0]\n");
    file.put("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    file.close();
}

} // namespace

void write_pgm(const std::string &path, const MapScene &scene)
{
    MapScene whole = scene;
    whole.draw_points = true;
    Grid grid(extent_of(whole), scene.cloud ? scene.cloud->cell_um() : ScanCloud::usual_cell_um);
    if (scene.cloud) {
        grid.fill(*scene.cloud);
    }
    for (int i = 0; i < scene.map->line_count; i++) {
        grid.draw(scene.map->line[i].start, scene.map->line[i].end);
    }
    grid.write(path);
    const std::string stem = path.substr(0, path.size() - 4);
    grid.write_yaml(stem + ".yaml", path.substr(path.find_last_of('/') + 1));
}

} // namespace ale
