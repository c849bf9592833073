// lib/map/tile_grid: which squares lie around a robot, and which of them a wall touches.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

extern "C" {
#include "map/tile_grid.h"
}

namespace
{

constexpr int32_t side_um = 10000000;

bool same(ale_tile_range_t a, ale_tile_range_t b)
{
    return ale_tile_range_equals(a, b);
}

TEST(TileGrid, TheTilesAroundAPlaceAreThoseThatTheSquareTouches)
{
    EXPECT_TRUE(same(ale_tile_range_around({5000000, 5000000}, 4999999, side_um), {0, 0, 0, 0}));
    EXPECT_TRUE(same(ale_tile_range_around({5000000, 5000000}, 5000000, side_um), {0, 0, 1, 1}));
    EXPECT_TRUE(same(ale_tile_range_around({-1, 0}, 0, side_um), {-1, 0, -1, 0}));
    EXPECT_TRUE(same(ale_tile_range_around({-10000000, -10000001}, 0, side_um), {-1, -2, -1, -2}));
    EXPECT_TRUE(
        same(ale_tile_range_around({INT32_MIN, INT32_MAX}, 80000000, 1000000), {-2228, 2067, -2068, 2227}));
}

TEST(TileGrid, ARobotThatGoesToAndFroAtAnEdgeLoadsNothingTwice)
{
    const auto around = [](ale_tile_range_t present, int32_t x_um) {
        return ale_tile_range_follow(present, {x_um, 5000000}, 12000000, 17000000, side_um);
    };
    const ale_tile_range_t nowhere = {0, 0, -1, -1};
    const ale_tile_range_t before = around(nowhere, 7900000);
    EXPECT_TRUE(same(before, {-1, -1, 1, 1}));
    const ale_tile_range_t beyond = around(before, 8100000);
    EXPECT_TRUE(same(beyond, {-1, -1, 2, 1}));
    EXPECT_TRUE(same(around(beyond, 7900000), beyond));
    EXPECT_TRUE(same(around(beyond, 3100000), beyond));
    EXPECT_TRUE(same(around(beyond, 2900000), {-1, -1, 1, 1})) << "until it is far";
    EXPECT_TRUE(same(around(beyond, 500000000), {48, -1, 51, 1})) << "and elsewhere all is another";
}

TEST(TileGrid, WhateverTheWayAllWithinReachIsLoadedAndNoMoreThanIsWithinTheFartherReach)
{
    std::mt19937 random(5);
    std::uniform_int_distribution<int32_t> step(-9000000, 9000000);
    ale_tile_range_t range = {0, 0, -1, -1};
    ale_point_t place = {0, 0};
    for (int k = 0; k < 5000; k++) {
        place = {place.x_um + step(random) / (1 + k % 7), place.y_um + step(random) / (1 + k % 5)};
        range = ale_tile_range_follow(range, place, 12000000, 17000000, side_um);
        const ale_tile_range_t least = ale_tile_range_around(place, 12000000, side_um);
        const ale_tile_range_t most = ale_tile_range_around(place, 17000000, side_um);
        ASSERT_TRUE(range.first_x <= least.first_x && range.last_x >= least.last_x &&
                    range.first_y <= least.first_y && range.last_y >= least.last_y);
        ASSERT_TRUE(range.first_x >= most.first_x && range.last_x <= most.last_x &&
                    range.first_y >= most.first_y && range.last_y <= most.last_y);
    }
}

// How far inside the box the segment comes at least: its part within is clipped out; negative: it does not.
double inside_m(const ale_box_t &box, ale_point_t a, ale_point_t b, double grown_m)
{
    const double min[] = {static_cast<double>(box.min_x_um) * 1e-6 - grown_m,
                          static_cast<double>(box.min_y_um) * 1e-6 - grown_m};
    const double max[] = {static_cast<double>(box.max_x_um) * 1e-6 + grown_m,
                          static_cast<double>(box.max_y_um) * 1e-6 + grown_m};
    const double from[] = {a.x_um * 1e-6, a.y_um * 1e-6};
    const double to[] = {b.x_um * 1e-6, b.y_um * 1e-6};
    double first = 0;
    double last = 1;
    for (int k = 0; k < 2; k++) {
        const double d = to[k] - from[k];
        if (d == 0) {
            if (from[k] < min[k] || from[k] > max[k]) {
                return -1;
            }
            continue;
        }
        const double one = (min[k] - from[k]) / d;
        const double other = (max[k] - from[k]) / d;
        first = std::max(first, std::min(one, other));
        last = std::min(last, std::max(one, other));
    }
    return last - first;
}

TEST(TileGrid, AWallTouchesATileAsGeometrySaysToAFewMillimetres)
{
    std::mt19937 random(11);
    std::uniform_int_distribution<int32_t> near(-30000000, 30000000);
    std::uniform_int_distribution<int32_t> far(-(1 << 30), 1 << 30);
    std::uniform_int_distribution<int32_t> tile(-3, 3);
    int touching = 0;
    int clear = 0;
    for (int k = 0; k < 200000; k++) {
        auto &at = k % 4 == 0 ? far : near;
        const ale_point_t a = {at(random), at(random)};
        const ale_point_t b =
            k % 3 == 0 ? ale_point_t{a.x_um, at(random)} : ale_point_t{at(random), at(random)};
        const int32_t x = tile(random);
        const int32_t y = tile(random);
        const ale_box_t box = ale_tile_range_box({x, y, x, y}, side_um);
        const bool surely = inside_m(box, a, b, -0.004) > 0;
        const bool maybe = inside_m(box, a, b, 0.004) >= 0;
        if (surely == maybe) {
            ASSERT_EQ(ale_box_touches(&box, a, b), surely) << k;
            touching += surely;
            clear++;
        }
    }
    EXPECT_GT(touching, 5000);
    EXPECT_GT(clear, 190000);
}

TEST(TileGrid, WhatTouchesATileTouchesEveryRangeThatHasIt)
{
    std::mt19937 random(12);
    std::uniform_int_distribution<int32_t> at(-40000000, 40000000);
    std::uniform_int_distribution<int32_t> tile(-3, 2);
    std::uniform_int_distribution<int32_t> more(0, 3);
    for (int k = 0; k < 100000; k++) {
        const ale_point_t a = {at(random), at(random)};
        const ale_point_t b = {at(random), at(random)};
        const int32_t x = tile(random);
        const int32_t y = tile(random);
        const ale_box_t one = ale_tile_range_box({x, y, x, y}, side_um);
        const ale_box_t all = ale_tile_range_box(
            {x - more(random), y - more(random), x + more(random), y + more(random)}, side_um);
        ASSERT_TRUE(!ale_box_touches(&one, a, b) || ale_box_touches(&all, a, b)) << k;
    }
}

} // namespace
