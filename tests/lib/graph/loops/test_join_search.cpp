// lib/graph/loops/join_search: which nodes are searched where.
#include "graph/loops/join_search.h"

#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace
{

struct Drive {
    std::vector<ale::Node> nodes;
    std::vector<ale::Pose> poses;

    // A map along a straight way, a node every metre.
    void add_map(uint32_t map_id, int count)
    {
        for (int k = 0; k < count; k++) {
            ale::Node node{};
            node.map_id = map_id;
            nodes.push_back(node);
            poses.push_back({static_cast<double>(k), 0, 0});
        }
    }
};

TEST(JoinSearch, AfterTheDriveTheSmallerMapIsSearchedInTheLarger)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, 4);
    std::set<int> queries;
    for (const ale::JoinTask &task : ale::tasks_after_drive(drive.nodes, drive.poses)) {
        queries.insert(task.queries.begin(), task.queries.end());
        EXPECT_LT(task.place, 9) << "place " << task.place;
    }
    EXPECT_EQ(queries, (std::set<int>{9, 10, 11, 12}));
}

TEST(JoinSearch, WhatNoDecisionCanJoinIsNotSearched)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, static_cast<int>(ale::JoinDecision::least_nodes) - 1);
    EXPECT_TRUE(ale::tasks_after_drive(drive.nodes, drive.poses).empty());
}

// Places of the first of three maps are searched for all of the others where it has changed, else for what
// has.
TEST(JoinSearch, AfterJoinsOnlyWhatHasChangedIsSearchedAgain)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, 5);
    drive.add_map(2, 4);
    const auto searched_again = [&drive](uint32_t changed) {
        std::set<std::pair<uint32_t, uint32_t>> pairs;
        for (const ale::JoinTask &task : ale::tasks_after_joins(drive.nodes, drive.poses, {changed})) {
            for (const int query : task.queries) {
                pairs.insert({ale::at(drive.nodes, task.place).map_id, ale::at(drive.nodes, query).map_id});
            }
        }
        return pairs;
    };
    using Pairs = std::set<std::pair<uint32_t, uint32_t>>;
    EXPECT_EQ(searched_again(0), (Pairs{{0, 1}, {0, 2}}));
    EXPECT_EQ(searched_again(1), (Pairs{{0, 1}, {1, 2}}));
    EXPECT_EQ(searched_again(2), (Pairs{{0, 2}, {1, 2}}));
    EXPECT_EQ(searched_again(3), Pairs{});
}

} // namespace
