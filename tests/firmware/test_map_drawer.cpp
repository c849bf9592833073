// firmware/map_drawer: sightings and keyframes in, drawings out, and a last one in the end.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "comes_true.hpp"
#include "lib/graph/room_drive.hpp"
#include "surroundings.hpp"

extern "C" {
#include "map_drawer.h"
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
    void see(size_t first, size_t end, bool loaded = false)
    {
        for (size_t k = first; k < end; k++) {
            void *slot = ale_ring_reserve(exchange.sightings);
            ASSERT_NE(slot, nullptr);
            *static_cast<ale_sighting_t *>(slot) = *drive().sightings[k];
            static_cast<ale_sighting_t *>(slot)->loaded = loaded;
            ale_ring_commit(exchange.sightings);
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
    EXPECT_EQ(ale_ring_ready(exchange.sightings), 0U);
}

TEST_F(MapDrawer, WhatCameLastIsDrawnBeforeItEnds)
{
    place_keyframes();
    see(0, 4);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    const int before = newest().map.line_count;
    see(4, drive().sightings.size());
    stop();
    EXPECT_GT(newest().map.line_count, before);
}

TEST_F(MapDrawer, AMapThatTheDriveBeganInIsDrawnOn)
{
    auto known = std::make_unique<ale_map_t>();
    known->line_count = 1;
    known->line[0].start = {50000000, 0};
    known->line[0].end = {53000000, 0};
    known->line[0].seen = 9;
    ale_exchange_know(&exchange, known.get());
    place_keyframes();
    see(0, 20, true);
    start();
    ASSERT_TRUE(comes_true([&] { return newest().epoch != 0; }));
    const ale_map_t &drawn = newest().map;
    EXPECT_TRUE(std::any_of(drawn.line, drawn.line + drawn.line_count, [](const ale_map_line_t &line) {
        return line.start.x_um == 50000000 && line.start.y_um == 0;
    }));
    EXPECT_GE(drawn.line_count, 5);
}

TEST_F(MapDrawer, WithoutScansNothingIsDrawn)
{
    place_keyframes();
    start();
    stop();
    EXPECT_EQ(newest().epoch, 0U);
}

} // namespace
