// lib/graph/loops/free_space: a square room against itself, displaced.
#include <gtest/gtest.h>

#include "graph/loops/free_space.h"

namespace
{

// The walls of a room of 4 by 4 m about the robot, whose sensor sits 0.3 m ahead of its middle.
ale::Node room()
{
    ale::Node node = {};
    node.eye = {0.3, 0};
    for (int k = -100; k <= 100; k++) {
        const double u = 0.02 * k;
        for (const Eigen::Vector2d &p :
             {Eigen::Vector2d(2, u), Eigen::Vector2d(-2, u), Eigen::Vector2d(u, 2), Eigen::Vector2d(u, -2)}) {
            node.points.push_back({p, {0, 0}});
        }
    }
    return node;
}

double share_in_free(const ale::Node &there, const ale::Node &here, const ale::Pose &pose)
{
    ale::Contradiction sum;
    ale::FreeSpace(there).confront(here, pose, &sum);
    return sum.points > 0 ? static_cast<double>(sum.in_free) / sum.points : -1;
}

TEST(FreeSpace, AViewDoesNotContradictItself)
{
    EXPECT_EQ(share_in_free(room(), room(), {0, 0, 0}), 0);
    EXPECT_EQ(share_in_free(room(), room(), {0.05, -0.05, ale::pi / 2}), 0) << "nor turned by a quarter";
}

TEST(FreeSpace, AWallWhereNothingWasIsAContradiction)
{
    EXPECT_GT(share_in_free(room(), room(), {1, 0, 0}), 0.3);
    EXPECT_GT(share_in_free(room(), room(), {0, 0, ale::pi / 4}), 0.1);
}

TEST(FreeSpace, WhatLiesBehindAWallOrOutOfViewIsNone)
{
    EXPECT_EQ(share_in_free(room(), room(), {9, 0, 0}), -1) << "nothing of it is within the view";
    EXPECT_EQ(share_in_free(ale::Node{}, room(), {0, 0, 0}), -1) << "who sees nothing contradicts nothing";
}

TEST(FreeSpace, ReachesAsFarAsTheFirstSurfaceAndNotWhereNothingWasSeen)
{
    const ale::FreeSpace space(room());
    EXPECT_TRUE(space.reaches({1.0, 0.5})) << "within the room";
    EXPECT_TRUE(space.reaches({2.0, 1.0})) << "on its wall";
    EXPECT_FALSE(space.reaches({2.5, 0})) << "behind its wall";
    EXPECT_FALSE(ale::FreeSpace(ale::Node{}).reaches({1.0, 0.5})) << "who sees nothing reaches nothing";
}

} // namespace
