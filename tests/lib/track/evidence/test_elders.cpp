// lib/track/evidence/elders: what has come while the robot stood.
#include <memory>

#include <gtest/gtest.h>

extern "C" {
#include "base/trig.h"
#include "track/evidence/elders.h"
}

#include "lib/track/evidence/round_room.h"

namespace
{

/* A line straight ahead, square to the beam. */
ale_observation_t line_ahead(double range_m)
{
    ale_observation_t observation = {};
    observation.centre = {static_cast<int32_t>(range_m * 1e6), 0};
    observation.normal_bam = 0x80000000u;
    observation.start_um = -150000;
    observation.end_um = 150000;
    observation.kind = ALE_OBSERVATION_LINE;
    return observation;
}

class Elders : public testing::Test
{
  protected:
    void SetUp() override
    {
        ale_elders_clear(elders.get());
        map->wall[7].start_um = -1000000;
        map->wall[7].end_um = 1000000;
        map->wall[7].seen = 1000;
    }
    ale_seen_t seen(const ale_scan_t &scan) const
    {
        return {{&scan, nullptr, robot}, robot, observation, observations};
    }
    void keep(double range_m, double from_s, double to_s)
    {
        for (double t = from_s; t < to_s; t += 1) {
            const auto scan = round_room(range_m, t);
            const ale_seen_t now = seen(*scan);
            ale_elders_keep(elders.get(), &now);
        }
    }
    /* Whether a line so far ahead may begin a wall at that time. */
    bool may_begin(double range_m, double seconds, uint16_t wall = ALE_NO_WALL)
    {
        const auto scan = round_room(range_m, seconds);
        observation[0] = line_ahead(range_m);
        observation[1] = line_ahead(4);
        association[0].wall = wall;
        association[1].wall = 7;
        observations = 2;
        const ale_seen_t now = seen(*scan);
        const uint32_t left =
            ale_elders_drop_newcomers(elders.get(), map.get(), &now, rests, observation, association);
        EXPECT_EQ(association[left - 1].wall, 7) << "what has a wall stays, with its match";
        EXPECT_EQ(observation[left - 1].centre.x_um, 4000000);
        return left == 2;
    }

    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    bool rests = false;
    std::unique_ptr<ale_elders_t> elders = std::make_unique<ale_elders_t>();
    ale_pose_t robot = {0, 0, 0};
    ale_observation_t observation[2] = {};
    ale_association_t association[2] = {};
    uint32_t observations = 0;
};

TEST_F(Elders, WhatHasComeBeginsNoWall)
{
    keep(4, 0, 30);
    EXPECT_FALSE(may_begin(2, 30));
    EXPECT_TRUE(may_begin(4, 30)) << "always there";
    EXPECT_TRUE(may_begin(5, 30)) << "was hidden";
    EXPECT_TRUE(may_begin(2, 30, 3)) << "is in the map already";
}

TEST_F(Elders, ARobotAtRestTellsWhoStandsBeforeAWall)
{
    keep(2.15, 0, 30);
    EXPECT_TRUE(may_begin(2, 30)) << "on the way a map may err by as much";
    rests = true;
    EXPECT_FALSE(may_begin(2, 30));
    EXPECT_TRUE(may_begin(2.1, 30));
}

TEST_F(Elders, ARobotAtRestAsksForYoungAndGrowingWallsToo)
{
    keep(4, 0, 30);
    rests = true;
    map->wall[3] = {};
    map->wall[3].start_um = -150000;
    map->wall[3].end_um = 150000;
    map->wall[3].seen = 5;
    EXPECT_FALSE(may_begin(2, 30, 3)) << "young";
    map->wall[3].seen = 500;
    EXPECT_TRUE(may_begin(2, 30, 3));
    map->wall[3].end_um = 50000;
    EXPECT_FALSE(may_begin(2, 30, 3)) << "longer than the wall";
}

TEST_F(Elders, WhereNothingAnsweredBeforeSomethingHasCome)
{
    const auto scan = round_room(4, 0);
    for (int k = 0; k < scan->beams; k++) {
        scan->flag[k] = ALE_BEAM_NO_RETURN;
    }
    const ale_seen_t before = seen(*scan);
    ale_elders_keep(elders.get(), &before);
    EXPECT_TRUE(may_begin(2, 30)) << "on the way it may have been dark";
    rests = true;
    EXPECT_FALSE(may_begin(2, 30));
}

TEST_F(Elders, WithoutAnElderEverythingMayBegin)
{
    EXPECT_TRUE(may_begin(2, 0));
}

TEST_F(Elders, WhoStandsForMinutesIsStillNoWall)
{
    keep(4, 0, 400);
    keep(2, 400, 580);
    EXPECT_FALSE(may_begin(2, 580));
}

TEST_F(Elders, WhoStoodThereFirstIsNoWallWhenHeComesBack)
{
    keep(2, 0, 20);
    keep(4, 20, 60);
    EXPECT_FALSE(may_begin(2, 60));
}

TEST_F(Elders, WhatStaysForAnHourIsAWall)
{
    keep(4, 0, 100);
    keep(2, 100, 3700);
    EXPECT_TRUE(may_begin(2, 3700));
}

TEST_F(Elders, FromAnotherPlaceTheySayNothing)
{
    keep(4, 0, 30);
    robot = {200000, 0, 0};
    EXPECT_TRUE(may_begin(2, 30));
    robot = {0, 0, 5 * ALE_BAM_PER_DEGREE};
    EXPECT_TRUE(may_begin(2, 30));
}

} // namespace
