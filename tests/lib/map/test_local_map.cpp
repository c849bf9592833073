// lib/map/local_map.c, landmarks.c, map_corner.c, tracking_monitor.c, visibility.c: the map in bounded
// memory.
#include <memory>

#include <gtest/gtest.h>

#include "lib/track/room.h"
#include "lib/track/walls.h"

extern "C" {
#include "map/local_map.h"
#include "map/visibility.h"
#include "match/association.h"
#include "track/tracking_monitor.h"
}

namespace
{
struct Map : testing::Test {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    void SetUp() override
    {
        ale_local_map_clear(map.get());
    }
    uint16_t add(double x, double y, double normal, double half, uint32_t seen = 5)
    {
        ale_wall_t w = make_wall(x, y, normal, half, seen);
        w.last_scan = map->count;
        return ale_local_map_add(map.get(), &w);
    }
};
} // namespace

TEST_F(Map, ListsTheNearWallsByTheDirectionTheyFace)
{
    add(1, 0, reference::pi, 1);
    add(0, 1, -reference::pi / 2, 1);
    add(50, 0, reference::pi, 1);
    ale_local_map_approach(map.get(), {0, 0}, 5000000);
    EXPECT_EQ(map->near_first[ALE_MAP_DIRECTIONS], 2);
    ale_range_t facing[2];
    ale_local_map_facing(map->near_first, convert::bam(-reference::pi / 2), 0, facing);
    ASSERT_EQ(facing[0].last - facing[0].first, 1);
    EXPECT_EQ(map->near[facing[0].first], 1);
    EXPECT_EQ(facing[1].last, facing[1].first);
    ale_local_map_approach(map.get(), {50000000, 0}, 5000000);
    EXPECT_EQ(map->near_first[ALE_MAP_DIRECTIONS], 1);
}

TEST_F(Map, JoinsTwoPiecesOfOneWallAndKeepsTheOlder)
{
    const uint32_t id = map->wall[add(0, 2, -reference::pi / 2, 1)].id;
    add(1.5, 2.002, -reference::pi / 2 + 0.001, 1);
    ale_local_map_approach(map.get(), {0, 0}, 5000000);
    int32_t work = ALE_ASSOCIATION_WORK;
    EXPECT_TRUE(ale_local_map_merge_at(map.get(), 1, &work));
    ASSERT_EQ(map->count, 1);
    EXPECT_EQ(map->wall[0].id, id);
    EXPECT_NEAR(map->wall[0].end_um - map->wall[0].start_um, 3500000, 5000);
    EXPECT_EQ(map->wall[0].seen, 10u);
}

TEST_F(Map, NeverJoinsTheTwoSidesOfAPanelOrWallsApart)
{
    add(0, 2, reference::pi / 2, 1);
    add(0, 1.98, -reference::pi / 2, 1);
    add(0, 2.08, reference::pi / 2, 1);
    add(3, 2, reference::pi / 2, 1);
    ale_local_map_approach(map.get(), {0, 0}, 8000000);
    for (uint16_t i = 0; i < 4; i++) {
        int32_t work = ALE_ASSOCIATION_WORK;
        EXPECT_FALSE(ale_local_map_merge_at(map.get(), i, &work)) << i;
    }
}

TEST_F(Map, WhenFullTheOldestUnconfirmedWallMakesRoomAndThenWallsAreRefused)
{
    for (int i = 0; i < ALE_MAP_MAX_LINES; i++) {
        add(0.01 * i, 0, 0.001 * i, 1, i == 700 ? 1 : 5);
    }
    EXPECT_EQ(map->count, ALE_MAP_MAX_LINES);
    EXPECT_EQ(add(9, 9, 0, 1), 700);
    EXPECT_EQ(map->refused, 0u);
    EXPECT_EQ(add(9, 9, 0, 1), ALE_NO_WALL);
    EXPECT_EQ(map->refused, 1u);
    EXPECT_EQ(map->count, ALE_MAP_MAX_LINES);
}

