// lib/map/wall.c: where a wall ends, after many looks.
#include <random>

#include <gtest/gtest.h>

#include "walls.h"

namespace
{

ale_wall_t two_metres()
{
    return make_wall(0, 0, 0, 1);
}

TEST(Wall, IsLengthenedByTheLongestLook)
{
    ale_wall_t wall = two_metres();
    ale_wall_extend(&wall, -1010000, 990000);
    EXPECT_EQ(wall.start_um, -1010000);
    EXPECT_EQ(wall.end_um, 1000000);
}

TEST(Wall, ManyLooksFromOnePlaceDoNotMakeItLonger)
{
    std::mt19937 rng(4);
    std::normal_distribution<double> normal(0, 20000);
    ale_wall_t wall = two_metres();
    for (int look = 0; look < 36000; look++) {
        const bool one_end_is_hidden = look % 3 == 0;
        ale_wall_settle_ends(&wall, one_end_is_hidden ? -300000 : -1000000 + std::lround(normal(rng)),
                             1000000 + std::lround(normal(rng)));
    }
    EXPECT_NEAR(wall.start_um, -1000000, 50000);
    EXPECT_NEAR(wall.end_um, 1000000, 50000);
}

TEST(Wall, ALongerOneIsSeenAtOnce)
{
    ale_wall_t wall = two_metres();
    ale_wall_settle_ends(&wall, -1200000, 1500000);
    EXPECT_EQ(wall.start_um, -1200000);
    EXPECT_EQ(wall.end_um, 1500000);
}

} // namespace
