// Which walls of a map are in another map than the first: known when all parts of one version are there.
#include "common/feed/map_pieces.h"

#include <gtest/gtest.h>

using feed::MapPieces;

namespace
{

ale::map_pieces_t part_of(int32_t version, int16_t part, int16_t parts, std::vector<int32_t> lines,
                          int32_t map_id)
{
    ale::map_pieces_t message{};
    message.version = version;
    message.part = part;
    message.parts = parts;
    message.num_lines = static_cast<int32_t>(lines.size());
    message.map_id.assign(lines.size(), map_id);
    message.line_id = std::move(lines);
    return message;
}

} // namespace

TEST(MapPieces, WallsThatAreNotNamedAreInTheFirstMap)
{
    MapPieces pieces;
    EXPECT_EQ(pieces.map_of(1, 5), 0);
    ASSERT_TRUE(pieces.add(part_of(1, 0, 1, {5, 9}, 3)));
    EXPECT_EQ(pieces.map_of(1, 5), 3);
    EXPECT_EQ(pieces.map_of(1, 9), 3);
    EXPECT_EQ(pieces.map_of(1, 6), 0);
    EXPECT_FALSE(pieces.add(part_of(1, 0, 1, {5, 9}, 3))) << "nothing new";
}

TEST(MapPieces, OfAnotherVersionNothingIsKnown)
{
    MapPieces pieces;
    ASSERT_TRUE(pieces.add(part_of(1, 0, 1, {5}, 3)));
    EXPECT_EQ(pieces.map_of(2, 5), 0) << "the same id may be another wall there";
    ASSERT_TRUE(pieces.add(part_of(2, 0, 1, {}, 0)));
    EXPECT_EQ(pieces.map_of(2, 5), 0) << "joined";
    EXPECT_EQ(pieces.map_of(1, 5), 0);
}

TEST(MapPieces, TheyAreKnownWhenAllPartsAreThere)
{
    MapPieces pieces;
    EXPECT_FALSE(pieces.add(part_of(4, 1, 2, {7}, 2)));
    EXPECT_EQ(pieces.map_of(4, 7), 0);
    EXPECT_TRUE(pieces.add(part_of(4, 0, 2, {6}, 1)));
    EXPECT_EQ(pieces.map_of(4, 6), 1);
    EXPECT_EQ(pieces.map_of(4, 7), 2);
}
