// firmware/mapper_thread: keyframes in by one ring, corrections out by another, and a clean end.
#include <cstring>

#include <gtest/gtest.h>

#include "comes_true.hpp"
#include "firmware/surroundings.hpp"
#include "lib/graph/drifting_keyframes.hpp"
#include "scarce_memory.hpp"

extern "C" {
#include "graph/mapper_graph.h"
#include "mapping/mapper_thread.h"
}

namespace
{

class MapperThread : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        thread = ale_mapper_thread_start(&exchange);
        ASSERT_NE(thread, nullptr);
    }
    void TearDown() override
    {
        ale_mapper_thread_stop(thread);
    }

    void hand_over(const ale_keyframe_t &keyframe)
    {
        void *slot = nullptr;
        ASSERT_TRUE(comes_true([&] { return (slot = ale_ring_reserve(exchange.keyframes)) != nullptr; }));
        *static_cast<ale_keyframe_t *>(slot) = keyframe;
        ale_ring_commit(exchange.keyframes);
    }

    ale_mapper_thread_t *thread = nullptr;
};

TEST_F(MapperThread, ALoopComesBackAsACorrection)
{
    const auto keyframes = drifting_keyframes::walk(1.2, 0.0008, 1);
    for (const auto &keyframe : keyframes) {
        hand_over(*keyframe);
    }
    EXPECT_TRUE(comes_true([&] { return ale_ring_ready(exchange.keyframes) == 0; }));
    ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.corrections) > 0; }));
    const auto *correction = static_cast<ale_correction_t *>(ale_ring_at(exchange.corrections, 0));
    EXPECT_EQ(correction->epoch, 1U);
    EXPECT_EQ(correction->number, 1U);
    EXPECT_GT(correction->count, 100U);
    EXPECT_EQ(correction->shift[0].scan, 0U);
    const ale_mapper_graph_t *graph = nullptr;
    ASSERT_TRUE(comes_true([&] {
        bool fresh = false;
        graph = static_cast<const ale_mapper_graph_t *>(ale_snapshot_newest(exchange.graph, &fresh));
        return graph->keyframes == keyframes.size();
    })) << "and everybody outside is told the whole graph";
    EXPECT_GT(graph->loops, 0U);
    EXPECT_EQ(graph->epoch, 1U);
}

TEST_F(MapperThread, ExplorationHearsOfTheSameCorrection)
{
    exchange.explore =
        reinterpret_cast<struct ale_explore *>(&exchange); // there is one; nobody asks it anything
    const auto keyframes = drifting_keyframes::walk(1.2, 0.0008, 1);
    for (const auto &keyframe : keyframes) {
        hand_over(*keyframe);
    }
    ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.corrections) > 0; }));
    ASSERT_GT(ale_ring_ready(exchange.grid_corrections), 0U);
    EXPECT_EQ(std::memcmp(ale_ring_at(exchange.corrections, 0), ale_ring_at(exchange.grid_corrections, 0),
                          sizeof(ale_correction_t)),
              0);
}

// Half a lap: no loop, and nothing but the map can tell of the drift.
class MapperThreadInALoadedMap : public MapperThread
{
  protected:
    static std::unique_ptr<ale_map_t> map_of_the_corridor()
    {
        auto map = std::make_unique<ale_map_t>();
        for (const room::Wall &wall : drifting_keyframes::walls()) {
            ale_map_line_t &line = map->line[map->line_count++];
            line.start = {convert::um(wall.x1), convert::um(wall.y1)};
            line.end = {convert::um(wall.x2), convert::um(wall.y2)};
            line.seen = 9;
        }
        return map;
    }
    void hand_over_in(uint32_t number, size_t first, size_t end)
    {
        for (size_t k = first; k < end; k++) {
            keyframes[k]->loaded = number;
            hand_over(*keyframes[k]);
        }
    }
    bool are_all_taken()
    {
        return comes_true([&] { return ale_ring_ready(exchange.keyframes) == 0; });
    }

