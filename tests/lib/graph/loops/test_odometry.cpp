// lib/graph/loops/odometry: edges along the path, and how far a robot gets.
#include <gtest/gtest.h>

#include "graph/loops/odometry.h"

namespace
{

ale::Node node_at(double seconds, uint32_t map_id)
{
    ale::Node node{};
    node.stamp_us = static_cast<int64_t>(seconds * 1e6);
    node.map_id = map_id;
    return node;
}

TEST(Odometry, AnEdgeBetweenTwoMapsIsAsItWasGuessed)
{
    ale::Node here = node_at(1, 1);
    here.guess = ale::Guess::led;
    EXPECT_EQ(ale::odometry_edge(1, node_at(0, 0), here, {1, 0, 0}).guess, ale::Guess::led);
    EXPECT_EQ(ale::odometry_edge(1, node_at(0, 1), here, {1, 0, 0}).guess, ale::Guess::none);
}

TEST(Odometry, ARobotGetsAsFarAsItsFastestPaceInTheTime)
{
    ale::Pace pace;
    EXPECT_EQ(pace.reach_m(node_at(0, 0), node_at(10, 1)), ale::Pace::endless_m) << "no pace is known";
    pace.add(node_at(0, 0), node_at(1, 0), {0.5, 0, 0});
    pace.add(node_at(1, 0), node_at(3, 0), {0.6, 0, 0});
    pace.add(node_at(3, 0), node_at(4, 1), {9, 0, 0}); // a guess between two maps
    ale::Node broken = node_at(5, 1);
    broken.broken = true;
    pace.add(node_at(4, 1), broken, {9, 0, 0});
    pace.add(node_at(5, 1), node_at(5, 1), {9, 0, 0}); // no time
    const double far_m = pace.reach_m(node_at(0, 0), node_at(20, 1));
    const double near_m = pace.reach_m(node_at(0, 0), node_at(10, 1));
    EXPECT_NEAR(far_m - near_m, 10 * 0.5 * 1.25, 1e-9);
    EXPECT_GT(near_m, 10 * 0.5 * 1.25);
    EXPECT_EQ(pace.reach_m(node_at(20, 0), node_at(20, 1)), ale::Pace::endless_m) << "nor a time";
}

} // namespace