TEST_F(Map, MarksAreFoundByPlaceAndDirectionAndAveraged)
{
    ale_landmarks_add(&map->landmarks, &(const ale_landmark_t &)ale_landmark_t{
                                           {1000000, -50000}, convert::bam(0), 1, 9000000, 1, 0, 0, 0});
    EXPECT_EQ(ale_landmarks_find(&map->landmarks, {1200000, -50000}, 0, false, 100000), ALE_NO_LANDMARK);
    EXPECT_EQ(ale_landmarks_find(&map->landmarks, {1020000, -60000}, convert::bam(2), false, 100000),
              ALE_NO_LANDMARK);
    const int32_t found =
        ale_landmarks_find(&map->landmarks, {1020000, -60000}, convert::bam(0.3), false, 100000);
    ASSERT_NE(found, ALE_NO_LANDMARK);
    ale_landmark_observe(&map->landmarks.landmark[found], {1020000, -50000}, convert::bam(0), 9000000, 2);
    EXPECT_NEAR(map->landmarks.landmark[found].p.x_um, 1010000, 1);
    EXPECT_EQ(map->landmarks.landmark[found].seen, 2);
}

TEST_F(Map, AFullSetOfMarksGivesUpTheLeastSeen)
{
    for (uint16_t i = 0; i < ALE_LANDMARK_WAYS + 1; i++) {
        ale_landmark_t m = {};
        m.p = {10000 + 1000 * i, 10000};
        m.seen = static_cast<uint16_t>(i == 2 ? 1 : 9);
        m.var_um2 = 9000000;
        m.is_point = 1;
        ale_landmarks_add(&map->landmarks, &m);
    }
    EXPECT_EQ(ale_landmarks_find(&map->landmarks, {12000, 10000}, 0, true, 500), ALE_NO_LANDMARK);
    EXPECT_NE(ale_landmarks_find(&map->landmarks, {14000, 10000}, 0, true, 500), ALE_NO_LANDMARK);
}

TEST_F(Map, CornersAreMetAgainAndConfirmed)
{
    ale_features_t f = {};
    f.corner_count = 1;
    f.corner[0].p = {1000000, 500000};
    f.corner[0].cov_um2[0] = f.corner[0].cov_um2[2] = 4000000;
    EXPECT_EQ(ale_map_corners_update(&map->corners, &f, {0, 0, 0}, 0, true), 0);
    f.corner[0].p.x_um += 10000;
    EXPECT_EQ(ale_map_corners_update(&map->corners, &f, {0, 0, 0}, 0, true), 1);
    EXPECT_EQ(map->corners.count, 1);
    EXPECT_NEAR(map->corners.corner[0].p.x_um, 1005000, 1);
    f.corner[0].kind = ALE_CORNER_CONCAVE;
    EXPECT_EQ(ale_map_corners_update(&map->corners, &f, {0, 0, 0}, 0, false), 0);
    EXPECT_EQ(map->corners.count, 1);
}

TEST(Visibility, AWallIsSupportedSeenThroughOrHidden)
{
    std::mt19937 rng(1);
    auto still = [](double) { return reference::Pose(0, 0, 0); };
    const room::Sensor sensor;
    const ale_wall_t wall = make_wall(2, 0, reference::pi, 0.8);
    const auto look = [&](double x) {
        const ale_scan_t scan = room::scan_at({{x, -4, x, 4}}, sensor, still, 1, rng);
        return ale_wall_visibility(&wall, &scan, nullptr, {0, 0, 0});
    };
    EXPECT_EQ(look(2.02), ALE_VISIBILITY_SUPPORTED);
    EXPECT_EQ(look(3.0), ALE_VISIBILITY_VIOLATED);
    EXPECT_EQ(look(1.0), ALE_VISIBILITY_NONE);
    EXPECT_EQ(look(9.0), ALE_VISIBILITY_NONE);
    const ale_wall_t behind = make_wall(-2, 0, 0, 0.3);
    const ale_scan_t scan = room::scan_at({{3, -4, 3, 4}}, sensor, still, 1, rng);
    EXPECT_EQ(ale_wall_visibility(&behind, &scan, nullptr, {0, 0, 0}), ALE_VISIBILITY_NONE);
}

