#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "drivers/lcm/datagrams.hpp"

extern "C" {
#include "lcm/datagram.h"
}

namespace
{

using datagrams::Bytes;
using datagrams::Part;

/* In memory of exactly its size, so that the address sanitizer sees a byte too many. */
int read(const Bytes &bytes, ale_datagram_t *out)
{
    static std::unique_ptr<uint8_t[]> exact;
    exact.reset(new uint8_t[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), exact.get());
    return ale_datagram_read(exact.get(), bytes.size(), out);
}

std::string text(const ale_datagram_t &datagram)
{
    return {reinterpret_cast<const char *>(datagram.bytes), datagram.count};
}

TEST(Datagram, AWholeMessageIsChannelAndBytes)
{
    ale_datagram_t datagram;
    ASSERT_EQ(read(datagrams::whole("ALE_POSE", "abc"), &datagram), 0);
    EXPECT_FALSE(datagram.is_part);
    EXPECT_STREQ(datagram.channel, "ALE_POSE");
    EXPECT_EQ(text(datagram), "abc");
    ASSERT_EQ(read(datagrams::whole("A", ""), &datagram), 0);
    EXPECT_EQ(datagram.count, 0U);
    EXPECT_EQ(read(datagrams::whole(std::string(63, 'A'), "x"), &datagram), 0);
}

TEST(Datagram, ThePartsOfAMessageAreNumbered)
{
    ale_datagram_t datagram;
    ASSERT_EQ(read(datagrams::part({7, 100, 0, 0, 2}, std::string("MAP") + '\0' + "0123456789"), &datagram),
              0);
    EXPECT_TRUE(datagram.is_part);
    EXPECT_STREQ(datagram.channel, "MAP");
    EXPECT_EQ(datagram.size, 100U);
    EXPECT_EQ(datagram.of, 2);
    EXPECT_EQ(text(datagram), "0123456789");
    ASSERT_EQ(read(datagrams::part({7, 100, 96, 1, 2}, "wxyz"), &datagram), 0);
    EXPECT_EQ(datagram.channel, nullptr);
    EXPECT_EQ(datagram.offset, 96U);
    EXPECT_EQ(datagram.number, 1);
}

TEST(Datagram, WhatDoesNotFitItsOwnNumbersIsRefused)
{
    const std::string channel = std::string("ALE_COMMAND") + '\0';
    const std::string bytes(32, 'x');
    const Bytes refused[] = {
        datagrams::part({1, 1000, 0xfffffff0, 1, 2}, bytes), /* the sum wraps to 16 */
        datagrams::part({1, 1000, 0xfffffff0, 0, 2}, channel + bytes),
        datagrams::part({1, 1000, 969, 1, 2}, bytes),
        datagrams::part({1, 1000, 1001, 1, 2}, ""),
        datagrams::part({1, 0, 1, 1, 2}, ""),
        datagrams::part({1, 1000, 0, 0, 0}, channel + bytes), /* of none */
        datagrams::part({1, 1000, 0, 2, 2}, bytes),
        datagrams::part({1, 1000, 0, 0, 2}, "NO_END"),
        datagrams::part({1, 1000, 0, 0, 2}, ""),
        datagrams::part({1, 1000, 0, 0, 2}, std::string(1, '\0') + bytes),
        datagrams::whole("", "no channel"),
        datagrams::whole(std::string(64, 'A'), "too long a name"),
        {},
        {'L'},
        {'L', 'C', '0', '2', 0, 0, 0, 1},
        {'L', 'C', '0', '2', 0, 0, 0, 1, 'A'},
        {'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0, 0, 9}, /* no whole header: what is left of it is negative */
        {'L', 'C', '0', '4', 0, 0, 0, 1, 'A', 0},
    };
    for (const Bytes &datagram : refused) {
        ale_datagram_t out;
        EXPECT_EQ(read(datagram, &out), -1) << ::testing::PrintToString(datagram);
    }
}

TEST(Datagram, WhateverComesStaysWithinItsBytes)
{
    std::mt19937 random(1);
    for (int k = 0; k < 200000; k++) {
        const Bytes bytes = datagrams::hostile(random, "ALE_POSE");
        ale_datagram_t out;
        if (read(bytes, &out) == 0) {
            ASSERT_LE(out.count, bytes.size());
            ASSERT_TRUE(out.channel == nullptr || std::strlen(out.channel) <= 63);
            ASSERT_TRUE(!out.is_part || uint64_t{out.offset} + out.count <= out.size);
        }
    }
}

TEST(Datagram, AHeadIsReadAsItWasWritten)
{
    uint8_t bytes[ALE_DATAGRAM_HEAD];
    const size_t length = ale_datagram_head(0x01020304, "ALE_STATUS", bytes);
    EXPECT_EQ(Bytes(bytes, bytes + length), datagrams::whole("ALE_STATUS", "", 0x01020304));
    EXPECT_EQ(ale_datagram_head(1, std::string(63, 'A').c_str(), bytes), size_t{ALE_DATAGRAM_HEAD});
    EXPECT_EQ(ale_datagram_head(1, std::string(64, 'A').c_str(), bytes), 0U);
    EXPECT_EQ(ale_datagram_head(1, "", bytes), 0U);
}

} // namespace
