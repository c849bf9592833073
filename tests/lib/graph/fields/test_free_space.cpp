// lib/graph/fields/free_space: a square room against itself, displaced.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/fields/free_space.h"

namespace
{

// The walls of a room of 4 by 4 m about the robot, whose sensor sits 0.3 m ahead of its middle.
ale::Node room()
{
    ale::Node node = {};
    node.sensor = {0.3, 0};
    for (int k = -100; k <= 100; k++) {
        const double u = 0.02 * k;
        for (const Eigen::Vector2d &p :
             {Eigen::Vector2d(2, u), Eigen::Vector2d(-2, u), Eigen::Vector2d(u, 2), Eigen::Vector2d(u, -2)}) {
            node.points.push_back({p, {0, 0}});
        }
    }
    return node;
}

double violating_part(const ale::Node &there, const ale::Node &here, const ale::Pose &pose)
{
    ale::FreeSpaceCheck sum;
    ale::FreeSpace(there).check(here, pose, &sum);
    return sum.points > 0 ? static_cast<double>(sum.violations) / sum.points : -1;
}

TEST(FreeSpace, AViewDoesNotViolateItsOwnFreeSpace)
{
    EXPECT_EQ(violating_part(room(), room(), {0, 0, 0}), 0);
    EXPECT_EQ(violating_part(room(), room(), {0.05, -0.05, ale::pi / 2}), 0) << "nor turned by a quarter";
}

TEST(FreeSpace, AWallInFreeSpaceIsAViolation)
{
    EXPECT_GT(violating_part(room(), room(), {1, 0, 0}), 0.3);
    EXPECT_GT(violating_part(room(), room(), {0, 0, ale::pi / 4}), 0.1);
}

TEST(FreeSpace, PointsBehindAWallOrOutOfViewAreNoViolation)
{
    EXPECT_EQ(violating_part(room(), room(), {9, 0, 0}), -1) << "nothing of it is within the view";
    EXPECT_EQ(violating_part(ale::Node{}, room(), {0, 0, 0}), -1) << "an empty view has no free space";
}

TEST(FreeSpace, InViewIsWhatLiesBeforeTheFirstSurface)
{
    const ale::FreeSpace space(room());
    EXPECT_TRUE(space.has_in_view({1.0, 0.5})) << "within the room";
    EXPECT_TRUE(space.has_in_view({2.0, 1.0})) << "on its wall";
    EXPECT_FALSE(space.has_in_view({2.5, 0})) << "behind its wall";
    EXPECT_FALSE(ale::FreeSpace(ale::Node{}).has_in_view({1.0, 0.5})) << "an empty view";
}

// One surface in the middle of each sector in turn, and points on either side of the sector's edges.
TEST(FreeSpace, ASectorIsADegreeOfBearing)
{
    const auto towards = [](double degrees, double range_m) {
        const double bearing = degrees * ale::pi / 180;
        return Eigen::Vector2d(range_m * std::cos(bearing), range_m * std::sin(bearing));
    };
    for (int k = 0; k < 360; k++) {
        ale::Node node = {};
        node.points.push_back({towards(k + 0.5, 2), {0, 0}});
        const ale::FreeSpace space(node);
        for (const double edge : {0.001, 0.999}) {
            EXPECT_TRUE(space.has_in_view(towards(k + edge, 1))) << k;
        }
        for (const double beyond : {-0.001, 1.001}) {
            EXPECT_FALSE(space.has_in_view(towards(k + beyond, 1))) << k;
        }
    }
}

} // namespace
