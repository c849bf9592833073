#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "drivers/store/chunks.hpp"

extern "C" {
#include "recorder/flight_ring.h"
}

namespace
{

class FlightRing : public testing::Test
{
  protected:
    void SetUp() override
    {
        ring = ale_flight_ring_create(65536);
        ASSERT_NE(ring, nullptr);
    }
    void TearDown() override
    {
        ale_flight_ring_destroy(ring);
    }
    void put(ale_chunk_kind_t kind, int64_t stamp_us, const std::string &payload)
    {
        ale_flight_ring_put(ring, kind, stamp_us, payload.data(), static_cast<uint32_t>(payload.size()));
    }
    std::vector<Chunk> written() const
    {
        char *bytes = nullptr;
        size_t count = 0;
        ale_recording_t recording{};
        EXPECT_EQ(ale_recording_begin(&recording, open_memstream(&bytes, &count)), 0);
        ale_flight_ring_write(ring, &recording);
        EXPECT_EQ(ale_recording_close(&recording), 0);
        uint64_t bad = 0;
        std::vector<Chunk> chunks = chunks_of(std::string(bytes, count), &bad);
        EXPECT_EQ(bad, 0u);
        std::free(bytes);
        return chunks;
    }

    ale_flight_ring_t *ring = nullptr;
};

TEST_F(FlightRing, WhatFitsComesBackInItsOrder)
{
    for (int k = 0; k < 100; k++) {
        put(ALE_CHUNK_RECEIVED, k, std::string(static_cast<size_t>(k), 'x'));
    }
    const auto chunks = written();
    ASSERT_EQ(chunks.size(), 100u);
    for (size_t k = 0; k < chunks.size(); k++) {
        EXPECT_EQ(chunks[k].stamp_us, static_cast<int64_t>(k));
        EXPECT_EQ(chunks[k].payload.size(), k);
    }
}

TEST_F(FlightRing, TheNewestAreKeptWholeWhereverTheRingTurnsOver)
{
    for (int k = 0; k < 3000; k++) {
        const size_t length = static_cast<size_t>(k * 7919 % ALE_FLIGHT_MAX_PAYLOAD);
        put(ALE_CHUNK_STAGES, k, std::string(length, static_cast<char>('a' + k % 26)));
        if (k % 97 != 0 && k != 2999) {
            continue;
        }
        const auto chunks = written();
        size_t bytes = 0;
        for (size_t n = 0; n < chunks.size(); n++) {
            const int64_t number = k - static_cast<int64_t>(chunks.size() - 1 - n);
            ASSERT_EQ(chunks[n].stamp_us, number);
            ASSERT_EQ(chunks[n].payload,
                      std::string(static_cast<size_t>(number * 7919 % ALE_FLIGHT_MAX_PAYLOAD),
                                  static_cast<char>('a' + number % 26)));
            bytes += chunks[n].payload.size() + ALE_CHUNK_FRAME_BYTES;
        }
        EXPECT_LE(bytes, 65536u);
        EXPECT_TRUE(chunks.size() == static_cast<size_t>(k + 1) ||
                    bytes + ALE_FLIGHT_MAX_PAYLOAD + ALE_CHUNK_FRAME_BYTES > 65536u)
            << "no more than needed made room";
    }
}

TEST_F(FlightRing, TheOpeningOfTheDialogueIsKeptUntilScansAreAskedFor)
{
    put(ALE_CHUNK_SENT, 1, "PP\n");
    put(ALE_CHUNK_RECEIVED, 2, "PP\n00P\nMODL:x;\n\n");
    put(ALE_CHUNK_SENT, 3, "MD0044072501000\n");
    put(ALE_CHUNK_RECEIVED, 4, "a scan");
    EXPECT_EQ(written().size(), 4u) << "once, as long as nothing is lost";
    for (int k = 0; k < 100; k++) {
        put(ALE_CHUNK_RECEIVED, 100 + k, std::string(1000, 's'));
    }
    const auto chunks = written();
    ASSERT_GT(chunks.size(), 4u);
    EXPECT_EQ(chunks[0].payload, "PP\n");
    EXPECT_EQ(chunks[1].stamp_us, 2);
    EXPECT_EQ(chunks[2].payload, "MD0044072501000\n");
    EXPECT_GT(chunks[3].stamp_us, 100);
    EXPECT_EQ(chunks.back().stamp_us, 199);
}

} // namespace
