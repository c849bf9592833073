// lib/plan/grid.c: what a scan says about cells, against rays walked in double.
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "plan/grid.h"
}

namespace
{

std::vector<uint32_t> bearings_of(const ale_scan_t &scan)
{
    std::vector<uint32_t> bearings;
    for (int k = 0; k < scan.beams; k++) {
        bearings.push_back(ale_scan_bearing(&scan, k));
    }
    return bearings;
}

std::unique_ptr<ale_grid_t> empty_grid()
{
    auto grid = std::make_unique<ale_grid_t>();
    ale_grid_init(grid.get(), {0, 0});
    return grid;
}

void add(ale_grid_t &grid, const ale_scan_t &scan, const reference::Pose &sensor)
{
    ale_grid_add_scan(&grid, &scan, bearings_of(scan).data(), convert::pose(sensor));
}

int8_t evidence_at(const ale_grid_t &grid, double x, double y)
{
    return grid.evidence[ale_grid_cell(&grid, {convert::um(x), convert::um(y)})];
}

ale_scan_t beams_of_nothing(uint16_t beams)
{
    ale_scan_t scan = {};
    scan.beams = beams;
    scan.step_bam = 1 << 22;
    scan.range_min_um = 20000;
    scan.range_max_um = 4000000;
    std::memset(scan.flag, ALE_BEAM_NO_RETURN, sizeof scan.flag);
    return scan;
}

} // namespace

TEST(Grid, ACellHoldsItsMiddleAndPointsOutsideHaveNone)
{
    const auto grid = empty_grid();
    std::mt19937 rng(1);
    std::uniform_int_distribution<int32_t> um(-25400000, 25400000);
    for (int n = 0; n < 1000; n++) {
        const ale_point_t p = {um(rng), um(rng)};
        const ale_cell_t cell = ale_grid_cell(grid.get(), p);
        ASSERT_NE(cell, ALE_GRID_NONE);
        const ale_point_t middle = ale_grid_middle(grid.get(), cell);
        EXPECT_EQ(ale_grid_cell(grid.get(), middle), cell);
        EXPECT_LE(std::abs(p.x_um - middle.x_um), ALE_GRID_CELL_UM / 2);
        EXPECT_LE(std::abs(p.y_um - middle.y_um), ALE_GRID_CELL_UM / 2);
    }
    EXPECT_EQ(ale_grid_cell(grid.get(), {25600000, 0}), ALE_GRID_NONE);
    EXPECT_EQ(ale_grid_cell(grid.get(), {0, -25600001}), ALE_GRID_NONE);
}

TEST(Grid, RoomsAreFreeInsideAndOccupiedAtTheirWalls)
{
    const auto grid = empty_grid();
    const auto walls = room::l_shape();
    std::mt19937 rng(2);
    for (int n = 0; n < 60; n++) {
        const reference::Pose at = {1 + 0.02 * n, -0.5, 0.3 * n};
        room::Sensor sensor;
        sensor.noise = 0.005;
        sensor.beam_time_ns = 0;
        add(*grid,
            room::scan_at(
                walls, sensor, [&](double) { return at; }, 0, rng),
            at);
    }
    int free_cells = 0;
    for (double y = -1.9; y < 0.9; y += 0.05) {
        for (double x = -0.9; x < 3.4; x += 0.05) {
            EXPECT_LT(evidence_at(*grid, x, y), 0) << x << ' ' << y;
            free_cells++;
        }
    }
    EXPECT_GT(free_cells, 4000);
    int wall_cells = 0;
    int occupied = 0;
    for (double y = -1.9; y < 1.1; y += 0.05) {
        // Noise may put a wall on a cell's border into either of two cells.
        wall_cells++;
        occupied += evidence_at(*grid, -1.01, y) > 0 || evidence_at(*grid, -0.99, y) > 0 ? 1 : 0;
    }
    EXPECT_GT(occupied, 0.95 * wall_cells);
    EXPECT_EQ(evidence_at(*grid, -1.2, 0), 0) << "behind the wall";
}

TEST(Grid, ABeamClearsItsWayAndNothingElse)
{
    const auto grid = empty_grid();
    ale_scan_t scan = beams_of_nothing(1);
    ale_scan_set_range(&scan, 0, 2000000);
    const double heading = 0.4;
    add(*grid, scan, {0.012, 0.034, heading});
    add(*grid, scan, {0.012, 0.034, heading});
    int free_cells = 0;
    for (ale_cell_t cell = 0; cell < ALE_GRID_CELLS; cell++) {
        if (grid->evidence[cell] == 0) {
            continue;
        }
        const ale_point_t p = ale_grid_middle(grid.get(), cell);
        const double x = p.x_um * 1e-6 - 0.012;
        const double y = p.y_um * 1e-6 - 0.034;
        const double along = x * std::cos(heading) + y * std::sin(heading);
        const double aside = y * std::cos(heading) - x * std::sin(heading);
        EXPECT_LT(std::fabs(aside), 0.036);
        EXPECT_GT(along, -0.04);
        EXPECT_LT(along, 2.04);
        if (ale_grid_is_occupied(grid.get(), cell)) {
            EXPECT_GT(along, 1.96);
        } else {
            free_cells++;
            EXPECT_LT(along, 1.96) << "the wall's own cell is not cleared";
        }
    }
    EXPECT_GE(free_cells, 35);
    EXPECT_EQ(grid->seen, static_cast<uint32_t>(free_cells) + 1);
}

