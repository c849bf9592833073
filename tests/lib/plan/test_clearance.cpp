// lib/plan/clearance.c against distances found by looking at every pair of cells.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "maze.h"

extern "C" {
#include "plan/clearance.h"
}

namespace
{

std::unique_ptr<ale_clearance_t> fresh()
{
    auto clearance = std::make_unique<ale_clearance_t>();
    ale_clearance_init(clearance.get());
    return clearance;
}

double brute_force_cm(const ale_grid_t &grid, int x, int y)
{
    double nearest = ALE_CLEARANCE_FAR_CM;
    for (int v = grid.extent.first_y; v <= grid.extent.last_y; v++) {
        for (int u = grid.extent.first_x; u <= grid.extent.last_x; u++) {
            if (grid.evidence[v * ALE_GRID_SIDE + u] > 0) {
                nearest = std::min(nearest, 5 * std::hypot(u - x, v - y));
            }
        }
    }
    return nearest;
}

} // namespace

TEST(Clearance, IsTheDistanceToTheNearestObstacleWithinTwoPercent)
{
    for (unsigned seed = 1; seed <= 5; seed++) {
        const auto grid = maze::strewn(60, 0.004, seed);
        const auto clearance = fresh();
        ale_clearance_update(clearance.get(), grid.get(), grid->changed);
        for (int y = maze::bottom; y < maze::bottom + 60; y += 3) {
            for (int x = maze::left; x < maze::left + 60; x += 3) {
                const double truth = brute_force_cm(*grid, x, y);
                EXPECT_NEAR(clearance->to_occupied_cm[y * ALE_GRID_SIDE + x], truth, 0.02 * truth + 0.1);
            }
        }
    }
}

TEST(Clearance, ChangesTakenOneByOneGiveWhatAllAtOnceGives)
{
    const auto grid = maze::strewn(120, 0.002, 7);
    const auto clearance = fresh();
    ale_clearance_update(clearance.get(), grid.get(), ale_grid_take_changed(grid.get()));
    std::mt19937 rng(3);
    std::uniform_int_distribution<int> at(0, 119);
    for (int n = 0; n < 40; n++) {
        const int x = maze::left + at(rng);
        const int y = maze::bottom + at(rng);
        maze::set(*grid, x, y, n % 3 == 0 ? 30 : (n % 3 == 1 ? -20 : 0));
        ale_clearance_update(clearance.get(), grid.get(), ale_grid_take_changed(grid.get()));
    }
    const auto whole = fresh();
    ale_clearance_update(whole.get(), grid.get(), grid->extent);
    for (int y = maze::bottom - 40; y < maze::bottom + 160; y++) {
        for (int x = maze::left - 40; x < maze::left + 160; x++) {
            ASSERT_EQ(clearance->to_occupied_cm[y * ALE_GRID_SIDE + x],
                      whole->to_occupied_cm[y * ALE_GRID_SIDE + x]);
            ASSERT_EQ(clearance->to_unknown_cm[y * ALE_GRID_SIDE + x],
                      whole->to_unknown_cm[y * ALE_GRID_SIDE + x]);
        }
    }
}

TEST(Clearance, AnUnseenPatchCountsAndAGapBetweenBeamsDoesNot)
{
    const std::vector<std::string> lines = {
        "..............................", "..............................", "......................  ......",
        ".....  ...............  ......", "..............................", ".............................."};
    const auto grid = maze::drawn(lines, 1);
    const auto clearance = fresh();
    ale_clearance_update(clearance.get(), grid.get(), grid->changed);
    const auto to_unseen = [&](int x, int y) {
        return clearance->to_unknown_cm[(maze::bottom + y) * ALE_GRID_SIDE + maze::left + x];
    };
    EXPECT_EQ(to_unseen(22, 2), 0);
    EXPECT_EQ(to_unseen(20, 2), 10);
    EXPECT_GT(to_unseen(8, 2), 10) << "two cells are a gap";
    EXPECT_EQ(to_unseen(0, 2), 5) << "what lies beyond all that was seen is unknown";
}