    const std::vector<drifting_keyframes::Keyframe> keyframes = drifting_keyframes::walk(0.55, 0.0012, 2);
};

TEST_F(MapperThreadInALoadedMap, KeyframesAreLaidOnIt)
{
    const uint32_t number = ale_exchange_know(&exchange, map_of_the_corridor().get());
    hand_over_in(number, 0, keyframes.size());
    EXPECT_TRUE(comes_true([&] { return ale_ring_ready(exchange.corrections) > 0; }));
}

// The next map is loaded before the mapper has come to the first keyframe in the one before.
TEST_F(MapperThreadInALoadedMap, AnotherMapThanTheirsIsNotTakenForIt)
{
    const uint32_t number = ale_exchange_know(&exchange, std::make_unique<ale_map_t>().get());
    ale_exchange_know(&exchange, map_of_the_corridor().get());
    hand_over_in(number, 0, keyframes.size());
    EXPECT_TRUE(are_all_taken());
    EXPECT_EQ(ale_ring_ready(exchange.corrections), 0U);
}

TEST_F(MapperThreadInALoadedMap, ItIsKnownAgainWhenThereIsMemoryAgain)
{
    const uint32_t number = ale_exchange_know(&exchange, map_of_the_corridor().get());
    hand_over_in(number, 0, 2);
    ASSERT_TRUE(are_all_taken());
    scarce_memory::none_left = true;
    hand_over_in(number, 2, 6); // the graph is lost with the first, the map not to be had with the others
    const bool taken = are_all_taken();
    scarce_memory::none_left = false;
    ASSERT_TRUE(taken);
    EXPECT_GE(scarce_memory::refused, 4);
    hand_over_in(number, 6, keyframes.size());
    EXPECT_TRUE(comes_true([&] { return ale_ring_ready(exchange.corrections) > 0; }));
}

// The same map by tiles: what is loaded around the robot, from the scan on that it is due at.
class MapperThreadInAMapOfTiles : public MapperThreadInALoadedMap
{
  protected:
    void hand_over_tiles(uint32_t due)
    {
        const auto map = map_of_the_corridor();
        for (uint16_t first = 0; first < map->line_count; first += ALE_TILE_PIECE_WALLS) {
            auto *piece = static_cast<ale_tile_change_t *>(ale_ring_reserve(exchange.tiles_to_mapper));
            *piece = {};
            piece->epoch = keyframes.front()->epoch;
            piece->due = due;
            piece->last = first + ALE_TILE_PIECE_WALLS >= map->line_count;
            for (uint16_t k = first; k < map->line_count && piece->line_count < ALE_TILE_PIECE_WALLS; k++) {
                piece->line[piece->line_count] = map->line[k];
                piece->line[piece->line_count++].id = k + 1U;
            }
            ale_ring_commit(exchange.tiles_to_mapper);
        }
    }
};

TEST_F(MapperThreadInAMapOfTiles, KeyframesAreLaidOnThem)
{
    hand_over_tiles(0);
    hand_over_in(ALE_LOADED_TILES, 0, keyframes.size());
    EXPECT_TRUE(comes_true([&] { return ale_ring_ready(exchange.corrections) > 0; }));
}

TEST_F(MapperThreadInAMapOfTiles, NotOnThoseThatAreDueLater)
{
    hand_over_tiles(keyframes.back()->scan + 1);
    hand_over_in(ALE_LOADED_TILES, 0, keyframes.size());
    EXPECT_TRUE(are_all_taken());
    EXPECT_EQ(ale_ring_ready(exchange.corrections), 0U);
}

TEST_F(MapperThread, ItEndsWhileKeyframesAreWaiting)
{
    const auto keyframes = drifting_keyframes::walk(0.08, 0, 1);
    for (const auto &keyframe : keyframes) {
        hand_over(*keyframe);
    }
    ale_mapper_thread_stop(thread);
    thread = nullptr;
    SUCCEED();
}

} // namespace
