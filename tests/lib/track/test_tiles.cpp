// lib/track in a map of tiles: where nothing is said of its place the robot does not guess, and a tile that
// comes late neither loses it nor doubles a wall.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "map/tile_change.h"
#include "track/pipeline_state.h"
}

namespace
{

const size_t all = room::l_shape().size();

/* A robot that drives in the room, whose walls lie in tiles. */
struct Robot {
    room::Pipeline p = room::make(ale_pipeline_default_config());
    std::unique_ptr<ale_tile_change_t> piece = std::make_unique<ale_tile_change_t>();
    ale_estimate_t last = {};
    std::mt19937 rng{7};
    room::Sensor sensor;
    double t = 1;
    double carried_s = 0;             // so far along its path,
    reference::Pose counted{0, 0, 0}; // and what wheels count in is still where it was

    explicit Robot(bool known)
    {
        sensor.noise = 0.003;
        ale_pipeline_load_tiles(p.get(), convert::pose(room::path(t)), known);
        piece->epoch = p->epoch;
        piece->last = true;
        piece->window = {-20000000, -20000000, 20000000, 20000000};
    }
    void scan()
    {
        const auto path = [this](double at_s) { return room::path(at_s + carried_s); };
        const ale_odometry_t wheels = {std::llround(t * 1e6),
                                       convert::pose(reference::compose(counted, path(t)))};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &last);
        t += 0.1;
    }
    /* Both sides of some walls of the room. */
    void put_walls(size_t from, size_t to)
    {
        const auto walls = room::l_shape();
        for (size_t k = from; k < to; k++) {
            const ale_point_t a = {convert::um(walls[k].x1), convert::um(walls[k].y1)};
            const ale_point_t b = {convert::um(walls[k].x2), convert::um(walls[k].y2)};
            for (const bool back : {false, true}) {
                ale_map_line_t &line = piece->line[piece->line_count++];
                line = {};
                line.id = static_cast<uint32_t>(2 * k + 1 + back);
                line.start = back ? b : a;
                line.end = back ? a : b;
                line.var_alpha_nrad2 = 4000000000000;
                line.var_rho_um2 = 4000000;
                line.seen = 9;
            }
        }
    }
    bool change()
    {
        const bool taken = ale_pipeline_change_tiles(p.get(), piece.get());
        piece->line_count = taken ? 0 : piece->line_count;
        piece->gone_count = taken ? 0 : piece->gone_count;
        return taken;
    }
    void carry(double seconds)
    {
        const reference::Pose here = room::path(t + carried_s);
        carried_s += seconds;
        const reference::Pose there = room::path(t + carried_s);
        counted = reference::compose(reference::compose(counted, here), reference::inverse(there));
    }
    double off_m() const
    {
        return (convert::pose(last.map) - room::path(t - 0.1 + carried_s)).head<2>().norm();
    }
    /* Good at every scan is right. */
    int good_scans(int scans)
    {
        int good = 0;
        for (int k = 0; k < scans; k++) {
            scan();
            good += last.state == ALE_STATE_GOOD;
            EXPECT_TRUE(last.state != ALE_STATE_GOOD || off_m() < 0.05) << k << ": " << off_m();
        }
        return good;
    }
    bool is_good_in_all()
    {
        put_walls(0, all);
        const bool taken = change();
        good_scans(30);
        return taken && last.state == ALE_STATE_GOOD;
    }
    /* A piece is there after every scan. It waits for one that was not searched, which is the next; how often
     * it has. */
    int waits(int scans)
    {
        int waits = 0;
        for (int k = 0; k < scans; k++) {
            const bool waited = p->tile_waits;
            good_scans(1);
            EXPECT_FALSE(waited && p->searched) << k;
            const bool taken = change();
            EXPECT_EQ(taken, !p->searched) << k;
            waits += !taken;
        }
        return waits;
    }
};

TEST(Tiles, ARobotOfUnknownPlaceIsFoundOnlyOnceAllOfTheMapIsThere)
{
    Robot robot(false);
    robot.put_walls(0, all);
    ASSERT_TRUE(robot.change());
    robot.good_scans(150);
    EXPECT_EQ(robot.last.state, ALE_STATE_LOST) << "a tile that is not loaded may look like this";
    robot.piece->whole = true;
    ASSERT_TRUE(robot.change());
    robot.good_scans(150);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
}

