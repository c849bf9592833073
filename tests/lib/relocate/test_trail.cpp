// lib/relocate/trail: what a lost robot has seen on its way, against the walls of a map.
#include <memory>

#include <gtest/gtest.h>

#include "lib/map/walls.h"
#include "lib/motion/convert.h"

extern "C" {
#include "match/association.h"
#include "relocate/trail.h"
}

namespace
{

// Four walls about the origin: a room of 6 m by 4 m, and one of 6 m by 4 m beside it without its east wall.
std::unique_ptr<ale_local_map_t> two_rooms()
{
    auto map = std::make_unique<ale_local_map_t>();
    ale_local_map_clear(map.get());
    for (const double x : {0.0, 20.0}) {
        const double walls[4][4] = {{x - 3, 0, 0, 2},
                                    {x, 2, -reference::pi / 2, 3},
                                    {x, -2, reference::pi / 2, 3},
                                    {x + 3, 0, reference::pi, 2}};
        for (int k = 0; k < (x > 0 ? 3 : 4); k++) {
            const ale_wall_t wall = make_wall(walls[k][0], walls[k][1], walls[k][2], walls[k][3], 10);
            ale_local_map_add(map.get(), &wall);
        }
    }
    ale_local_map_approach(map.get(), {0, 0}, 100000000);
    ale_local_map_focus(map.get(), {0, 0}, INT32_MAX);
    return map;
}

// What a robot at a pose in the first room sees of it: the walls from..to-1, a metre to either side of the
// middle.
std::vector<ale_observation_t> seen_from(const ale_local_map_t &map, const reference::Pose &p, int from,
                                         int to)
{
    std::vector<ale_observation_t> observations;
    for (int k = from; k < to; k++) {
        const ale_wall_t &wall = map.wall[k];
        const Eigen::Vector2d anchor(wall.anchor.x_um * 1e-6, wall.anchor.y_um * 1e-6);
        const Eigen::Vector2d seen = reference::rotation(-p[2]) * (anchor - p.head<2>());
        ale_observation_t observation = {};
        observation.centre = {convert::um(seen[0]), convert::um(seen[1])};
        observation.normal_bam = convert::bam(convert::radians(wall.normal_bam) - p[2]);
        observation.start_um = -1000000;
        observation.end_um = 1000000;
        observation.var_offset_um2 = 9000000;
        observation.var_angle_urad2 = 9000000;
        observations.push_back(observation);
    }
    return observations;
}

struct Drive {
    std::unique_ptr<ale_local_map_t> map = two_rooms();
    std::unique_ptr<ale_trail_t> trail = std::make_unique<ale_trail_t>();
    reference::Pose at{-1, 0.5, 0.3};

    Drive()
    {
        ale_trail_clear(trail.get());
    }
    void see(int from, int to)
    {
        const auto observations = seen_from(*map, at, from, to);
        ale_trail_keep(trail.get(), observations.data(), static_cast<uint32_t>(observations.size()));
    }
    void go(const reference::Pose &way)
    {
        at.head<2>() += reference::rotation(at[2]) * way.head<2>();
        at[2] += way[2];
        ale_trail_follow(trail.get(), convert::pose(way));
    }
    double explained(double x_aside, int32_t work = ALE_ASSOCIATION_WORK) const
    {
        const ale_pose_t pose = convert::pose(reference::Pose(at[0] + x_aside, at[1], at[2]));
        return ale_trail_explained_q8(trail.get(), map.get(), pose, &work) / 256.0;
    }
};

TEST(Trail, WhatWasSeenBeforeTellsTwoRoomsApartThatLookAlikeNow)
{
    Drive drive;
    drive.see(0, 4); // all four walls
    drive.go({0.8, 0.1, -0.5});
    drive.see(0, 3); // without the one that only the first room has
    EXPECT_EQ(drive.explained(0), 1);
    EXPECT_NEAR(drive.explained(20), 0.75, 0.01);
}

TEST(Trail, TheNewestScanIsNotPartOfWhatWasSeenBefore)
{
    Drive drive;
    drive.see(0, 4);
    EXPECT_EQ(drive.explained(20), 1) << "nothing was seen before";
    drive.go({0.8, 0, 0});
    drive.see(3, 4);
    EXPECT_NEAR(drive.explained(20), 0.75, 0.01);
}

TEST(Trail, ScansLieApartAndTheOldestGoFirst)
{
    Drive drive;
    drive.see(0, 4);
    for (int k = 0; k < 30; k++) {
        drive.go({0.02, 0, 0});
        drive.see(0, 3);
        EXPECT_LE(drive.trail->count, 3U) << k;
    }
    EXPECT_LT(drive.explained(20), 0.99) << "the first scan is kept";
    for (int k = 0; k < ALE_TRAIL_SCANS; k++) {
        drive.go({0, 0, 1.0});
        drive.see(0, 3);
    }
    EXPECT_EQ(drive.trail->count, static_cast<uint32_t>(ALE_TRAIL_SCANS));
    EXPECT_EQ(drive.explained(20), 1) << "the first scan is gone";
}

TEST(Trail, WithoutLooksLeftNothingIsHeldAgainstAPlace)
{
    Drive drive;
    drive.see(0, 4);
    drive.go({0.8, 0, 0});
    drive.see(0, 3);
    EXPECT_EQ(drive.explained(9, 1), 1);
    EXPECT_LT(drive.explained(9), 0.6);
}

} // namespace