TEST(Tracker, GoesFromGoodToWeakToLostAndBackByWhatScansShow)
{
    ale_tracking_monitor_t t;
    ale_tracking_init(&t);
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    const ale_visibility_counts_t fine = {3, 0};
    for (int i = 0; i < 3; i++) {
        fit.information.matrix.m[i][i] = int64_t{1} << 50;
    }
    fit.matched = 5;
    fit.shown_um = 4000000;
    fit.matched_um = 3800000;
    EXPECT_FALSE(ale_tracking_doubts(&fit));
    ale_tracking_notice(&t, nullptr, true, true);
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &fine), ALE_STATE_GOOD);
    EXPECT_TRUE(ale_tracking_may_map(&t, &fit));
    fit.information.matrix.m[0][0] = 0;
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &fine), ALE_STATE_WEAK);
    const ale_visibility_counts_t violated = {0, 12};
    fit.matched = 0;
    for (int k = 0; k < 7; k++) {
        EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated), ALE_STATE_WEAK);
        EXPECT_FALSE(ale_tracking_may_map(&t, &fit));
    }
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated), ALE_STATE_LOST);
    EXPECT_EQ(ale_tracking_skip(&t, &fit.motion), ALE_STATE_LOST);
    ale_tracking_found(&t);
    EXPECT_EQ(t.state, ALE_STATE_WEAK);
}

TEST(Tracker, APoseThatTheMapDoesNotHoldIsWhereTheMapGoesOnUnlessTheLastScanDeniesIt)
{
    ale_tracking_monitor_t t;
    ale_tracking_init(&t);
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    fit.motion.cov.m[0][0] = int64_t{80000} * 80000;
    fit.shown_um = 5000000;
    EXPECT_TRUE(ale_tracking_doubts(&fit));
    const ale_testimony_t agreed = {8000000, 5000000, 800000, true};
    ale_tracking_notice(&t, &agreed, true, true);
    EXPECT_FALSE(ale_tracking_may_map(&t, &fit));
    EXPECT_TRUE(ale_tracking_may_reanchor(&t, &fit));
    const ale_testimony_t denied = {8000000, 800000, 3000000, true};
    ale_tracking_notice(&t, &denied, true, true);
    EXPECT_TRUE(t.jumped);
    EXPECT_FALSE(ale_tracking_may_reanchor(&t, &fit));
}

TEST(Tracker, WhatIsNotWhereAPoseOfLittleCertaintyPutsItIsNoNewPlaceButLostUnlessWheelsToldOrNothingIsMapped)
{
    struct {
        bool counted;
        bool mapped;
        int64_t shown_um;
        bool lost;
    } const cases[] = {
        {false, true, 5000000, true},  {true, true, 5000000, false}, {false, false, 5000000, false},
        {false, true, 1000000, false}, {true, true, 1000000, false},
    };
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    fit.motion.cov.m[2][2] = int64_t{200000} * 200000;
    const ale_visibility_counts_t none = {0, 0};
    for (const auto &c : cases) {
        ale_tracking_monitor_t t;
        ale_tracking_init(&t);
        fit.shown_um = c.shown_um;
        ale_tracking_notice(&t, nullptr, c.counted, c.mapped);
        EXPECT_EQ(ale_tracking_may_reanchor(&t, &fit), c.shown_um > 2000000 && !c.lost);
        EXPECT_EQ(ale_tracking_judge(&t, &fit, &none), c.lost ? ALE_STATE_LOST : ALE_STATE_WEAK);
    }
}