TEST(Tiles, ARobotThatIsSaidToBeSomewhereIsFoundThereWhenTheTilesHaveCome)
{
    Robot robot(true);
    EXPECT_EQ(robot.good_scans(30), 0);
    robot.put_walls(0, all);
    ASSERT_TRUE(robot.change());
    EXPECT_GT(robot.good_scans(30), 15);
    EXPECT_EQ(robot.last.map_id, 0U);
}

TEST(Tiles, ATileThatComesLateDoublesNoWallAndLosesNobody)
{
    Robot robot(true);
    ASSERT_TRUE(robot.is_good_in_all());
    for (uint32_t id = 1; id <= 8; id++) { // four sides of the room
        robot.piece->gone[robot.piece->gone_count++] = id;
    }
    ASSERT_TRUE(robot.change());
    EXPECT_EQ(robot.good_scans(100), 100);
    const uint32_t maps = robot.last.maps;
    const auto of_drive = [&robot] {
        const ale_local_map_t &map = robot.p->map;
        return std::count_if(map.wall, map.wall + map.count,
                             [](const ale_wall_t &wall) { return wall.prior_id == 0 && wall.seen > 10; });
    };
    EXPECT_GE(of_drive(), 3) << "mapped by the robot meanwhile";
    robot.put_walls(0, 4);
    ASSERT_TRUE(robot.change());
    EXPECT_EQ(of_drive(), 0);
    EXPECT_EQ(robot.good_scans(100), 100);
    EXPECT_EQ(of_drive(), 0);
    EXPECT_EQ(robot.last.maps, maps);
}

TEST(Tiles, APieceWaitsForItsScanAndOneOfAnotherMapIsVoid)
{
    Robot robot(false);
    robot.piece->due = 3;
    robot.put_walls(0, all);
    EXPECT_FALSE(ale_pipeline_change_tiles(robot.p.get(), robot.piece.get()));
    robot.good_scans(3);
    EXPECT_TRUE(ale_pipeline_change_tiles(robot.p.get(), robot.piece.get()));
    const uint16_t walls = robot.p->map.count;
    EXPECT_GE(walls, robot.piece->line_count);
    robot.piece->epoch++;
    EXPECT_TRUE(robot.change());
    EXPECT_EQ(robot.p->map.count, walls);
    ale_pipeline_reset(robot.p.get());
    ale_whereabouts_t whereabouts;
    robot.scan();
    EXPECT_FALSE(ale_pipeline_whereabouts(robot.p.get(), &whereabouts)) << "its map is its own again";
}

TEST(Tiles, AScanThatIsSearchedTakesNoPieceAndALostRobotIsFoundMeanwhile)
{
    Robot robot(false);
    robot.put_walls(0, all);
    robot.piece->whole = true;
    ASSERT_TRUE(robot.change());
    EXPECT_GT(robot.waits(300), 5);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
}

TEST(Tiles, AScanThatTheMapDoesNotExplainTakesNoPieceButTheNextOneDoes)
{
    Robot robot(true);
    ASSERT_TRUE(robot.is_good_in_all());
    ale_pipeline_freeze_map(robot.p.get(), true);
    for (uint32_t id = 1; id <= 12; id++) { // most of the room
        robot.piece->gone[robot.piece->gone_count++] = id;
    }
    ASSERT_TRUE(robot.change());
    EXPECT_GT(robot.waits(60), 20);
    robot.put_walls(0, 6);
    robot.waits(2);
    EXPECT_EQ(robot.waits(30), 0);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
}

TEST(Tiles, WhatAScanHasProposedStandsWhileAPieceIsTaken)
{
    Robot robot(true);
    ASSERT_TRUE(robot.is_good_in_all());
    robot.carry(2);
    EXPECT_GT(robot.waits(30), 0);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(robot.last.map_id, 0U);
}

TEST(Tiles, WhereTheRobotIsIsSaidNowAndThen)
{
    Robot robot(true);
    ale_whereabouts_t whereabouts = {};
    EXPECT_FALSE(ale_pipeline_whereabouts(robot.p.get(), &whereabouts));
    int said = 0;
    for (uint32_t k = 0; k < 20; k++) {
        robot.scan();
        if (ale_pipeline_whereabouts(robot.p.get(), &whereabouts)) {
            EXPECT_EQ(whereabouts.scan, k);
            EXPECT_EQ(whereabouts.epoch, robot.last.epoch);
            EXPECT_EQ(whereabouts.pose.x_um, robot.last.map.x_um);
            EXPECT_EQ(whereabouts.reach_um, 5600000 + ALE_TILE_MARGIN_UM);
            said++;
        }
    }
    EXPECT_EQ(said, 20 / ALE_WHEREABOUTS_SCANS);
}

} // namespace