TEST(Grid, OneHitMayBeAMixedPixelTwoAreAWall)
{
    const auto grid = empty_grid();
    ale_scan_t scan = beams_of_nothing(1);
    ale_scan_set_range(&scan, 0, 1010000);
    const ale_cell_t cell = ale_grid_cell(grid.get(), {1010000, 0});
    add(*grid, scan, {0, 0, 0});
    EXPECT_FALSE(ale_grid_is_occupied(grid.get(), cell));
    EXPECT_FALSE(ale_grid_is_free(grid.get(), cell));
    EXPECT_FALSE(ale_grid_is_unknown(grid.get(), cell));
    add(*grid, scan, {0, 0, 0});
    EXPECT_TRUE(ale_grid_is_occupied(grid.get(), cell));
}

TEST(Grid, BeamsWithoutReturnClearOnlyWhereSeveralAgreeAndNeverAWall)
{
    const auto alone = empty_grid();
    add(*alone, beams_of_nothing(4), {0, 0, 0});
    EXPECT_EQ(alone->seen, 0u);
    const auto many = empty_grid();
    add(*many, beams_of_nothing(20), {0, 0, 0});
    EXPECT_LT(evidence_at(*many, 2.9, 0.18), 0) << "three quarters of 4 m";
    EXPECT_EQ(evidence_at(*many, 3.2, 0.2), 0);

    const auto walled = empty_grid();
    ale_scan_t wall = beams_of_nothing(20);
    for (uint16_t k = 0; k < wall.beams; k++) {
        ale_scan_set_range(&wall, k, 1000000);
    }
    add(*walled, wall, {0, 0, 0});
    for (int n = 0; n < 50; n++) {
        add(*walled, beams_of_nothing(20), {0, 0, 0});
    }
    EXPECT_GT(evidence_at(*walled, 0.98, 0.06), 0);
    EXPECT_EQ(evidence_at(*walled, 1.5, 0.09), 0) << "behind it";
}

TEST(Grid, WhatGoesAwayIsForgottenWithinTwoSeconds)
{
    const auto grid = empty_grid();
    ale_scan_t person = beams_of_nothing(20);
    ale_scan_t gone = person;
    for (uint16_t k = 0; k < person.beams; k++) {
        ale_scan_set_range(&person, k, 1000000);
        ale_scan_set_range(&gone, k, 3000000);
    }
    for (int n = 0; n < 100; n++) {
        add(*grid, person, {0, 0, 0});
    }
    EXPECT_GT(evidence_at(*grid, 0.98, 0.06), 0);
    for (int n = 0; n < 20; n++) {
        add(*grid, gone, {0, 0, 0});
    }
    EXPECT_LT(evidence_at(*grid, 0.98, 0.06), 0);
}

TEST(Grid, TheRobotStandsOnFreeGround)
{
    const auto grid = empty_grid();
    ale_scan_t scan = beams_of_nothing(1);
    ale_scan_set_range(&scan, 0, 150000);
    add(*grid, scan, {0, 0, 0});
    ale_grid_add_disc(grid.get(), {0, 0}, 200000);
    EXPECT_LT(evidence_at(*grid, -0.15, 0.05), 0);
    EXPECT_GT(evidence_at(*grid, 0.151, 0.001), 0) << "what the scan says counts more";
    EXPECT_EQ(evidence_at(*grid, -0.27, 0), 0);
}

TEST(Grid, TellsWhatHasChanged)
{
    const auto grid = empty_grid();
    EXPECT_GT(grid->changed.first_x, grid->changed.last_x);
    ale_scan_t scan = beams_of_nothing(1);
    ale_scan_set_range(&scan, 0, 1000000);
    add(*grid, scan, {0, 0, 0});
    add(*grid, scan, {0, 0, 0});
    const ale_grid_part_t part = ale_grid_take_changed(grid.get());
    EXPECT_EQ(part.first_x, 512);
    EXPECT_EQ(part.last_x, 532);
    EXPECT_EQ(part.first_y, 512);
    EXPECT_EQ(part.last_y, 512);
    add(*grid, scan, {0, 0, 0});
    EXPECT_GT(grid->changed.first_x, grid->changed.last_x) << "more of the same is no change";
}

