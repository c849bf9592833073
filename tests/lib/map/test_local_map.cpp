// lib/map/local_map.c: walls in bounded memory, listed by direction, merged.
#include <memory>

#include <gtest/gtest.h>

#include "walls.h"

extern "C" {
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
