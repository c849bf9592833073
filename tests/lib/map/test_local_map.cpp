// lib/map/local_map.c: walls in bounded memory, listed by direction, merged.
#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "walls.h"

extern "C" {
#include "map/atlas.h"
#include "map/local_map.h"
#include "match/association.h"
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

namespace
{
/* Walls, landmarks and corners of three maps that lie on one another. */
struct Maps : Map {
    void add_place(uint8_t number, double x)
    {
        ale_local_map_select(map.get(), number);
        add(x, 0, reference::pi, 1);
        ale_landmark_t m = {};
        m.p = {convert::um(x), 500000};
        m.var_um2 = 9000000;
        m.seen = 3;
        m.map = map->landmarks.selected;
        ale_landmarks_add(&map->landmarks, &m);
        ale_features_t f = {};
        f.corner_count = 1;
        f.corner[0].p = {convert::um(x), 0};
        ale_map_corners_update(&map->corners, &f, {0, 0, 0}, 0, true);
    }
    int near()
    {
        ale_local_map_approach(map.get(), {0, 0}, 50000000);
        return map->near_first[ALE_MAP_DIRECTIONS];
    }
    int landmarks(double x) const
    {
        return ale_landmarks_find(&map->landmarks, {convert::um(x), 500000}, 0, false, 50000) !=
               ALE_NO_LANDMARK;
    }
    int corners(double x)
    {
        ale_features_t f = {};
        f.corner_count = 1;
        f.corner[0].p = {convert::um(x), 0};
        return ale_map_corners_update(&map->corners, &f, {0, 0, 0}, 0, false);
    }
};
} // namespace

TEST_F(Maps, OnlyWhatBelongsToTheSelectedOneIsFound)
{
    for (uint8_t number = 0; number < 3; number++) {
        add_place(number, 1 + number);
        add_place(number, 11 + number);
    }
    for (uint8_t number = 0; number < 3; number++) {
        ale_local_map_select(map.get(), number);
        EXPECT_EQ(near(), 2);
        for (int k = map->near_first[0]; k < map->near_first[ALE_MAP_DIRECTIONS]; k++) {
            EXPECT_EQ(map->wall[map->near[k]].map, number);
        }
        for (uint8_t other = 0; other < 3; other++) {
            EXPECT_EQ(landmarks(1 + other), other == number) << int{number} << " " << int{other};
            EXPECT_EQ(corners(11 + other), other == number) << int{number} << " " << int{other};
        }
    }
}

TEST_F(Maps, TheListOfNearWallsIsMadeAnewForAnotherMap)
{
    add_place(0, 1);
    add_place(1, 2);
    EXPECT_EQ(near(), 1);
    ale_local_map_select(map.get(), 1);
    EXPECT_GT(map->near_radius_um, 0) << "it is the same one";
    ale_local_map_select(map.get(), 0);
    ASSERT_EQ(near(), 1);
    EXPECT_EQ(map->near[0], 0);
}

/* Whichever walls belong to which map: those of the others stay, each with its id, and nothing else does. */
TEST_F(Maps, OneIsGivenUpWithAllThatBelongsToItAndNothingElse)
{
    std::mt19937 rng(1);
    for (int trial = 0; trial < 20; trial++) {
        SetUp();
        std::vector<uint32_t> kept;
        const uint8_t gone = static_cast<uint8_t>(rng() % ALE_ATLAS_MAPS);
        for (int k = 0; k < 120; k++) {
            const uint8_t number = static_cast<uint8_t>(rng() % ALE_ATLAS_MAPS);
            add_place(number, 0.3 * k);
            if (number != gone) {
                kept.push_back(map->wall[map->count - 1].id);
            }
        }
        ale_local_map_give_up(map.get(), gone);
        std::vector<uint32_t> left;
        for (int i = 0; i < map->count; i++) {
            left.push_back(map->wall[i].id);
            EXPECT_NE(map->wall[i].map, gone);
        }
        std::sort(left.begin(), left.end());
        EXPECT_EQ(left, kept);
        EXPECT_EQ(map->corners.count, kept.size());
        ale_local_map_select(map.get(), gone);
        EXPECT_EQ(near(), 0);
        for (int k = 0; k < 120; k++) {
            EXPECT_EQ(landmarks(0.3 * k) + corners(0.3 * k), 0) << k;
        }
    }
}