TEST(Grid, NothingIsSeenBeyondItsRim)
{
    const auto grid = empty_grid();
    ale_scan_t scan = beams_of_nothing(682);
    for (uint16_t k = 0; k < scan.beams; k++) {
        ale_scan_set_range(&scan, k, 3000000);
    }
    add(*grid, scan, {25.0, 25.0, 0});
    add(*grid, scan, {40.0, 0.0, 0});
    EXPECT_GT(grid->seen, 100u);
    EXPECT_LT(grid->extent.last_x, ALE_GRID_SIDE - ALE_GRID_RIM);
    EXPECT_LT(grid->extent.last_y, ALE_GRID_SIDE - ALE_GRID_RIM);
}

TEST(Grid, ASquareThatIsFullOnOneSideMovesToTheMiddleOfWhatWasSeen)
{
    const auto grid = empty_grid();
    std::mt19937 rng(2);
    const room::Sensor sensor;
    ale_point_t middle;
    const ale_scan_t scan = room::scan_at(
        room::l_shape(), sensor, [](double) { return reference::Pose(0, 0, 0); }, 0, rng);
    add(*grid, scan, {0, 0, 0});
    EXPECT_FALSE(ale_grid_is_cramped(grid.get(), &middle));
    add(*grid, scan, {23.5, 0, 0});
    ASSERT_TRUE(ale_grid_is_cramped(grid.get(), &middle));
    EXPECT_NEAR(middle.x_um, 12200000, 300000) << "between -1 m and the border";
    EXPECT_EQ(middle.x_um % ALE_GRID_CELL_UM, 0) << "cells stay where they are";
    ale_grid_init(grid.get(), middle);
    add(*grid, scan, {0, 0, 0});
    add(*grid, scan, {23.5, 0, 0});
    EXPECT_FALSE(ale_grid_is_cramped(grid.get(), &middle));
    EXPECT_LT(evidence_at(*grid, 0.2, 0.1), 0);
    EXPECT_LT(evidence_at(*grid, 26.5, 0.1), 0) << "beyond the border that there was";
}

TEST(Grid, ClearedItHasSeenNothingAndSaysSoOfAllThatItHadSeen)
{
    const auto grid = empty_grid();
    std::mt19937 rng(2);
    const ale_scan_t scan = room::scan_at(
        room::l_shape(), room::Sensor{}, [](double) { return reference::Pose(0, 0, 0); }, 0, rng);
    add(*grid, scan, {1, 0.5, 0});
    const ale_grid_part_t seen = grid->extent;
    ale_grid_take_changed(grid.get());
    ale_grid_clear(grid.get());
    EXPECT_EQ(grid->seen, 0u);
    EXPECT_EQ(evidence_at(*grid, 1.1, 0.5), 0);
    const ale_grid_part_t changed = ale_grid_take_changed(grid.get());
    EXPECT_EQ(std::memcmp(&seen, &changed, sizeof seen), 0);
}

TEST(Grid, AWallOfTheMapIsOccupiedAllAlongAndSeenThroughItIsForgotten)
{
    auto grid = empty_grid();
    ale_grid_add_wall(grid.get(), {1000000, -700000}, {1300000, 900000});
    for (double t = 0; t <= 1; t += 0.01) {
        bool there = false; // within a quarter of a cell: corners of cells that it cuts are left out
        for (const double off : {-0.0125, 0.0, 0.0125}) {
            const ale_point_t p = {convert::um(1.0 + 0.3 * t + off), convert::um(-0.7 + 1.6 * t)};
            there = there || ale_grid_is_occupied(grid.get(), ale_grid_cell(grid.get(), p));
        }
        EXPECT_TRUE(there) << t;
    }
    EXPECT_EQ(evidence_at(*grid, 0.9, 0), 0) << "beside it nothing is known";
    const ale_grid_part_t changed = ale_grid_take_changed(grid.get());
    EXPECT_GE(changed.last_y - changed.first_y, 32);
    ale_scan_t nothing = beams_of_nothing(200);
    for (int k = 0; k < 30; k++) {
        add(*grid, nothing, {0, 0, 0});
    }
    EXPECT_TRUE(ale_grid_is_occupied(grid.get(), ale_grid_cell(grid.get(), {1150000, 100000})))
        << "beams that return nowhere clear up to a wall, and not it";
}

TEST(Grid, AWallOutsideTheSquareIsLeftOut)
{
    auto grid = empty_grid();
    ale_grid_add_wall(grid.get(), {-2000000000, 2000000000}, {2000000000, 2000000000});
    EXPECT_EQ(grid->seen, 0U);
}
