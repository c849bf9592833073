#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "drivers/lcm/datagrams.hpp"

extern "C" {
#include "lcm/assembly.h"
}

namespace
{

using datagrams::Bytes;
using datagrams::Part;

class Assembly : public testing::Test
{
  protected:
    /* The message that this part completes. */
    std::optional<std::string> add(uint64_t from, const Part &part, const std::string &rest)
    {
        return add(from, datagrams::part(part, rest));
    }
    std::optional<std::string> add(uint64_t from, const Bytes &bytes)
    {
        ale_datagram_t datagram;
        if (ale_datagram_read(bytes.data(), bytes.size(), &datagram) < 0 || !datagram.is_part) {
            return std::nullopt;
        }
        const ale_partial_t *whole = ale_assembly_add(assembly.get(), from, &datagram);
        if (!whole) {
            return std::nullopt;
        }
        return whole->channel + std::string(":") +
               std::string(reinterpret_cast<const char *>(whole->bytes), whole->filled);
    }
    const std::string channel = std::string("CH") + '\0';
    std::unique_ptr<ale_assembly_t> assembly = std::make_unique<ale_assembly_t>();
};

TEST_F(Assembly, PartsInTheirOrderMakeTheMessage)
{
    EXPECT_EQ(add(1, {5, 9, 0, 0, 3}, channel + "abc"), std::nullopt);
    EXPECT_EQ(add(1, {5, 9, 3, 1, 3}, "def"), std::nullopt);
    EXPECT_EQ(add(1, {5, 9, 6, 2, 3}, "ghi"), "CH:abcdefghi");
    EXPECT_EQ(add(1, {6, 3, 0, 0, 1}, channel + "one"), "CH:one") << "in one part";
    EXPECT_EQ(assembly->refused, 0U);
}

TEST_F(Assembly, SendersDoNotDisturbEachOther)
{
    for (uint64_t from = 1; from <= ALE_ASSEMBLY_MESSAGES; from++) {
        EXPECT_EQ(add(from, {5, 4, 0, 0, 2}, channel + std::to_string(from)), std::nullopt);
    }
    for (uint64_t from = 1; from <= ALE_ASSEMBLY_MESSAGES; from++) {
        EXPECT_EQ(add(from, {5, 4, 1, 1, 2}, "end"), "CH:" + std::to_string(from) + "end");
    }
    EXPECT_EQ(assembly->refused, 0U);
}

TEST_F(Assembly, APartOutOfTurnEndsItsMessage)
{
    const Part wrong[] = {
        {5, 9, 6, 2, 3}, {6, 9, 3, 1, 3}, {5, 8, 3, 1, 3}, {5, 9, 4, 1, 3}, {5, 9, 3, 1, 4}};
    for (const Part &part : wrong) {
        add(1, {5, 9, 0, 0, 3}, channel + "abc");
        const uint64_t before = assembly->refused;
        EXPECT_EQ(add(1, part, "xyz"), std::nullopt);
        EXPECT_EQ(add(1, {5, 9, 3, 1, 3}, "def"), std::nullopt);
        EXPECT_EQ(assembly->refused, before + 2);
    }
}

TEST_F(Assembly, WhatIsAnnouncedButDoesNotComeMakesNoMessage)
{
    EXPECT_EQ(add(1, {5, 9, 0, 0, 1}, channel + "abc"), std::nullopt) << "nine bytes in one part of three";
    EXPECT_EQ(add(2, {5, 9, 3, 1, 2}, "def"), std::nullopt) << "no first part";
    EXPECT_EQ(assembly->refused, 2U);
}

TEST_F(Assembly, AMessageMayHave64KiBAndNoMore)
{
    EXPECT_EQ(add(1, {5, 65537, 0, 0, 2}, channel + "a"), std::nullopt);
    EXPECT_EQ(add(1, {5, 1U << 28, 0, 0, 2}, channel + "a"), std::nullopt);
    EXPECT_EQ(assembly->refused, 2U);
    const std::string half(32768, 'h');
    EXPECT_EQ(add(1, {5, 65536, 0, 0, 2}, channel + half), std::nullopt);
    EXPECT_EQ(add(1, {5, 65536, 32768, 1, 2}, half), "CH:" + half + half);
}

TEST_F(Assembly, ManySendersThatNeverFinishLeaveRoomForOneThatDoes)
{
    for (uint64_t from = 100; from < 1100; from++) {
        EXPECT_EQ(add(from, {5, 65536, 0, 0, 9}, channel + "abc"), std::nullopt);
    }
    EXPECT_EQ(add(1, {5, 6, 0, 0, 2}, channel + "abc"), std::nullopt);
    EXPECT_EQ(add(1, {5, 6, 3, 1, 2}, "def"), "CH:abcdef");
    EXPECT_EQ(assembly->refused, 1001U - ALE_ASSEMBLY_MESSAGES);
}

TEST_F(Assembly, HostilePartsLeaveItWorking)
{
    std::mt19937 random(2);
    for (int k = 0; k < 200000; k++) {
        add(random() % 6, datagrams::hostile(random, "CH"));
    }
    EXPECT_EQ(add(9, {5, 6, 0, 0, 2}, channel + "abc"), std::nullopt);
    EXPECT_EQ(add(9, {5, 6, 3, 1, 2}, "def"), "CH:abcdef");
}

} // namespace
