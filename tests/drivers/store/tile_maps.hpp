/* Large maps for tests, saved by tiles. */
#ifndef TESTS_DRIVERS_STORE_TILE_MAPS_HPP
#define TESTS_DRIVERS_STORE_TILE_MAPS_HPP

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include "store/tile_file.h"
}

namespace tile_maps
{

struct Map {
    std::vector<ale_map_line_t> lines;
    std::vector<ale_map_corner_t> corners;

    ale_whole_map_t whole() const
    {
        return {lines.data(), lines.size(), corners.data(), corners.size()};
    }
};

inline ale_map_line_t wall(int32_t x1, int32_t y1, int32_t x2, int32_t y2)
{
    ale_map_line_t line{};
    line.start = {x1, y1};
    line.end = {x2, y2};
    line.var_alpha_nrad2 = 4000000000000;
    line.var_rho_um2 = 4000000;
    line.seen = 9;
    return line;
}

/* Walls of a metre or two, some along corridors of a hundred, in a square of this half width. */
inline Map some(size_t walls, int32_t half_um, uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_int_distribution<int32_t> place(-half_um, half_um);
    std::uniform_int_distribution<int32_t> length(-2000000, 2000000);
    Map map;
    for (size_t k = 0; k < walls; k++) {
        const ale_point_t at = {place(random), place(random)};
        const int32_t stretched = k % 50 == 0 ? 25 : 1;
        map.lines.push_back(wall(at.x_um, at.y_um, at.x_um + stretched * length(random),
                                 at.y_um + (k % 50 == 0 ? 1 : length(random))));
        map.lines.back().id = static_cast<uint32_t>(random());
        ale_map_corner_t corner{};
        corner.p = at;
        corner.seen = static_cast<uint32_t>(k);
        map.corners.push_back(corner);
    }
    return map;
}

inline void save(const std::string &path, const Map &map, int32_t side_um = ALE_TILE_SIDE_UM)
{
    char error[ALE_MAP_FILE_ERROR] = "";
    const ale_whole_map_t whole = map.whole();
    ASSERT_EQ(ale_tile_file_save(path.c_str(), &whole, side_um, error), 0) << error;
}

} // namespace tile_maps

#endif
