// lib/graph/loops/map_table
#include <gtest/gtest.h>

#include "graph/loops/map_table.h"

namespace
{

TEST(MapTable, AMapIsItselfUntilItJoins)
{
    ale::MapTable table;
    EXPECT_EQ(table.now(7), 7U);
    table.join(7, 3);
    EXPECT_EQ(table.now(7), 3U);
    table.join(3, 0);
    EXPECT_EQ(table.now(7), 0U) << "with what it has joined";
    EXPECT_EQ(table.now(3), 0U);
    table.clear();
    EXPECT_EQ(table.now(7), 7U);
}

TEST(MapTable, TheLatestJoinsAreKept)
{
    ale::MapTable table;
    const auto joins = static_cast<uint32_t>(3 * ale::MapTable::most_joins);
    for (uint32_t k = 1; k <= joins; k++) {
        table.join(k, 0);
        EXPECT_EQ(table.now(k), 0U);
    }
    EXPECT_EQ(table.now(joins - static_cast<uint32_t>(ale::MapTable::most_joins) + 1), 0U);
}

TEST(MapTable, MapsOfNodesAreCounted)
{
    std::vector<ale::Node> nodes(6);
    const uint32_t maps[] = {0, 0, 4, 4, 4, 0};
    for (size_t k = 0; k < nodes.size(); k++) {
        nodes[k].map_id = maps[k];
    }
    EXPECT_EQ(ale::count_maps(nodes), 2U);
    EXPECT_EQ(ale::largest_map(nodes), 0U) << "of equals the oldest";
    nodes[0].map_id = 9;
    EXPECT_EQ(ale::count_maps(nodes), 3U);
    EXPECT_EQ(ale::largest_map(nodes), 4U);
}

} // namespace
