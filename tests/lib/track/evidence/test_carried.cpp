// lib/track/evidence/carried.c: what has come before the scanner and goes along with the robot.
#include <gtest/gtest.h>

#include <functional>

#include "lib/track/room_pipeline.h"

extern "C" {
#include "track/evidence/carried.h"
}

namespace
{
using Held = std::function<double(int beam)>; // how far off something is in a beam; 0: nothing

struct Drive {
    int wrong_while_good = 0;
    bool good_at_end = false;
    double error_at_end = 9;
    int walls = 0;
};

/* Drives for 22 s with something held before the scanner from the 8th to the 14th; or standing in the room
 * since the 8th. */
Drive drive(bool wheels, const Held &determined, const std::vector<room::Wall> &come = {})
{
    std::mt19937 rng(9);
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.use_odometry = wheels;
    const room::Pipeline p = room::make(config);
    room::Sensor sensor;
    sensor.noise = 0.003;
    std::normal_distribution<double> normal;
    std::vector<room::Wall> after = room::l_shape();
    after.insert(after.end(), come.begin(), come.end());
    Drive drive;
    for (int k = 0; k < 220; k++) {
        const double t = 1 + 0.1 * k;
        const reference::Pose truth = room::since_start(room::path(1), room::path(t));
        ale_scan_t scan = room::scan_at(k < 80 ? room::l_shape() : after, sensor, room::path, t, rng);
        for (int beam = 0; k >= 80 && k < 140 && beam < sensor.beams; beam++) {
            const double range = determined(beam);
            if (range > 0 && (scan.range_um[beam] == 0 || scan.range_um[beam] > convert::um(range))) {
                ale_scan_set_range(&scan, static_cast<uint16_t>(beam),
                                   convert::um(range + 0.002 * normal(rng)));
            }
        }
        const ale_odometry_t sample = {std::llround(t * 1e6), convert::pose(truth)};
        ale_pipeline_odometry(p.get(), &sample);
        ale_estimate_t e;
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose error = convert::pose(e.map) - truth;
        const bool right = error.head<2>().norm() < 0.1 && std::abs(reference::wrap(error[2])) < 0.1;
        drive.wrong_while_good += !right && e.state == ALE_STATE_GOOD;
        drive.good_at_end = e.state == ALE_STATE_GOOD;
        drive.error_at_end = error.head<2>().norm();
    }
    const auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(p.get(), map.get());
    drive.walls = map->line_count;
    return drive;
}

double nothing(int /*beam*/)
{
    return 0;
}
} // namespace

/* A round thing held before one half of the scanner while the robot drives: it moves with the robot, and
 * would say that the robot stands. */
TEST(Carried, HalfOfTheScannerCoveredItIsNeverWrongWhileItSaysGood)
{
    const int walls = drive(false, nothing).walls;
    for (const bool wheels : {false, true}) {
        for (const bool left : {false, true}) {
            const Drive d = drive(wheels, [&](int k) { return (k > 341) == left ? 0.25 : 0.0; });
            EXPECT_EQ(d.wrong_while_good, 0) << wheels << left;
            EXPECT_TRUE(d.good_at_end) << wheels << left;
            EXPECT_LT(d.error_at_end, 0.03) << wheels << left;
            EXPECT_LE(d.walls, walls + 2) << wheels << left;
        }
    }
}

/* Tilted forwards, the scanner meets the floor: a straight line ahead that goes along. */
TEST(Carried, TheFloorThatATiltedScannerMeetsIsNoWall)
{
    const int walls = drive(false, nothing).walls;
    for (const double ahead : {0.8, 1.4}) {
        const Drive d = drive(false, [&](int k) {
            const double cosine = std::cos((k - 340) * 2 * reference::pi / 1024);
            return cosine > 0.3 ? ahead / cosine : 0.0;
        });
        EXPECT_EQ(d.wrong_while_good, 0) << ahead;
        EXPECT_TRUE(d.good_at_end) << ahead;
        EXPECT_LT(d.error_at_end, 0.03) << ahead;
        EXPECT_LE(d.walls, walls + 2) << ahead;
    }
}

/* A box that somebody puts down beside the way, and that stays there, is a part of the room. */
TEST(Carried, WhatHasComeAndStandsInTheRoomIsMapped)
{
    const std::vector<room::Wall> box = {
        {-0.2, -1.6, 0.6, -1.6}, {0.6, -1.6, 0.6, -1.9}, {0.6, -1.9, -0.2, -1.9}, {-0.2, -1.9, -0.2, -1.6}};
    const Drive d = drive(false, nothing, box);
    EXPECT_EQ(d.wrong_while_good, 0);
    EXPECT_LT(d.error_at_end, 0.03);
    EXPECT_GT(d.walls, drive(false, nothing).walls);
}

TEST(Carried, BeamsAreBlindAsLongAsTheyShowAboutTheSame)
{
    auto carried = std::make_unique<ale_carried_t>();
    auto scan = std::make_unique<ale_scan_t>();
    scan->beams = 4;
    scan->range_min_um = 20000;
    scan->range_max_um = 5600000;
    carried->any = true;
    carried->beams = 4;
    carried->came_um[1] = carried->came_um[2] = carried->came_um[3] = 300000;
    const int32_t shown_mm[] = {300, 340, 900, 0};
    for (uint16_t k = 0; k < 4; k++) {
        ale_scan_set_range(scan.get(), k, shown_mm[k] * 1000);
    }
    ale_carried_mask(carried.get(), scan.get());
    EXPECT_EQ(scan->flag[0], ALE_BEAM_VALID);
    EXPECT_EQ(scan->flag[1], ALE_BEAM_BLIND);
    EXPECT_EQ(scan->flag[2], ALE_BEAM_VALID);
    EXPECT_EQ(scan->flag[3], ALE_BEAM_NO_RETURN);
    ale_carried_show(carried.get(), scan.get());
    EXPECT_EQ(scan->flag[1], ALE_BEAM_VALID);
    EXPECT_EQ(scan->range_um[1], 340000);
    ale_scan_set_range(scan.get(), 2, 300000);
    ale_carried_mask(carried.get(), scan.get());
    EXPECT_EQ(scan->flag[1], ALE_BEAM_BLIND);
    EXPECT_EQ(scan->flag[2], ALE_BEAM_VALID) << "once it has shown something else it is forgotten";
}
