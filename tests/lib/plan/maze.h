// Grids drawn by hand, and made ones, for tests of planning.
#pragma once

#include <algorithm>

#include <memory>
#include <random>
#include <string>
#include <vector>

extern "C" {
#include "plan/grid.h"
}

namespace maze
{

constexpr int left = 400; // column of a drawing's first character
constexpr int bottom = 400;

inline void set(ale_grid_t &grid, int x, int y, int8_t evidence)
{
    const auto cell = static_cast<ale_cell_t>(y * ALE_GRID_SIDE + x);
    grid.evidence[cell] = evidence;
    for (ale_grid_part_t *part : {&grid.extent, &grid.changed}) {
        part->first_x = std::min(part->first_x, x);
        part->last_x = std::max(part->last_x, x);
        part->first_y = std::min(part->first_y, y);
        part->last_y = std::max(part->last_y, y);
    }
}

inline std::unique_ptr<ale_grid_t> empty()
{
    auto grid = std::make_unique<ale_grid_t>();
    ale_grid_init(grid.get(), {0, 0});
    return grid;
}

// '#' occupied, '.' free, ' ' unknown; the first line is the northernmost. Each character is `scale` cells
// wide.
inline std::unique_ptr<ale_grid_t> drawn(const std::vector<std::string> &lines, int scale)
{
    auto grid = empty();
    for (size_t row = 0; row < lines.size(); row++) {
        for (size_t column = 0; column < lines[row].size(); column++) {
            const char c = lines[row][column];
            for (int k = 0; k < scale * scale && c != ' '; k++) {
                set(*grid, left + static_cast<int>(column) * scale + k % scale,
                    bottom + static_cast<int>(lines.size() - 1 - row) * scale + k / scale,
                    c == '#' ? 30 : -20);
            }
        }
    }
    return grid;
}

// Middle of a drawing's character.
inline ale_point_t place(const ale_grid_t &grid, const std::vector<std::string> &lines, char c, int scale)
{
    for (size_t row = 0; row < lines.size(); row++) {
        const size_t column = lines[row].find(c);
        if (column != std::string::npos) {
            const int x = left + static_cast<int>(column) * scale + scale / 2;
            const int y = bottom + static_cast<int>(lines.size() - 1 - row) * scale + scale / 2;
            return ale_grid_middle(&grid, static_cast<ale_cell_t>(y * ALE_GRID_SIDE + x));
        }
    }
    return {0, 0};
}

// A free square with obstacles strewn over it.
inline std::unique_ptr<ale_grid_t> strewn(int side, double density, unsigned seed)
{
    auto grid = empty();
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int y = 0; y < side; y++) {
        for (int x = 0; x < side; x++) {
            set(*grid, left + x, bottom + y, unit(rng) < density ? 30 : -20);
        }
    }
    return grid;
}

} // namespace maze
