#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "drivers/store/chunks.hpp"
#include "files.hpp"

namespace
{

std::string file_of(const std::vector<Chunk> &chunks)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "recording";
    ale_recording_t recording;
    EXPECT_EQ(ale_recording_create(&recording, path.c_str()), 0);
    for (const Chunk &c : chunks) {
        EXPECT_EQ(ale_recording_write(&recording, c.kind, c.stamp_us, c.payload.data(),
                                      static_cast<uint32_t>(c.payload.size())),
                  0);
    }
    EXPECT_EQ(ale_recording_close(&recording), 0);
    return files::content(path);
}

std::vector<Chunk> some_chunks()
{
    std::mt19937 random(9);
    std::vector<Chunk> chunks;
    for (int k = 0; k < 40; k++) {
        std::string payload(random() % 300, '\0');
        for (char &byte : payload) {
            byte = static_cast<char>(random());
        }
        chunks.push_back({static_cast<ale_chunk_kind_t>(1 + k % 8), k * 1000000007LL - 5, payload});
    }
    return chunks;
}

TEST(Recording, BytesLieAsDocumented)
{
    const std::string bytes = file_of({{ALE_CHUNK_SENT, 0x0102030405060708, "QT\n"}});
    const std::string covered("\x02\0\0\0"
                              "\x03\0\0\0"
                              "\x08\x07\x06\x05\x04\x03\x02\x01"
                              "QT\n",
                              19);
    const auto crc = static_cast<uint32_t>(
        crc32(0, reinterpret_cast<const Bytef *>(covered.data()), static_cast<uInt>(covered.size())));
    std::string expected = "ALESCIP1CHNK" + covered;
    for (unsigned i = 0; i < 4; i++) {
        expected += static_cast<char>(crc >> (8 * i));
    }
    EXPECT_EQ(bytes, expected);
    EXPECT_TRUE(ale_recording_claims(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size()));
    EXPECT_FALSE(ale_recording_claims(reinterpret_cast<const uint8_t *>(bytes.data()), 7));
}

TEST(Recording, WhatIsWrittenIsReadBack)
{
    const std::vector<Chunk> written = some_chunks();
    uint64_t bad = 9;
    const std::vector<Chunk> read = chunks_of(file_of(written), &bad);
    ASSERT_EQ(read.size(), written.size());
    EXPECT_EQ(bad, 0U);
    for (size_t i = 0; i < read.size(); i++) {
        EXPECT_EQ(read[i].kind, written[i].kind);
        EXPECT_EQ(read[i].stamp_us, written[i].stamp_us);
        EXPECT_EQ(read[i].payload, written[i].payload);
    }
}

TEST(Recording, AnyFlippedByteCostsAtMostTheChunkItLiesIn)
{
    const std::vector<Chunk> written = some_chunks();
    const std::string bytes = file_of(written);
    for (size_t at = 8; at < bytes.size(); at += 3) {
        std::string damaged = bytes;
        damaged[at] ^= 0x20;
        uint64_t bad = 0;
        ASSERT_EQ(chunks_of(damaged, &bad).size(), written.size() - 1) << at;
        ASSERT_EQ(bad, 1U) << at;
    }
}

TEST(Recording, AnyCutLeavesTheChunksBeforeIt)
{
    const std::string bytes = file_of(some_chunks());
    size_t before = 0;
    for (size_t length = 8; length <= bytes.size(); length++) {
        uint64_t bad = 0;
        const size_t read = chunks_of(bytes.substr(0, length), &bad).size();
        ASSERT_TRUE(read == before || read == before + 1) << length;
        ASSERT_LE(bad, 1U);
        before = read;
    }
    EXPECT_EQ(before, 40U);
}

TEST(Recording, PayloadsHaveALimitAndFailuresAreReported)
{
    ale_recording_t recording;
    EXPECT_EQ(ale_recording_create(&recording, "/proc/no/such/folder"), -1);
    ASSERT_EQ(ale_recording_create(&recording, "/dev/full"), 0);
    const std::string large(ALE_CHUNK_MAX_PAYLOAD + 1, 'x');
    EXPECT_EQ(
        ale_recording_write(&recording, ALE_CHUNK_SENT, 0, large.data(), static_cast<uint32_t>(large.size())),
        -1);
    EXPECT_EQ(errno, EINVAL);
    ale_recording_write(&recording, ALE_CHUNK_SENT, 0, large.data(), ALE_CHUNK_MAX_PAYLOAD);
    EXPECT_EQ(ale_recording_close(&recording), -1) << "a full disk is noticed at the latest when closing";
}

} // namespace
