// firmware/map_drawer: scan observations and keyframes in, drawings out, and a last one in the end.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "comes_true.hpp"
#include "firmware/surroundings.hpp"
#include "lib/graph/room_drive.hpp"
#include "scarce_memory.hpp"

extern "C" {
#include "mapping/map_drawer.h"
}

namespace
{

const RoomDrive &drive()
{
    static const RoomDrive drive(30, [](int) { return room::l_shape(); });
    return drive;
}

class MapDrawer : public surroundings::WithExchange
{
  protected:
    void TearDown() override
    {
        ale_map_drawer_stop(drawer);
    }
    void start()
    {
        drawer = ale_map_drawer_start(&exchange);
        ASSERT_NE(drawer, nullptr);
    }
    void stop()
    {
        ale_map_drawer_stop(drawer);
        drawer = nullptr;
    }
    void see(size_t first, size_t end, uint32_t loaded = 0)
    {
        for (size_t k = first; k < end; k++) {
            void *slot = ale_ring_reserve(exchange.observations);
            ASSERT_NE(slot, nullptr);
            *static_cast<ale_scan_observation_t *>(slot) = *drive().observations[k];
            static_cast<ale_scan_observation_t *>(slot)->loaded = loaded;
            ale_ring_commit(exchange.observations);
        }
    }
    void place_keyframes()
    {
        *static_cast<ale_mapper_poses_t *>(ale_snapshot_back(exchange.keyframe_poses)) = *drive().keyframes;
        ale_snapshot_publish(exchange.keyframe_poses);
    }
    const ale_drawn_map_t &newest()
    {
        bool fresh = false;
        return *static_cast<const ale_drawn_map_t *>(ale_snapshot_newest(exchange.drawn_map, &fresh));
    }

    ale_map_drawer_t *drawer = nullptr;
};

TEST_F(MapDrawer, WhatScansHaveShownIsDrawn)
{
    place_keyframes();
    see(0, 20);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    EXPECT_EQ(newest().epoch, drive().keyframes->epoch);
    EXPECT_GE(newest().map.line_count, 4);
    EXPECT_EQ(ale_ring_ready(exchange.observations), 0U);
}

TEST_F(MapDrawer, ADrawingNamesTheMapThatTheRobotIsIn)
{
    auto *poses = static_cast<ale_mapper_poses_t *>(ale_snapshot_back(exchange.keyframe_poses));
    *poses = *drive().keyframes;
    for (uint32_t k = 0; k < poses->count; k++) {
        poses->pose[k].map_id = 4;
    }
    ale_snapshot_publish(exchange.keyframe_poses);
    see(0, 20);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    ASSERT_GE(newest().map.line_count, 4);
    for (int k = 0; k < newest().map.line_count; k++) {
        EXPECT_EQ(newest().map.line[k].map_id, 4U);
    }
}

TEST_F(MapDrawer, WhatCameLastIsDrawnBeforeItEnds)
{
    place_keyframes();
    see(0, 4);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    const int before = newest().map.line_count;
    see(4, drive().observations.size());
    stop();
    EXPECT_GT(newest().map.line_count, before);
}

class MapDrawerInALoadedMap : public MapDrawer
{
  protected:
    // Of one wall, far from where the robot drives.
    static std::unique_ptr<ale_map_t> far_wall()
    {
        auto map = std::make_unique<ale_map_t>();
        map->line_count = 1;
        map->line[0].start = {50000000, 0};
        map->line[0].end = {53000000, 0};
        map->line[0].seen = 9;
        return map;
    }
    static bool has_far_wall(const ale_map_t &drawn)
    {
        return std::any_of(drawn.line, drawn.line + drawn.line_count, [](const ale_map_line_t &line) {
            return line.start.x_um == 50000000 && line.start.y_um == 0;
        });
    }
    bool are_all_taken()
    {
        return comes_true([&] { return ale_ring_ready(exchange.observations) == 0; });
    }
};

TEST_F(MapDrawerInALoadedMap, ItIsDrawnOn)
{
    const uint32_t number = ale_exchange_know(&exchange, far_wall().get());
    place_keyframes();
    see(0, 20, number);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    EXPECT_TRUE(has_far_wall(newest().map));
    EXPECT_GE(newest().map.line_count, 5);
}

// The next map is loaded before the drawer has come to what was seen in the one before.
TEST_F(MapDrawerInALoadedMap, AnotherMapThanThatOfTheObservationsIsNotTakenForIt)
{
    const uint32_t number = ale_exchange_know(&exchange, std::make_unique<ale_map_t>().get());
    ale_exchange_know(&exchange, far_wall().get());
    place_keyframes();
    see(0, 20, number);
    start();
    EXPECT_TRUE(are_all_taken());
    stop();
    EXPECT_EQ(newest().epoch, 0U);
}

TEST_F(MapDrawerInALoadedMap, NothingIsDrawnUntilThereIsMemoryForIt)
{
    const uint32_t number = ale_exchange_know(&exchange, far_wall().get());
    place_keyframes();
    start();
    scarce_memory::none_left = true;
    see(0, 4, number);
    const bool taken = are_all_taken();
    scarce_memory::none_left = false;
    ASSERT_TRUE(taken);
    EXPECT_GE(scarce_memory::refused, 4);
    EXPECT_EQ(newest().epoch, 0U);
    see(4, 24, number);
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    EXPECT_TRUE(has_far_wall(newest().map));
}

TEST_F(MapDrawer, WithoutScansNothingIsDrawn)
{
    place_keyframes();
    start();
    stop();
    EXPECT_EQ(newest().epoch, 0U);
}

} // namespace
