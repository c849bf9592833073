// lib/graph/loops/place_candidates: one node of each visit.
#include <gtest/gtest.h>

#include "graph/loops/place_candidates.h"

namespace
{

using Nodes = std::vector<int>;

TEST(PlaceCandidates, OfNodesInARowTheNearestIsChosen)
{
    EXPECT_EQ(ale::nearest_of_each_visit({{10, 0.9}, {11, 0.4}, {12, 0.6}, {30, 0.5}, {31, 0.7}}, 3, 6),
              (Nodes{11, 30}));
}

TEST(PlaceCandidates, ANodeFartherAlongIsAnotherVisit)
{
    EXPECT_EQ(ale::nearest_of_each_visit({{10, 0.1}, {13, 0.2}, {14, 0.3}}, 3, 6), (Nodes{10, 14}));
}

TEST(PlaceCandidates, AtMostTheGivenNumberIsChosen)
{
    EXPECT_EQ(ale::nearest_of_each_visit({{10, 0.3}, {20, 0.2}, {30, 0.1}}, 3, 2), (Nodes{30, 20}));
    EXPECT_TRUE(ale::nearest_of_each_visit({}, 3, 2).empty());
}

TEST(PlaceCandidates, OfEqualDistancesTheFirstIsChosen)
{
    EXPECT_EQ(ale::nearest_of_each_visit({{10, 0.5}, {12, 0.5}, {20, 0.5}}, 3, 2), (Nodes{10, 20}));
}

} // namespace
