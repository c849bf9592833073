#include <string>
#include <vector>

#include <bzlib.h>
#include <gtest/gtest.h>
#include <zlib.h>

extern "C" {
#include "file/bytes.h"
}

namespace
{

std::vector<uint8_t> gzipped(const std::string &text, size_t times)
{
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY), Z_OK);
    std::vector<uint8_t> packed(deflateBound(&stream, text.size() * times));
    stream.next_out = packed.data();
    stream.avail_out = static_cast<unsigned>(packed.size());
    for (size_t k = 0; k < times; k++) {
        stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(text.data()));
        stream.avail_in = static_cast<unsigned>(text.size());
        deflate(&stream, k + 1 < times ? Z_NO_FLUSH : Z_FINISH);
    }
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::vector<uint8_t> bzipped(const std::string &text)
{
    std::vector<uint8_t> packed(text.size() / 100 + 600);
    auto count = static_cast<unsigned>(packed.size());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(reinterpret_cast<char *>(packed.data()), &count,
                                       const_cast<char *>(text.data()), static_cast<unsigned>(text.size()), 9,
                                       0, 0),
              BZ_OK);
    packed.resize(count);
    return packed;
}

std::string refusal_of(const std::vector<uint8_t> &packed)
{
    ale_bytes_t bytes;
    const char *wrong = ale_bytes_from_memory(&bytes, packed.data(), packed.size());
    if (wrong == nullptr) {
        ale_bytes_free(&bytes);
    }
    return wrong == nullptr ? "" : wrong;
}

TEST(Bytes, WhatSwellsOutOfAllProportionIsRefused)
{
    const std::string zeros(1U << 20U, '\0');
    EXPECT_EQ(refusal_of(gzipped(zeros, 300)).substr(0, 42), "unpacks to more than 256 MiB and a hundred");
    EXPECT_EQ(refusal_of(bzipped(std::string(300U << 20U, '\0'))).substr(0, 20), "unpacks to more than");
}

TEST(Bytes, WhatIsSmallMaySwellAsItLikes)
{
    EXPECT_EQ(refusal_of(gzipped(std::string(1U << 20U, '\0'), 200)), "");
}

} // namespace
