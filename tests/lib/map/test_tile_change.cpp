// lib/map/tile_change: walls of a large map come into the map in work and leave it.
#include <algorithm>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "lib/map/walls.h"
#include "reference/planar_motion.h"

extern "C" {
#include "map/atlas.h"
#include "map/tile_change.h"
}

namespace
{

class TileChange : public testing::Test
{
  protected:
    TileChange()
    {
        ale_local_map_clear(map.get());
        piece->last = true;
        piece->window = {-20000000, -20000000, 20000000, 20000000};
    }
    void comes(uint32_t id, double x1, double y1, double x2, double y2)
    {
        ale_map_line_t &line = piece->line[piece->line_count++];
        line = {};
        line.id = id;
        line.start = {convert::um(x1), convert::um(y1)};
        line.end = {convert::um(x2), convert::um(y2)};
        line.var_alpha_nrad2 = 4000000000000;
        line.var_rho_um2 = 4000000;
        line.seen = 9;
    }
    void goes(uint32_t id)
    {
        piece->gone[piece->gone_count++] = id;
    }
    void apply()
    {
        ale_tile_change_apply(map.get(), piece.get());
        piece->line_count = piece->gone_count = piece->corner_count = 0;
    }
    /* A wall that the drive has seen. */
    uint32_t drive_sees(double x, double y, double normal, double half)
    {
        ale_wall_t wall = make_wall(x, y, normal, half);
        wall.born = 17;
        return map->wall[ale_local_map_add(map.get(), &wall)].id;
    }
    void drive_sees_point(double x)
    {
        const ale_landmark_t point = {.p = {convert::um(x), 0}, .var_um2 = 1000000, .seen = 4, .born = 17};
        ale_landmarks_add(&map->landmarks, &point);
    }
    std::multiset<uint32_t> tile_walls() const
    {
        std::multiset<uint32_t> ids;
        for (int k = 0; k < map->count; k++) {
            if (map->wall[k].prior_id != 0) {
                ids.insert(map->wall[k].prior_id);
            }
        }
        return ids;
    }
    bool has_wall(uint32_t id) const
    {
        return std::any_of(map->wall, map->wall + map->count,
                           [id](const ale_wall_t &wall) { return wall.id == id; });
    }

    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_tile_change_t> piece = std::make_unique<ale_tile_change_t>();
};

using Ids = std::multiset<uint32_t>;

TEST_F(TileChange, WallsComeByTheirNumbersAndLeaveByThem)
{
    comes(7, 0, 0, 4, 0);
    comes(3, 4, 0, 4, 3);
    comes(900, 4, 3, 0, 3);
    const uint32_t version = map->version;
    apply();
    EXPECT_EQ(tile_walls(), (Ids{3, 7, 900}));
    EXPECT_NE(map->version, version);
    for (int k = 0; k < map->count; k++) {
        EXPECT_EQ(map->wall[k].born, ALE_BORN_BEFORE) << "no correction moves it";
        EXPECT_EQ(map->wall[k].seen, 9U);
    }
    goes(3);
    goes(8);
    goes(900);
    apply();
    EXPECT_EQ(tile_walls(), (Ids{7}));
}

TEST_F(TileChange, TheyComeIntoTheFirstMapWhicheverTheRobotIsIn)
{
    ale_local_map_select(map.get(), 2);
    const uint32_t elsewhere = drive_sees(500, 500, 0, 1);
    comes(1, 0, 0, 4, 0);
    apply();
    EXPECT_EQ(map->selected, 2);
    ASSERT_EQ(map->count, 2);
    EXPECT_EQ(map->wall[1].map, ALE_FIRST_MAP);
    EXPECT_TRUE(has_wall(elsewhere)) << "a map that is not joined lies nowhere";
}

TEST_F(TileChange, WhatTheDriveHasSeenLeavesWhenItLiesOutsideTheTiles)
{
    const uint32_t inside = drive_sees(0, 0, 0, 1);
    const uint32_t across = drive_sees(20, 5, 0.8, 2);
    const uint32_t outside = drive_sees(23, 0, 0, 1);
    drive_sees_point(1);
    drive_sees_point(25);
    piece->last = false;
    apply();
    EXPECT_TRUE(has_wall(outside)) << "until the last piece has come";
    piece->last = true;
    apply();
    EXPECT_TRUE(has_wall(inside));
    EXPECT_TRUE(has_wall(across));
    EXPECT_FALSE(has_wall(outside));
    EXPECT_NE(ale_landmarks_find(&map->landmarks, {1000000, 0}, 0, false, 50000), ALE_NO_LANDMARK);
    EXPECT_EQ(ale_landmarks_find(&map->landmarks, {25000000, 0}, 0, false, 50000), ALE_NO_LANDMARK);
}

TEST_F(TileChange, AWallThatComesLateTakesThePlaceOfWhatTheDriveHasSeenOfIt)
{
    const uint32_t part = drive_sees(2, 0.04, -reference::pi / 2, 1); // the same side, 4 cm off
    const uint32_t back = drive_sees(2, 0.04, reference::pi / 2, 1);
    const uint32_t before_it = drive_sees(2, 0.3, -reference::pi / 2, 1);
    const uint32_t beside = drive_sees(6, 0, -reference::pi / 2, 1);
    const uint32_t across = drive_sees(2, 0, 0, 1);
    comes(5, 4, 0, 0, 0); // its normal is -y
    apply();
    EXPECT_FALSE(has_wall(part));
    EXPECT_TRUE(has_wall(back)) << "the other side of a panel";
    EXPECT_TRUE(has_wall(before_it));
    EXPECT_TRUE(has_wall(beside));
    EXPECT_TRUE(has_wall(across));
    EXPECT_EQ(tile_walls(), (Ids{5}));
}

TEST_F(TileChange, TwoWallsOfTilesNeverBecomeOneAndOneOfTheDriveBecomesThatOfTheTiles)
{
    comes(5, 4, 0, 0, 0);
    comes(6, 5, 0.001, 3, 0.001);
    apply();
    ale_local_map_approach(map.get(), {0, 0}, 10000000);
    int32_t work = 1000;
    EXPECT_FALSE(ale_local_map_merge_at(map.get(), 0, &work));
    goes(6);
    apply();
    drive_sees(4.5, 0.001, -reference::pi / 2, 1);
    ale_local_map_approach(map.get(), {0, 0}, 10000000);
    work = 1000;
    ASSERT_TRUE(ale_local_map_merge_at(map.get(), 1, &work));
    ASSERT_EQ(map->count, 1);
    EXPECT_EQ(map->wall[0].prior_id, 5U);
    EXPECT_EQ(map->wall[0].born, ALE_BORN_BEFORE);
}

TEST_F(TileChange, WhatFindsNoRoomIsCounted)
{
    for (int k = 0; k < ALE_MAP_MAX_LINES; k++) {
        drive_sees(0.01 * k - 10, -10, 0, 0.5);
    }
    comes(5, 4, 0, 0, 0);
    apply();
    EXPECT_EQ(map->refused, 1U);
    EXPECT_TRUE(tile_walls().empty());
}

TEST_F(TileChange, CornersComeAndLeaveByWhereTheyLie)
{
    piece->corner[0].p = {1000000, 0};
    piece->corner[1].p = {19000000, 0};
    piece->corner_count = 2;
    apply();
    EXPECT_EQ(map->corners.count, 2);
    piece->window.max_x_um = 10000000;
    apply();
    ASSERT_EQ(map->corners.count, 1);
    EXPECT_EQ(map->corners.corner[0].p.x_um, 1000000);
    EXPECT_EQ(map->corners.born[0], ALE_BORN_BEFORE);
}

} // namespace
