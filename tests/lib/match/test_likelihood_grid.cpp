// lib/match/likelihood_grid.c: held against the walls in double.
#include <cstring>
#include <memory>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "lib/map/walls.h"

extern "C" {
#include "match/likelihood_grid.h"
}

namespace
{

constexpr int32_t cell_um = ALE_GRID_CELL_UM;
constexpr double cell_m = cell_um * 1e-6;
constexpr int32_t cells = ALE_GRID_CELLS;
constexpr double step_m = 0.002; /* in which the twin goes along a wall */

/* The walls of a map and the grid that is drawn of them. */
struct Drawn {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_likelihood_grid_t> grid = std::make_unique<ale_likelihood_grid_t>();
    std::vector<ale_wall_t> walls;
    std::vector<ale_point_t> landmarks;

    Drawn()
    {
        ale_local_map_clear(map.get());
    }
    void add(double x, double y, double normal, double half)
    {
        walls.push_back(make_wall(x, y, normal, half));
        ale_local_map_add(map.get(), &walls.back());
    }
    void add_landmark(double x, double y)
    {
        ale_landmark_t m = {};
        m.p = {convert::um(x), convert::um(y)};
        m.var_um2 = 9000000;
        m.seen = 1;
        m.map = map->landmarks.selected;
        ale_landmarks_add(&map->landmarks, &m);
        landmarks.push_back(m.p);
    }
    void draw(double x, double y)
    {
        const ale_point_t centre = {convert::um(x), convert::um(y)};
        ale_local_map_approach(map.get(), centre, 20000000);
        ale_likelihood_grid_draw(grid.get(), map.get(), centre);
    }
    /* Calls with points of all walls and landmarks. */
    template <typename Call> void each_point(Call call) const
    {
        for (const ale_wall_t &wall : walls) {
            const double a = convert::radians(wall.normal_bam) + reference::pi / 2;
            for (double t = wall.start_um * 1e-6; t <= wall.end_um * 1e-6; t += step_m) {
                call(wall.anchor.x_um * 1e-6 + t * std::cos(a), wall.anchor.y_um * 1e-6 + t * std::sin(a));
            }
        }
        for (const ale_point_t &p : landmarks) {
            call(p.x_um * 1e-6, p.y_um * 1e-6);
        }
    }
    /* Distance of every cell's square from the nearest wall or landmark, the larger of the two coordinates;
     * of those farther off than two cells: so much. */
    std::vector<double> distances() const
    {
        std::vector<double> least(cells * cells, 2 * cell_m);
        each_point([&](double x, double y) {
            const double px = (x - grid->corner.x_um * 1e-6) / cell_m - 0.5;
            const double py = (y - grid->corner.y_um * 1e-6) / cell_m - 0.5;
            for (int k = 0; k < 25; k++) {
                const double u = std::round(px) + k % 5 - 2;
                const double v = std::round(py) + k / 5 - 2;
                if (u >= 0 && v >= 0 && u < cells && v < cells) {
                    double &d = least[static_cast<size_t>(v) * cells + static_cast<size_t>(u)];
                    d = std::min(d, (std::max(std::abs(px - u), std::abs(py - v)) - 0.5) * cell_m);
                }
            }
        });
        return least;
    }
    int sum() const
    {
        int all = 0;
        for (const auto &row : grid->fine) {
            all = std::accumulate(std::begin(row), std::end(row), all);
        }
        return all;
    }
    int at(double x, double y) const
    {
        const int u = static_cast<int>(std::floor((x - grid->corner.x_um * 1e-6) / cell_m));
        const int v = static_cast<int>(std::floor((y - grid->corner.y_um * 1e-6) / cell_m));
        return grid->fine[v][u];
    }
};

} // namespace

/* A cell says a surface where one is, half of it beside one, and nothing elsewhere; every piece of every wall
 * is in a cell that says something. */
TEST(LikelihoodGrid, SaysWhatTheWallsAreInDouble)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int trial = 0; trial < 6; trial++) {
        Drawn d;
        const double x = 40 * unit(rng);
        const double y = 40 * unit(rng);
        for (int k = 0; k < 6; k++) {
            d.add(x + 9 * unit(rng), y + 9 * unit(rng), reference::pi * unit(rng), 1 + unit(rng));
        }
        for (int k = 0; k < 10; k++) {
            d.add_landmark(x + 9 * unit(rng), y + 9 * unit(rng));
        }
        d.draw(x, y);
        const std::vector<double> distances = d.distances();
        for (int v = 1; v < cells - 1; v++) {
            for (int u = 1; u < cells - 1; u++) {
                const uint8_t cell = d.grid->fine[v][u];
                const double distance = distances[static_cast<size_t>(v * cells + u)];
                if (cell == ALE_GRID_SURFACE) {
                    ASSERT_LT(distance, step_m) << u << " " << v;
                } else if (cell > 0) {
                    ASSERT_LT(distance, cell_m + step_m) << u << " " << v;
                } else {
                    ASSERT_GT(distance, 0) << u << " " << v;
                }
            }
        }
    }
}

