// lib/graph/optimise/thinning: which keyframe is removed first.
#include <gtest/gtest.h>

#include "graph/optimise/thinning.h"

namespace
{

TEST(Thinning, TheOneWithMostNeighboursGoesFirst)
{
    const std::vector<ale::Pose> poses = {{0, 0, 0}, {5, 0, 0}, {9.5, 0, 0}, {10, 0, 0}, {10.5, 0, 0}};
    EXPECT_EQ(ale::most_redundant(poses, std::vector<bool>(5, true)), 3U);
}

TEST(Thinning, OfEqualsTheOldestGoesFirst)
{
    const std::vector<ale::Pose> poses = {{0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {5, 0, 0}};
    EXPECT_EQ(ale::most_redundant(poses, std::vector<bool>(4, true)), 1U);
}

TEST(Thinning, TheSamePlaceWithAnotherHeadingIsAnotherView)
{
    const std::vector<ale::Pose> poses = {{0, 0, 0}, {0, 0, 3}, {5, 0, 3.1}, {5, 0.9, -3.1}};
    EXPECT_EQ(ale::most_redundant(poses, std::vector<bool>(4, true)), 2U);
}

TEST(Thinning, OnlyRemovableOnes)
{
    const std::vector<ale::Pose> poses = {{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {8, 0, 0}};
    EXPECT_EQ(ale::most_redundant(poses, {false, false, false, true}), 3U);
    EXPECT_EQ(ale::most_redundant(poses, std::vector<bool>(4, false)), std::nullopt);
    EXPECT_EQ(ale::most_redundant({}, {}), std::nullopt);
}

} // namespace
