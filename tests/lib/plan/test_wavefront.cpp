// lib/plan/wavefront.c against Dijkstra's algorithm with a priority queue.
#include <memory>
#include <queue>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "maze.h"

extern "C" {
#include "plan/wavefront.h"
}

namespace
{

constexpr int side = 80;
constexpr uint32_t never = UINT32_MAX;

ale_cell_t cell_of(int x, int y)
{
    return static_cast<ale_cell_t>((maze::bottom + y) * ALE_GRID_SIDE + maze::left + x);
}

// Cost of entering a cell; 0: closed.
std::vector<uint32_t> random_costs(unsigned seed)
{
    std::mt19937 rng(seed);
    std::uniform_int_distribution<uint32_t> cost(1, ALE_WAVEFRONT_MAX_STEP);
    std::vector<uint32_t> costs;
    for (int k = 0; k < side * side; k++) {
        const uint32_t c = cost(rng);
        costs.push_back(c < 20 ? 0 : c);
    }
    return costs;
}

template <typename Enter> void for_neighbours(int x, int y, const std::vector<uint32_t> &costs, Enter enter)
{
    const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto &step : steps) {
        const int u = x + step[0];
        const int v = y + step[1];
        if (u >= 0 && v >= 0 && u < side && v < side && costs[static_cast<size_t>(v * side + u)] > 0) {
            enter(u, v, costs[static_cast<size_t>(v * side + u)]);
        }
    }
}

std::vector<uint32_t> dijkstra(const std::vector<uint32_t> &costs)
{
    std::vector<uint32_t> best(static_cast<size_t>(side) * side, never);
    using Open = std::pair<uint32_t, int>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    best[0] = 0;
    open.push({0, 0});
    while (!open.empty()) {
        const auto [cost, k] = open.top();
        open.pop();
        if (cost > best[static_cast<size_t>(k)]) {
            continue;
        }
        for_neighbours(k % side, k / side, costs, [&, from = cost](int u, int v, uint32_t step) {
            uint32_t &there = best[static_cast<size_t>(v * side + u)];
            if (from + step < there) {
                there = from + step;
                open.push({there, v * side + u});
            }
        });
    }
    return best;
}

} // namespace

TEST(Wavefront, ReachesEveryCellAtItsLeastCostInTheOrderOfCosts)
{
    const auto grid = maze::strewn(side, 0, 1);
    const auto front = std::make_unique<ale_wavefront_t>();
    for (unsigned seed = 1; seed <= 10; seed++) {
        const auto costs = random_costs(seed);
        const auto truth = dijkstra(costs);
        ale_wavefront_begin(front.get(), grid.get(), cell_of(0, 0));
        uint32_t last = 0;
        int reached = 0;
        for (ale_cell_t cell = ale_wavefront_next(front.get()); cell != ALE_GRID_NONE;
             cell = ale_wavefront_next(front.get())) {
            const int x = static_cast<int>(cell % ALE_GRID_SIDE) - maze::left;
            const int y = static_cast<int>(cell / ALE_GRID_SIDE) - maze::bottom;
            EXPECT_GE(front->cost[cell], last);
            last = front->cost[cell];
            EXPECT_EQ(front->cost[cell], truth[static_cast<size_t>(y * side + x)]);
            const ale_cell_t from = front->from[cell];
            if (cell != from) {
                EXPECT_EQ(front->cost[from] + costs[static_cast<size_t>(y * side + x)], front->cost[cell]);
            }
            reached++;
            for_neighbours(x, y, costs, [&](int u, int v, uint32_t step) {
                ale_wavefront_enter(front.get(), cell_of(u, v), cell, step);
            });
        }
        EXPECT_EQ(reached,
                  std::count_if(truth.begin(), truth.end(), [](uint32_t cost) { return cost != never; }));
    }
}

TEST(Wavefront, BeginsAnywhereAlsoWhereNothingWasSeen)
{
    const auto grid = maze::empty();
    const auto front = std::make_unique<ale_wavefront_t>();
    ale_wavefront_begin(front.get(), grid.get(), cell_of(5, 5));
    EXPECT_EQ(ale_wavefront_next(front.get()), cell_of(5, 5));
    EXPECT_EQ(ale_wavefront_next(front.get()), ALE_GRID_NONE);
}