TEST(LikelihoodGrid, ACoarseCellHoldsTheMostOfItsFineOnes)
{
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    Drawn d;
    for (int k = 0; k < 40; k++) {
        d.add(11 * unit(rng), 11 * unit(rng), reference::pi * unit(rng), 1 + unit(rng));
    }
    d.draw(0, 0);
    for (int v = 0; v < ALE_GRID_COARSE; v++) {
        for (int u = 0; u < ALE_GRID_COARSE; u++) {
            uint8_t most = 0;
            for (int k = 0; k < ALE_GRID_POOL * ALE_GRID_POOL; k++) {
                most = std::max(most, d.grid->fine[v * ALE_GRID_POOL + k / ALE_GRID_POOL]
                                                  [u * ALE_GRID_POOL + k % ALE_GRID_POOL]);
            }
            ASSERT_EQ(d.grid->coarse[v][u], most) << u << " " << v;
        }
    }
}

TEST(LikelihoodGrid, IsDrawnAnew)
{
    Drawn d;
    d.add(2, 0, reference::pi, 1);
    d.draw(0, 0);
    EXPECT_EQ(d.at(2, 0), ALE_GRID_SURFACE);
    ale_local_map_remove(d.map.get(), 0);
    d.draw(0, 0);
    EXPECT_EQ(d.sum(), 0);
}

TEST(LikelihoodGrid, WallsAndLandmarksOfAnotherMapAreNotInIt)
{
    Drawn d;
    d.add(2, 0, reference::pi, 1);
    d.add_landmark(0, 3);
    ale_local_map_select(d.map.get(), 1);
    d.add(-2, 0, 0, 1);
    d.add_landmark(0, -3);
    d.draw(0, 0);
    EXPECT_EQ(d.at(2, 0), 0);
    EXPECT_EQ(d.at(0, 3), 0);
    EXPECT_EQ(d.at(-2, 0), ALE_GRID_SURFACE);
    EXPECT_EQ(d.at(0, -3), ALE_GRID_SURFACE);
}

/* Walls that cross the border, that lie beyond it, and that are longer than the grid is wide. */
TEST(LikelihoodGrid, WhatLiesBeyondItsBordersIsLeftOut)
{
    const double half = cells / 2 * cell_m;
    for (const double side : {-1.0, 1.0}) {
        Drawn beyond;
        beyond.add(side * (half + 0.05), 0, 0, 3);
        beyond.add(0, side * (half + 1), reference::pi / 2, 3);
        beyond.add_landmark(side * (half + 0.01), 1);
        beyond.draw(0, 0);
        EXPECT_EQ(beyond.sum(), 0) << side;
        Drawn across;
        across.add(side * half, side * half, -reference::pi / 4 + 0.1, 25);
        across.draw(0, 0);
        EXPECT_GT(across.sum(), 0) << side;
    }
}

TEST(LikelihoodGrid, IsTheSameAtTheEndsOfTheWorld)
{
    Drawn middle;
    middle.add(2, 1, 0.4, 1);
    middle.add_landmark(-1, 3);
    middle.draw(0, 0);
    for (const auto &[x, y] :
         std::vector<std::pair<double, double>>{{2120, 2120}, {-2120, 2120}, {-2120, -2120}}) {
        Drawn far;
        far.add(x + 2, y + 1, 0.4, 1);
        far.add_landmark(x - 1, y + 3);
        far.draw(x, y);
        EXPECT_EQ(std::memcmp(far.grid->fine, middle.grid->fine, sizeof far.grid->fine), 0) << x << " " << y;
    }
}

/* Two thousand long walls are more cells than may be marked: the first are drawn, and then no more than one
 * cell of each. */
TEST(LikelihoodGrid, TheWorkIsBounded)
{
    Drawn d;
    for (int k = 0; k < ALE_MAP_MAX_LINES; k++) {
        d.add(0, -10 + 0.01 * k, reference::pi / 2, 12);
    }
    d.draw(0, 0);
    const int walls_drawn = ALE_GRID_WORK / static_cast<int>(24 / (0.75 * cell_m));
    EXPECT_EQ(d.at(0, -10 + 0.01 * (walls_drawn - 2)), ALE_GRID_SURFACE);
    EXPECT_EQ(d.at(0, -10 + 0.01 * (walls_drawn + 40)), 0);
}
