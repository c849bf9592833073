// The map in parts: whole only when all parts of one version are there.
#include "common/feed/map_parts.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

using feed::MapParts;

namespace
{

ale::map_t part_of(int32_t version, int16_t part, int16_t parts, int32_t first_id, int32_t lines)
{
    ale::map_t message{};
    message.version = version;
    message.part = part;
    message.parts = parts;
    message.num_lines = lines;
    message.lines.resize(static_cast<size_t>(lines));
    for (int32_t k = 0; k < lines; k++) {
        message.lines[static_cast<size_t>(k)].id = first_id + k;
    }
    return message;
}

} // namespace

TEST(MapParts, AMapInOnePartIsWholeAtOnce)
{
    MapParts parts;
    EXPECT_TRUE(parts.add(part_of(1, 0, 1, 10, 3)));
    EXPECT_EQ(parts.whole().lines.size(), 3U);
    EXPECT_EQ(parts.whole().num_lines, 3);
}

TEST(MapParts, PartsInAnyOrderJoinInTheOrderOfTheMap)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 50; trial++) {
        std::vector<int16_t> order = {0, 1, 2, 3, 4};
        std::shuffle(order.begin(), order.end(), random);
        MapParts parts;
        for (size_t k = 0; k < order.size(); k++) {
            EXPECT_EQ(parts.add(part_of(7, order[k], 5, order[k] * 10, 10)), k == 4);
        }
        ASSERT_EQ(parts.whole().lines.size(), 50U);
        for (int32_t k = 0; k < 50; k++) {
            EXPECT_EQ(parts.whole().lines[static_cast<size_t>(k)].id, k);
        }
    }
}

TEST(MapParts, APartThatWasLostLeavesTheFormerMapStanding)
{
    MapParts parts;
    ASSERT_TRUE(parts.add(part_of(1, 0, 1, 0, 4)));
    EXPECT_FALSE(parts.add(part_of(2, 0, 2, 0, 5)));
    EXPECT_FALSE(parts.add(part_of(3, 1, 2, 5, 5))); // the rest of version 2 never came
    EXPECT_EQ(parts.whole().version, 1);
    EXPECT_TRUE(parts.add(part_of(3, 0, 2, 0, 5)));
    EXPECT_EQ(parts.whole().version, 3);
    EXPECT_EQ(parts.whole().lines.size(), 10U);
}

TEST(MapParts, ARepeatedPartIsNotCountedTwice)
{
    MapParts parts;
    EXPECT_FALSE(parts.add(part_of(1, 0, 2, 0, 5)));
    EXPECT_FALSE(parts.add(part_of(1, 0, 2, 0, 5)));
    EXPECT_TRUE(parts.add(part_of(1, 1, 2, 5, 5)));
}

TEST(MapParts, TheSameVersionSentAgainIsWholeAgain)
{
    MapParts parts;
    EXPECT_TRUE(parts.add(part_of(1, 0, 1, 0, 2)));
    EXPECT_TRUE(parts.add(part_of(1, 0, 1, 0, 2)));
    EXPECT_EQ(parts.whole().lines.size(), 2U);
}

TEST(MapParts, NumbersThatMakeNoSenseAreRefused)
{
    MapParts parts;
    for (const auto &[part, count] : {std::pair<int16_t, int16_t>{0, 0}, {1, 1}, {-1, 2}, {0, -3}, {2, 2}}) {
        EXPECT_FALSE(parts.add(part_of(1, part, count, 0, 1)));
    }
    EXPECT_TRUE(parts.add(part_of(1, 0, 1, 0, 1)));
}
