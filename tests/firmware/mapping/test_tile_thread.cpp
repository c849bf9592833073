// firmware/tile_thread: whereabouts in by one ring, pieces of tiles out by two, in their order, and a clean
// end.
#include <cstring>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "comes_true.hpp"
#include "drivers/store/tile_maps.hpp"
#include "files.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "mapping/tile_thread.h"
}

namespace
{

class TileThread : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        char error[ALE_MAP_FILE_ERROR] = "";
        tile_maps::save(path, tile_maps::some(8000, 100000000, 31));
        loader = ale_tile_loader_open(path.c_str(), error);
        ASSERT_NE(loader, nullptr) << error;
        thread = ale_tile_thread_start(&exchange, loader);
        ASSERT_NE(thread, nullptr);
    }
    void TearDown() override
    {
        ale_tile_thread_stop(thread);
        ale_tile_loader_close(loader);
    }
    /* False: there is no room now. */
    bool say(int32_t x_um, uint32_t scan)
    {
        void *slot = ale_ring_reserve(exchange.whereabouts);
        if (slot) {
            *static_cast<ale_whereabouts_t *>(slot) = {1, scan, {x_um, 0, 0}, 12000000};
            ale_ring_commit(exchange.whereabouts);
        }
        return slot != nullptr;
    }
    void is_at(int32_t x_um, uint32_t scan)
    {
        ASSERT_TRUE(comes_true([&] { return say(x_um, scan); }));
    }
    /* Takes pieces of both rings up to the last one of a change. */
    void take_change()
    {
        for (bool last = false; !last;) {
            ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.tiles_to_mapper) > 0; }));
            const auto *piece = static_cast<ale_tile_change_t *>(ale_ring_at(exchange.tiles, 0));
            ASSERT_EQ(std::memcmp(piece, ale_ring_at(exchange.tiles_to_mapper, 0), sizeof *piece), 0);
            last = piece->last;
            for (int k = 0; k < piece->gone_count; k++) {
                walls.erase(piece->gone[k]);
            }
            for (int k = 0; k < piece->line_count; k++) {
                walls.insert(piece->line[k].id);
            }
            due = piece->due;
            ale_ring_release(exchange.tiles);
            ale_ring_release(exchange.tiles_to_mapper);
        }
    }

    const files::TemporaryFolder folder;
    const std::string path = folder / "building.tiles";
    ale_tile_loader_t *loader = nullptr;
    ale_tile_thread_t *thread = nullptr;
    std::set<uint32_t> walls;
    uint32_t due = 0;
};

TEST_F(TileThread, WhatIsAroundTheRobotGoesToEstimateAndMapper)
{
    is_at(-50000000, 40);
    take_change();
    EXPECT_GE(due, 40U + ALE_TILE_DELAY_SCANS);
    EXPECT_GT(walls.size(), 100U);
    const std::set<uint32_t> first = walls;
    is_at(-50000000, 45);
    is_at(50000000, 50);
    take_change();
    EXPECT_GT(walls.size(), 100U);
    for (const uint32_t id : first) {
        EXPECT_EQ(walls.count(id), 0U) << "a hundred metres off";
    }
    EXPECT_EQ(ale_ring_ready(exchange.tiles), 0U);
}

TEST_F(TileThread, ItEndsThoughNobodyTakesWhatItHandsOut)
{
    uint32_t scan = 0;
    EXPECT_TRUE(comes_true([&] {
        scan += say(static_cast<int32_t>(scan % 2) * 60000000, scan);
        return ale_ring_ready(exchange.tiles) == ALE_TILE_SLOTS;
    }));
    ale_tile_thread_stop(thread);
    thread = nullptr;
}

} // namespace
