// lib/track/evidence/way_back: has the robot looked, on its way, through what another map holds?
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

extern "C" {
#include "base/trig.h"
#include "track/evidence/way_back.h"
}

#include "lib/track/evidence/round_room.h"

namespace
{

constexpr double room_m = 3; // around the scanner, as far as it looks

ale_pose_t at(double x_m, double y_m, double degrees = 0)
{
    return {static_cast<int32_t>(std::lround(x_m * 1e6)), static_cast<int32_t>(std::lround(y_m * 1e6)),
            static_cast<uint32_t>(static_cast<int64_t>(std::lround(degrees * ALE_BAM_PER_DEGREE)))};
}

class WayBack : public testing::Test
{
  protected:
    void SetUp() override
    {
        ale_way_back_clear(way_back.get());
        ale_local_map_select(map.get(), 0);
    }
    void drive_to(double x_m)
    {
        const auto scan = round_room(room_m, 0);
        for (; driven_m <= x_m; driven_m += 0.05) {
            const ale_pose_t robot = at(driven_m, 0);
            const ale_seen_t seen = {{scan.get(), nullptr, robot}, robot, nullptr, 0};
            ale_way_back_keep(way_back.get(), &seen);
        }
    }
    /* A wall square to the way, 1 m long, in front of who comes along it. */
    void wall_at(double x_m, double y_m, uint8_t of_map = 0)
    {
        ale_wall_t *wall = &map->wall[map->count++];
        *wall = {};
        wall->anchor = {static_cast<int32_t>(x_m * 1e6), static_cast<int32_t>(y_m * 1e6)};
        ale_wall_set_normal(wall, 0x80000000u);
        wall->start_um = -500000;
        wall->end_um = 500000;
        wall->map = of_map;
    }
    double denied_m(ale_pose_t there)
    {
        return static_cast<double>(
                   ale_way_back_denied_um(way_back.get(), map.get(), at(driven_m, 0), there)) /
               1e6;
    }

    std::unique_ptr<ale_way_back_t> way_back = std::make_unique<ale_way_back_t>();
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    double driven_m = 0; // the robot is here, one step after its last scan
};

TEST_F(WayBack, AWallThatTheWayHasLedThroughIsDenied)
{
    drive_to(4);
    wall_at(2, 0);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 1);
}

TEST_F(WayBack, AWallWhereTheScansEndedIsNot)
{
    drive_to(0);
    wall_at(room_m, 0);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 0);
}

TEST_F(WayBack, WhatLiesBehindWhatWasSeenSaysNothing)
{
    drive_to(1);
    wall_at(7, 0);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 0);
}

TEST_F(WayBack, TheWayIsLaidWhereTheRobotIsSupposedToBe)
{
    drive_to(4);
    wall_at(2, 20);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 0);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 20)), 1);
    EXPECT_DOUBLE_EQ(denied_m(at(2, 20 - (driven_m - 2), -90)), 0) << "seen from its end";
}

TEST_F(WayBack, WallsOfOtherMapsAreNotAsked)
{
    drive_to(4);
    wall_at(2, 0, 1);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 0);
}

TEST_F(WayBack, OneWallCountsForTwoMetresAtTheMost)
{
    drive_to(4);
    wall_at(2, 0);
    map->wall[0].start_um = -1500000;
    map->wall[0].end_um = 1500000;
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 2);
}

TEST_F(WayBack, TheWholeOfALongWayIsKept)
{
    drive_to(60);
    EXPECT_LE(way_back->count, static_cast<uint32_t>(ALE_WAY_BACK));
    EXPECT_GT(way_back->count, static_cast<uint32_t>(ALE_WAY_BACK) / 2);
    for (const double x_m : {4.0, 20.0, 40.0, 57.5}) {
        map->count = 0;
        wall_at(x_m, 0);
        EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 1) << x_m;
    }
}

TEST_F(WayBack, ARobotThatStandsKeepsOneScan)
{
    for (int k = 0; k < 100; k++) {
        driven_m = 0;
        drive_to(0.1);
    }
    EXPECT_EQ(way_back->count, 1U);
    ale_way_back_clear(way_back.get());
    wall_at(2, 0);
    EXPECT_DOUBLE_EQ(denied_m(at(driven_m, 0)), 0);
}

} // namespace
