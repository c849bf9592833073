/* What scans saw, laid out as they come: once, at their own pose, and anew where the map has taken a step. */
#include "common/feed/seen_space.h"

#include <gtest/gtest.h>

using feed::SeenSpace;
using Cell = ale::ScanCloud::Cell;

namespace
{

/* One beam ahead, to a wall 2 m away. */
ale::scan_t scan_of(int32_t number)
{
    ale::scan_t scan{};
    scan.scan = number;
    scan.step = 0.01F;
    scan.range_max = 4;
    scan.range_unit_mm = 1;
    scan.range_mm = {2000};
    scan.codes = {0};
    scan.num_ranges = scan.num_codes = 1;
    return scan;
}

ale::pose_t pose_of(int32_t number, float x, float map_x)
{
    ale::pose_t pose{};
    pose.utime = int64_t{number} * 100000;
    pose.scan = number;
    pose.state = 2;
    pose.x = x;
    pose.map_x = map_x;
    return pose;
}

ale::tracking_t tracking_of(int32_t number, int32_t map_id)
{
    ale::tracking_t tracking{};
    tracking.scan = number;
    tracking.map_id = map_id;
    tracking.maps = 1;
    return tracking;
}

/* Whether something was laid out. */
bool take(SeenSpace &space, int32_t number, float x, float map_x, int32_t map_id = 0)
{
    bool laid = space.take(pose_of(number, x, map_x));
    laid = space.take(tracking_of(number, map_id)) || laid;
    return space.take(scan_of(number)) || laid;
}

/* At so many metres ahead of the map's origin. */
Cell cell_at(const SeenSpace &space, double x)
{
    return space.cloud().cell(static_cast<int32_t>(x / 0.05), 0);
}

} // namespace

TEST(SeenSpace, BeamsLeaveCellsFreeAndEndInWalls)
{
    SeenSpace space;
    EXPECT_TRUE(take(space, 0, 0, 0));
    EXPECT_TRUE(take(space, 1, 0, 0));
    EXPECT_EQ(cell_at(space, 1.0), Cell::free);
    EXPECT_EQ(cell_at(space, 2.01), Cell::occupied);
    EXPECT_EQ(cell_at(space, 2.5), Cell::unknown);
}

TEST(SeenSpace, WhatBelongsTogetherMayComeInAnyOrder)
{
    SeenSpace space;
    EXPECT_FALSE(space.take(scan_of(3)));
    EXPECT_FALSE(space.take(tracking_of(2, 0)));
    EXPECT_FALSE(space.take(pose_of(3, 0, 0)));
    EXPECT_TRUE(space.take(tracking_of(3, 0)));
    EXPECT_FALSE(space.take(tracking_of(3, 0))) << "once";
}

TEST(SeenSpace, AnotherMapIsNotLaidOverTheFirst)
{
    SeenSpace space;
    EXPECT_FALSE(take(space, 0, 0, 0, 1));
    EXPECT_TRUE(space.cloud().empty());
}

TEST(SeenSpace, ARobotThatStandsAddsNoMoreUntilItMoves)
{
    SeenSpace space;
    int laid = 0;
    for (int32_t k = 0; k < 20; k++) {
        laid += take(space, k, 0, 0);
    }
    EXPECT_EQ(laid, 4);
    EXPECT_TRUE(take(space, 20, 0.03F, 0.03F));
}

TEST(SeenSpace, AStepOfTheMapPoseBeginsAnewAndDrivingDoesNot)
{
    SeenSpace space;
    for (int32_t k = 0; k < 3; k++) {
        take(space, k, 0.05F * static_cast<float>(k), 0.05F * static_cast<float>(k));
    }
    EXPECT_EQ(cell_at(space, 1), Cell::free);
    take(space, 3, 0.15F, 0.45F);
    EXPECT_EQ(cell_at(space, 1), Cell::unknown) << "the map moved";
    take(space, 4, 0.2F, 0.5F);
    EXPECT_EQ(cell_at(space, 1), Cell::free);
    take(space, 5, 5, 5.3F);
    EXPECT_EQ(cell_at(space, 1), Cell::unknown) << "no robot drives so fast: its map was forgotten";
}

TEST(SeenSpace, AMapThatBeginsWithAnotherScanBeginsAnewThoughTheRobotStands)
{
    SeenSpace space;
    ale::graph_t graph{};
    EXPECT_FALSE(space.take(graph)) << "no keyframe yet";
    graph.scan = {0};
    EXPECT_FALSE(space.take(graph));
    take(space, 0, 0, 0);
    take(space, 1, 0, 0);
    graph.scan = {0, 1};
    EXPECT_FALSE(space.take(graph));
    EXPECT_EQ(cell_at(space, 1), Cell::free);
    graph.scan = {2};
    EXPECT_TRUE(space.take(graph));
    EXPECT_EQ(cell_at(space, 1), Cell::unknown);
}
